#include "image/windows/match_image.h"

#include <algorithm>
#include <cmath>

#include "kernels/image/smoothing.h"

namespace uav_landing {

FirstRows firstGroundRows(const StereoRig& rig, const Eigen::Vector3d& normal, const FirstRows& above,
                          double slack) {
  if (!(normal.y() > 0)) return {};
  const double rows = rig.size.height, offset = std::abs(rig.principalOffset());
  const auto rowAt = [&](double u) {
    return rig.cy - rig.fy * (normal.x() * (u - rig.cx) / rig.fx + normal.z()) / normal.y();
  };
  // The highest row of the horizon in both images.
  const double horizon = std::min(rowAt(-offset), rowAt(rig.size.width + offset)) - slack * rows;
  const double row = std::clamp(horizon, 0.0, rows);
  const int factor = coarseFactor(rig.size);
  return {std::max(0, static_cast<int>(std::floor(row)) - above.fine),
          std::max(0, static_cast<int>(std::floor(toCoarse(row, factor))) - above.coarse)};
}

int coarseFactor(const cv::Size& size) {
  constexpr int kEnoughColumns = 400, kLeastRows = 150;
  int factor = 1;
  while (size.width / factor > kEnoughColumns && size.height / (2 * factor) >= kLeastRows) factor *= 2;
  return factor;
}

void MatchImage::assign(const cv::Mat& image, const FirstRows& first_rows) {
  factor = coarseFactor(image.size());
  fine.create(image.size(), CV_32FC1);
  if (factor == 1)
    coarse = fine;
  else
    coarse.create(image.rows / factor, image.cols / factor, CV_32FC1);
  first = {fine.rows, coarse.rows};
  extend(image, first_rows);
}

void MatchImage::extend(const cv::Mat& image, const FirstRows& first_rows) {
  const int from = factor == 1 ? std::min(first_rows.fine, first_rows.coarse) : first_rows.fine;
  if (from < first.fine) {
    smooth(image, {from, first.fine}, fine);
    first.fine = from;
  }
  if (factor > 1 && first_rows.coarse < first.coarse) {
    smoothReduced(image, factor, {first_rows.coarse, first.coarse}, coarse);
    first.coarse = first_rows.coarse;
  }
}

}  // namespace uav_landing
