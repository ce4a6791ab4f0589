#include "uav_landing/geometry/row_times.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "geometry/raw_places.h"

namespace uav_landing {
namespace {

constexpr int kStep = 16;  // px between the nodes of the grid; coarse, as lenses bend rows slowly
// Pixels without a source may seem to come from rows outside the image, up to this share of it.
constexpr double kBeside = 0.1;

double givenOr(double value, double otherwise) { return std::isnan(value) ? otherwise : value; }

/// Readout of the camera that is named left.
Readout namedLeft(const RigParameters& p) {
  return {givenOr(p.readout_time, 0), p.stamp_row, p.row_direction};
}

Readout namedRight(const RigParameters& p) {
  const Readout left = namedLeft(p);
  return {givenOr(p.right_readout_time, left.time), givenOr(p.right_stamp_row, left.stamp_row),
          p.row_direction};
}

}  // namespace

Readout leftReadout(const RigParameters& p) { return p.upside_down ? namedRight(p) : namedLeft(p); }

Readout rightReadout(const RigParameters& p) { return p.upside_down ? namedLeft(p) : namedRight(p); }

Readout unknownReadout(const RigParameters& p) {
  const bool given = !std::isnan(p.readout_time) || (p.upside_down && !std::isnan(p.right_readout_time));
  Readout left = leftReadout(p);
  left.time = given ? 0 : 1;
  return left;
}

RowSpan leftRowSpan(const RigParameters& p) {
  const Readout left = leftReadout(p);
  const double top = -left.stamp_row * left.time, bottom = (1 - left.stamp_row) * left.time;
  return {std::min(top, bottom), std::max(top, bottom)};
}

RowTimes::RowTimes(const CameraCalibration& calibration, const Readout& readout) : time_(readout.time) {
  if (atOnce()) return;
  const CameraCalibration c = calibration.ofDeliveredImage();
  const cv::Size size = c.imageSize();
  // The rectified image reduced to the nodes: node (i, j) is the pixel (i, j) times kStep.
  const cv::Size nodes((size.width - 1) / kStep + 2, (size.height - 1) / kStep + 2);
  Eigen::Matrix3d reduced = c.P.leftCols<3>();
  reduced.topRows<2>() /= kStep;
  const RawPlaces raw = rawPlaces(c, reduced, nodes);
  const bool by_columns = readout.direction == RowDirection::kColumns;
  const cv::Mat& lines = by_columns ? raw.x : raw.y;
  const double count = by_columns ? size.width : size.height;
  columns_ = nodes.width;
  rows_ = nodes.height;
  const cv::Rect picture(cv::Point(), size);
  Eigen::Matrix3d information = 1e-9 * Eigen::Matrix3d::Identity();  // if no node is seen, the plane is 0
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (int j = 0; j < rows_; ++j)
    for (int i = 0; i < columns_; ++i) {
      const double share = (lines.at<float>(j, i) + 0.5) / count;
      const bool real = std::isfinite(share);
      shares_.push_back(
          static_cast<float>(real ? std::clamp(share, -kBeside, 1 + kBeside) - readout.stamp_row : 0));
      const cv::Point node(i * kStep, j * kStep);
      const cv::Point2f source(raw.x.at<float>(j, i), raw.y.at<float>(j, i));
      if (!real || !picture.contains(node) || !picture.contains(cv::Point(source))) continue;
      const Eigen::Vector3d place(1, node.x, node.y);
      information += place * place.transpose();
      right += time_ * shares_.back() * place;
    }
  plane_ = information.ldlt().solve(right);
}

double RowTimes::shareAt(double u, double v) const {
  const double x = std::clamp(u / kStep, 0.0, columns_ - 1.0), y = std::clamp(v / kStep, 0.0, rows_ - 1.0);
  const int i = std::min(static_cast<int>(x), columns_ - 2), j = std::min(static_cast<int>(y), rows_ - 2);
  const float* above = &shares_[static_cast<size_t>(j) * columns_ + i];
  const float* below = above + columns_;
  const double a = x - i, b = y - j;
  return (1 - b) * ((1 - a) * above[0] + a * above[1]) + b * ((1 - a) * below[0] + a * below[1]);
}

double laterRows(const RowTimes& left, const RowTimes& right, const cv::Size& size) {
  constexpr double kAlike = 0.1;  // of the readout time
  const auto later = [&](double u, double v) { return right.at(u, v) - left.at(u, v); };
  const double end = size.width - 1, bottom = size.height - 1;
  const double middle = later(end / 2, bottom / 2);
  double most = middle;
  for (const double v : {0.0, bottom})
    for (const double u : {0.0, end})
      if (std::abs(later(u, v)) > std::abs(most)) most = later(u, v);
  const double readout = std::max(std::abs(left.readoutTime()), std::abs(right.readoutTime()));
  return std::abs(most - middle) <= kAlike * readout ? middle : most;
}

ReadoutCheck::ReadoutCheck(const RowTimes& times, const RowTimes& right)
    : longest_(std::max(std::abs(times.readoutTime()), std::abs(right.readoutTime()))) {}

Failure ReadoutCheck::follow(double stamp) {
  // Stamps of some drivers jitter by a tenth of the period; the mean of several periods has less of it.
  constexpr size_t kFewestPeriods = 4, kMostPeriods = 20;
  constexpr double kRounding = 1.01;  // of stamps and of a measured readout time
  constexpr double kJitter = 0.42;    // three sigma of the two stamps at the ends, periods
  if (longest_ == 0) return {};
  if (!stamps_.empty() && !(stamp > stamps_.back())) stamps_.clear();
  stamps_.push_back(stamp);
  if (stamps_.size() <= kFewestPeriods) return {};
  if (stamps_.size() > kMostPeriods + 1) stamps_.pop_front();
  const double periods = static_cast<double>(stamps_.size() - 1);
  const double period = (stamps_.back() - stamps_.front()) / periods;
  if (longest_ <= (kRounding + kJitter / periods) * period) return {};
  return {Reason::kInputInvalid,
          text("rig/readout_time: ", longest_, " s is longer than the ", rounded(period),
               " s between images, expected at most that; give it in seconds, as in docs/calibration.md")};
}

}  // namespace uav_landing
