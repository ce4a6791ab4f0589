#include "geometry/half_plane.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace uav_landing {

void keepHalfPlane(const cv::Mat& mask, double a, double b, double c, cv::Mat& kept) {
  kept.create(mask.size(), CV_8UC1);
  if (!std::isfinite(a) || !std::isfinite(b) || !std::isfinite(c)) {
    kept.setTo(0);
    return;
  }
  for (int v = 0; v < mask.rows; ++v) {
    const double rest = b * v + c;
    // The columns first..last - 1 are kept.
    int first = 0, last = mask.cols;
    if (a > 0 && rest < 0) first = static_cast<int>(std::min(std::ceil(-rest / a), double(mask.cols)));
    if (a < 0 && rest + a * (mask.cols - 1) < 0)
      last = static_cast<int>(std::max(std::floor(-rest / a) + 1, 0.0));
    if (a == 0 && rest < 0) last = 0;
    last = std::max(first, last);
    uchar* row = kept.ptr<uchar>(v);
    std::fill(row, row + first, uchar(0));
    if (kept.data != mask.data) std::copy(mask.ptr<uchar>(v) + first, mask.ptr<uchar>(v) + last, row + first);
    std::fill(row + last, row + mask.cols, uchar(0));
  }
}

void keepBelowHorizon(const cv::Mat& mask, const Eigen::Matrix3d& K, const Eigen::Vector3d& normal,
                      cv::Mat& kept) {
  const double margin = 0.01 * mask.rows;
  const Eigen::Vector3d line = K.inverse().transpose() * normal;
  keepHalfPlane(mask, line.x(), line.y(), line.z() - margin * line.head<2>().norm(), kept);
}

}  // namespace uav_landing
