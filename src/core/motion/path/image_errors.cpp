#include "motion/path/image_errors.h"

#include <cmath>

namespace uav_landing {
namespace {

constexpr double kStampRounding = 1e-3;  // s
// Time over which similar errors stay similar, s: that of 1 to 3 Hz. Slower ones hardly differ between the
// images, so their angles change slowly, as those of a path do.
constexpr double kSimilar = 0.1;

}  // namespace

size_t ImageErrors::imageAt(double stamp) {
  for (size_t i = stamps_.size(); i-- > 0;)
    if (std::abs(stamps_[i] - stamp) < kStampRounding) return i;
  stamps_.push_back(stamp);
  return stamps_.size() - 1;
}

void ImageErrors::add(double from, double to) {
  const size_t first = imageAt(from);
  movements_.push_back({first, imageAt(to), to - from});
}

Eigen::MatrixXd ImageErrors::derivatives() const {
  Eigen::MatrixXd by_image = Eigen::MatrixXd::Zero(movements_.size(), stamps_.size());
  for (size_t i = 0; i < movements_.size(); ++i) {
    if (movements_[i].from == movements_[i].to) continue;
    by_image(i, movements_[i].to) = 1 / movements_[i].duration;
    by_image(i, movements_[i].from) = -1 / movements_[i].duration;
  }
  return by_image;
}

ImageErrors::Covariances ImageErrors::covariances() const {
  const auto n = static_cast<Eigen::Index>(stamps_.size());
  Eigen::MatrixXd similar(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      similar(i, j) = std::exp(-0.5 * std::pow((stamps_[i] - stamps_[j]) / kSimilar, 2));
  const Eigen::MatrixXd by_image = derivatives();
  return {by_image * by_image.transpose(), by_image * similar * by_image.transpose()};
}

}  // namespace uav_landing
