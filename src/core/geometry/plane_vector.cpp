#include "geometry/plane_vector.h"

#include <sstream>
#include <stdexcept>

namespace uav_landing {
namespace {

bool hasPlane(const Eigen::Vector3d& g) { return g.allFinite() && !g.isZero(0); }

}  // namespace

PlaneVector::PlaneVector(const Eigen::Vector3d& g) : g_(g) {
  if (hasPlane(g)) return;
  std::ostringstream text;
  text << "no plane has the plane vector (" << g.transpose() << ") 1/m: it has to be finite and not zero";
  throw std::invalid_argument(text.str());
}

std::optional<PlaneVector> PlaneVector::of(const Eigen::Vector3d& g) {
  if (!hasPlane(g)) return std::nullopt;
  return PlaneVector(g);
}

}  // namespace uav_landing
