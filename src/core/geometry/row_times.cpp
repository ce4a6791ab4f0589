#include "uav_landing/geometry/row_times.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "base/text.h"

namespace uav_landing {
namespace {

constexpr int kStep = 16;  // px between the nodes of the grid: lenses bend rows slowly
// Rows beside the picture, as a share of it, that pixels without a source may seem to come from.
constexpr double kBeside = 0.1;

double givenOr(double value, double otherwise) { return std::isnan(value) ? otherwise : value; }

}  // namespace

Readout leftReadout(const RigParameters& p) {
  return {givenOr(p.readout_time, 0), p.stamp_row, p.row_direction};
}

Readout rightReadout(const RigParameters& p) {
  const Readout left = leftReadout(p);
  return {givenOr(p.right_readout_time, left.time), givenOr(p.right_stamp_row, left.stamp_row),
          p.row_direction};
}

Readout unknownReadout(const RigParameters& p) {
  return {std::isnan(p.readout_time) ? 1.0 : 0.0, p.stamp_row, p.row_direction};
}

RowTimes::RowTimes(const CameraCalibration& calibration, const Readout& readout) : time_(readout.time) {
  if (atOnce()) return;
  const CameraCalibration c = calibration.ofDeliveredImage();
  const cv::Size size = c.imageSize();
  // The rectified image reduced to the nodes: node (i, j) is the pixel (i, j) times kStep.
  const cv::Size nodes((size.width - 1) / kStep + 2, (size.height - 1) / kStep + 2);
  Eigen::Matrix3d reduced = c.P.leftCols<3>();
  reduced.topRows<2>() /= kStep;
  cv::Mat K, R, P, x, y;
  cv::eigen2cv(c.K, K);
  cv::eigen2cv(c.R, R);
  cv::eigen2cv(reduced, P);
  cv::initUndistortRectifyMap(K, cv::Mat(c.D, true), R, P, nodes, CV_32FC1, x, y);
  const bool by_columns = readout.direction == RowDirection::kColumns;
  const cv::Mat& lines = by_columns ? x : y;
  const double count = by_columns ? size.width : size.height;
  columns_ = nodes.width;
  rows_ = nodes.height;
  for (int j = 0; j < rows_; ++j)
    for (int i = 0; i < columns_; ++i) {
      const double share = std::clamp((lines.at<float>(j, i) + 0.5) / count, -kBeside, 1 + kBeside);
      shares_.push_back(static_cast<float>(share - readout.stamp_row));
    }
  fitPlane(size);
}

double RowTimes::shareAt(double u, double v) const {
  const double x = std::clamp(u / kStep, 0.0, columns_ - 1.0), y = std::clamp(v / kStep, 0.0, rows_ - 1.0);
  const int i = std::min(static_cast<int>(x), columns_ - 2), j = std::min(static_cast<int>(y), rows_ - 2);
  const float* above = &shares_[static_cast<size_t>(j) * columns_ + i];
  const float* below = above + columns_;
  const double a = x - i, b = y - j;
  return (1 - b) * ((1 - a) * above[0] + a * above[1]) + b * ((1 - a) * below[0] + a * below[1]);
}

void RowTimes::fitPlane(cv::Size size) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (int v = 0; v < size.height; v += kStep)
    for (int u = 0; u < size.width; u += kStep) {
      const Eigen::Vector3d place(1, u, v);
      information += place * place.transpose();
      right += at(u, v) * place;
    }
  plane_ = information.ldlt().solve(right);
}

ReadoutCheck::ReadoutCheck(const RowTimes& times, const RowTimes& right)
    : longest_(std::max(std::abs(times.readoutTime()), std::abs(right.readoutTime()))) {}

Failure ReadoutCheck::follow(double stamp) {
  constexpr size_t kPeriods = 4;      // of which the mean counts: stamps of some drivers jitter
  constexpr double kRounding = 1.01;  // of stamps and of a measured readout time
  if (longest_ == 0) return {};
  if (!stamps_.empty() && !(stamp > stamps_.back())) stamps_.clear();
  stamps_.push_back(stamp);
  if (stamps_.size() <= kPeriods) return {};
  if (stamps_.size() > kPeriods + 1) stamps_.pop_front();
  const double period = (stamps_.back() - stamps_.front()) / kPeriods;
  if (longest_ <= kRounding * period) return {};
  return {Reason::kInputInvalid,
          text("rig/readout_time: ", longest_, " s is longer than the ", rounded(period),
               " s between pictures, expected at most that; give it in seconds, as in docs/calibration.md")};
}

}  // namespace uav_landing
