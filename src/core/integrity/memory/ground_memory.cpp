#include "integrity/memory/ground_memory.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/robust.h"
#include "integrity/memory/height_memory.h"

namespace uav_landing {
namespace {

// Lengths are in multiples of the height.
constexpr double kHalfWidth = 0.35;    // of the strip below the path
constexpr double kLength = 0.5;        // of the strip that one pair is asked about
constexpr double kSpacing = 0.1;       // between patches
constexpr double kLargestGap = 0.5;    // largest distance between two patches with continuous ground
constexpr double kMostOff = 0.15;      // largest difference between ground and plane
constexpr double kLeastMotion = 1e-3;  // shortest path that has a direction
// Share of the path that remains on the next pair, as in a mean of five pairs.
constexpr double kPathKept = 0.8;
constexpr double kLongestStep = 5;  // longest possible step, over the mean step of the path
constexpr size_t kFewest = 5;       // points that make a patch
// Share of the variance of a look that the next pairs have as well, because they see the same texture. The
// simulator's errors give a twentieth to a third.
constexpr double kLasting = 1.0 / 3;
constexpr int kMostCoasts = 3;  // pairs in a row without a motion
constexpr double kClimbChange =
    0.05;  // 1 sigma of the climb on an unknown step of usual length, as a share of that length

struct GroundPoint {
  double ahead, height, stddev;  // m
  double ahead_on_plane;         // m, where the point's ray meets the plane
};

/// Variance of the median of the heights: by their scatter or by their claims, whichever is larger.
double medianVariance(const std::vector<GroundPoint>& points, double middle) {
  std::vector<double> off, claimed;
  for (const GroundPoint& point : points) {
    off.push_back(std::abs(point.height - middle));
    claimed.push_back(point.stddev);
  }
  const double stddev = std::max(robustStddev(off), medianOf(claimed));
  return 0.5 * M_PI * stddev * stddev / points.size();
}

}  // namespace

void GroundMemory::Patch::add(const Patch& look) {
  information += look.information;
  at += look.information / information * (look.at - at);
  ++looks;
}

double GroundMemory::Patch::variance() const {
  const double of_looks = (1 - kLasting + kLasting * looks) / information;
  return of_looks + drift + std::pow(HeightMemory::kDirectionError * flown, 2);
}

void GroundMemory::carry(std::deque<Patch>& patches, const Eigen::Matrix3d& R, const Eigen::Vector3d& step,
                         double turn_variance, double climb_variance) {
  for (Patch& patch : patches) {
    patch.at = R * patch.at - step;
    patch.flown += step.norm();
    patch.drift += turn_variance * patch.at.squaredNorm() + climb_variance;
  }
}

void GroundMemory::move(const Eigen::Matrix3d& R, const Eigen::Vector3d& t, double T) {
  const Eigen::Vector3d before = R * path_, usual = path_time_ > 0 ? before * (T / path_time_) : t;
  const double longest = kLongestStep * usual.norm();
  const bool wrong = longest > 0 && t.norm() > longest;
  const Eigen::Vector3d step = wrong ? usual : t;
  if (gap_ && !wrong && T > 0) closeGap(R.transpose() * t / T, path_time_ / steps_);
  gap_.reset();
  coasts_ = 0;
  // The length is limited to what is possible: if the speed did change, the path follows after some pairs.
  // The direction of an impossible step says nothing.
  path_ = kPathKept * before + (wrong ? longest * usual.normalized() : t);
  path_time_ = kPathKept * path_time_ + T;
  steps_ = kPathKept * steps_ + 1;
  carry(patches_, R, step, 0, 0);
  if (!unsettled_) return;
  unsettled_->R = R * unsettled_->R;
  unsettled_->t = R * unsettled_->t + step;
}

void GroundMemory::coast(const Eigen::Matrix3d& R, double turn_stddev, double T,
                         const std::optional<Eigen::Vector3d>& normal, bool doubted) {
  if (!(path_time_ > 0) || (!doubted && ++coasts_ > kMostCoasts)) return reset();
  unsettled_.reset();
  if (!gap_) gap_ = Gap{patches_, path_, normal};
  gap_->doubted |= doubted;
  gap_->R = R * gap_->R;
  gap_->turn_variance += turn_stddev * turn_stddev;
  gap_->time += T;
  path_ = R * path_;
  carry(patches_, R, path_ * (T / path_time_), turn_stddev * turn_stddev, climbVariance(T));
}

// Variance of the climb over a time T at the usual speed, m^2.
double GroundMemory::climbVariance(double T) const {
  const double steps = steps_ * T / path_time_, usual = path_.norm() / steps_;
  return steps * std::pow(kClimbChange * usual, 2);
}

void GroundMemory::settleTurn(const Eigen::Vector3d& normal, double turn_stddev) {
  if (unsettled_) return settleLater(normal, turn_stddev);
  if (!gap_ || !gap_->normal) return;
  gap_->R = Eigen::Quaterniond::FromTwoVectors(*gap_->normal, normal).toRotationMatrix();
  gap_->turn_variance = turn_stddev * turn_stddev;
  gap_->doubted = false;
  path_ = gap_->R * gap_->path;
  std::deque<Patch> patches = gap_->patches;
  carry(patches, gap_->R, path_ * (gap_->time / path_time_), gap_->turn_variance, climbVariance(gap_->time));
  replaceBefore(std::move(patches), gap_->seen);
}

void GroundMemory::settleLater(const Eigen::Vector3d& normal, double turn_stddev) {
  const Eigen::Vector3d then = unsettled_->R.transpose() * normal;
  const Eigen::Matrix3d R = Eigen::Quaterniond::FromTwoVectors(unsettled_->normal, then).toRotationMatrix();
  std::deque<Patch> patches = std::move(unsettled_->patches);
  const Eigen::Vector3d way =
      0.5 * (R * unsettled_->speed_before + unsettled_->speed_after) * unsettled_->time;
  carry(patches, R, way, turn_stddev * turn_stddev, unsettled_->climb_variance);
  carry(patches, unsettled_->R, unsettled_->t, 0, 0);
  replaceBefore(std::move(patches), unsettled_->seen);
  unsettled_.reset();
}

// Between two known speeds the distance is as certain as that of one usual step. usual_time: of that step, s.
void GroundMemory::closeGap(const Eigen::Vector3d& speed_after, double usual_time) {
  const Eigen::Vector3d speed = 0.5 * (path_ / path_time_ + speed_after);
  const double climb_variance = std::pow(kClimbChange * speed.norm() * usual_time, 2);
  if (gap_->doubted && gap_->normal)
    unsettled_ = Unsettled{gap_->patches,  *gap_->normal, gap_->path / path_time_, speed_after, gap_->time,
                           climb_variance, gap_->seen};
  carry(gap_->patches, gap_->R, speed * gap_->time, gap_->turn_variance, climb_variance);
  replaceBefore(std::move(gap_->patches), gap_->seen);
}

// Replaces the patches from before a gap by ones that were carried over it in a better way. Patches seen
// since then stay.
void GroundMemory::replaceBefore(std::deque<Patch> patches, size_t seen) {
  const auto kept = static_cast<std::ptrdiff_t>(std::min(seen, patches_.size()));
  patches.insert(patches.end(), patches_.end() - kept, patches_.end());
  patches_ = std::move(patches);
}

void GroundMemory::wait() {
  if (++coasts_ > kMostCoasts) reset();
}

void GroundMemory::look(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points,
                        const GroundPlane& plane, const PlaneVector& measured) {
  const Eigen::Vector3d n = plane.normal();
  const double h = plane.height();
  const Eigen::Vector3d along = path_ - n.dot(path_) * n;
  if (!(along.norm() > kLeastMotion * h)) return;
  const Eigen::Vector3d ahead = along.normalized(), side = n.cross(ahead);
  const auto distance = [&](const Patch& patch) { return ahead.dot(patch.at); };
  // A patch that has been passed stays, so that the ground up to there is known.
  while (patches_.size() > 1 && distance(patches_[1]) < 0) patches_.pop_front();

  std::vector<GroundPoint> strip;
  double nearest = INFINITY;
  for (const StereoDepthResult::Point& point : points) {
    const Eigen::Vector3d ray = rig.ray(point.u, point.v);
    const double expected = measured.disparity(rig, point.u, point.v), inverse = plane.g.dot(ray);
    if (!(expected > 0 && inverse > 0 && point.disparity > 0)) continue;
    const double ratio = expected / point.disparity;  // depth of the point over that of the plane
    if (std::abs(ratio - 1) > kMostOff) continue;
    // The ray alone decides whether a point is in the strip. Otherwise wrong disparities that put points too
    // near would bring those in.
    const Eigen::Vector3d on_plane = ray / inverse, at = ratio * on_plane;
    if (std::abs(side.dot(on_plane)) > kHalfWidth * h) continue;
    strip.push_back(
        {ahead.dot(at), n.dot(at), h * point.disparity_stddev / point.disparity, ahead.dot(on_plane)});
    nearest = std::min(nearest, strip.back().ahead_on_plane);
  }
  const auto far = [&](const GroundPoint& point) { return point.ahead_on_plane > nearest + kLength * h; };
  strip.erase(std::remove_if(strip.begin(), strip.end(), far), strip.end());
  if (strip.size() < kFewest) return;
  std::vector<double> distances, heights;
  for (const GroundPoint& point : strip) {
    distances.push_back(point.ahead);
    heights.push_back(point.height);
  }
  const double place = medianOf(distances), height = medianOf(heights);
  const double information = 1 / medianVariance(strip, height);
  if (!std::isfinite(information)) return;  // no measurement is without an error
  remember({place * ahead + height * n, information, place - nearest}, ahead, kSpacing * h);
}

// Looks at ground that was seen before are added to the patch there, because a single look is uncertain. A
// patch that was carried over unknown steps is not at the same place, and gets no more looks.
void GroundMemory::remember(const Patch& look, const Eigen::Vector3d& ahead, double spacing) {
  const auto beyond = [&](const Patch& patch) { return ahead.dot(look.at - patch.at); };
  if (patches_.empty() || beyond(patches_.back()) >= spacing) {
    patches_.push_back(look);
    if (gap_) ++gap_->seen;
    if (unsettled_) ++unsettled_->seen;
    return;
  }
  const auto nearest = std::min_element(
      patches_.begin(), patches_.end(),
      [&](const Patch& a, const Patch& b) { return std::abs(beyond(a)) < std::abs(beyond(b)); });
  if (std::abs(beyond(*nearest)) < spacing && nearest->drift == 0) nearest->add(look);
}

std::optional<GroundMemory::Below> GroundMemory::below(const Eigen::Vector3d& normal) const {
  const Eigen::Vector3d along = path_ - normal.dot(path_) * normal;
  if (!(along.norm() > 0)) return std::nullopt;
  const Eigen::Vector3d ahead = along.normalized();
  if (!patches_.empty()) {
    const Patch& first = patches_.front();
    const double distance = ahead.dot(first.at);
    if (distance > 0 && distance <= first.reach + kSpacing * normal.dot(first.at))
      return Below{normal.dot(first.at), first.variance()};
  }
  for (size_t i = 1; i < patches_.size(); ++i) {
    const Patch &a = patches_[i - 1], &b = patches_[i];
    const double from = ahead.dot(a.at), to = ahead.dot(b.at);
    if (from > 0 || to < 0) continue;
    const double height_a = normal.dot(a.at), height_b = normal.dot(b.at);
    if (to - from > kLargestGap * std::max(height_a, height_b)) return std::nullopt;
    const double share = to > from ? -from / (to - from) : 0;
    return Below{height_a + share * (height_b - height_a), std::max(a.variance(), b.variance())};
  }
  return std::nullopt;
}

}  // namespace uav_landing
