#include "motion/matching/temporal_matching.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/touch_ahead.h"
#include "image/input/clipping.h"
#include "image/input/image_check.h"
#include "image/windows/patch_matching.h"
#include "image/windows/patch_refiner.h"
#include "kernels/lanes/order_statistic.h"
#include "motion/matching/common_gain.h"

namespace uav_landing {
namespace {

// Whole shifts that are tried at full size around a place known to about a pixel.
constexpr int kFineSteps = 3;
// Error of a match that its residuals do not show, from interpolation and uneven ground in the window,
// pixels.
constexpr double kStddevFloor = 0.03;
constexpr int kReach = 2;  // px beyond a window that smoothing and gradients reach
// Share of a window's deviation from the common gain that is removed. One camera took both images, so most
// gains should be equal. The rest is kept, because texture that is blurred differently from near and from far
// really differs in contrast.
constexpr double kHeldGain = 0.6;
// Typical deviation of a window's gain from the common one.
constexpr double kGainScatter = 0.1;
// Shift of clipped edges when the exposure grows by the factor e, pixels. Such an edge stands where the blur
// of a bright object reaches white, so it moves outwards by about 1 sigma of the blur.
constexpr double kClippedShift = 1.0;
// Windows whose area changes by more than this no longer look alike.
constexpr double kSmallestScale = 0.12, kLargestScale = 6.0;
// A second peak at least this share of the best makes a match ambiguous.
constexpr double kUniqueness = 0.92;

// Appearance of a corner's surroundings in the other image. At a distance d from the corner it is the affine
// one over 1 + perspective.d.
struct LocalWarp {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Matrix2d warp = Eigen::Matrix2d::Identity();
  Eigen::Vector2d perspective = Eigen::Vector2d::Zero();
  Eigen::Matrix2d at_stamp = Eigen::Matrix2d::Identity();  // as if all rows were exposed at once
};

// Maps a pixel (full size) by the homography of a plane, from now to then. Fails when the point lies behind
// the camera.
class PointWarp {
 public:
  PointWarp(const StereoRig& rig, const CameraMotion& motion, const Eigen::Vector3d& plane)
      : H_(rig.K() * motion.R.transpose() * (Eigen::Matrix3d::Identity() + motion.t * plane.transpose()) *
           rig.Kinv()) {}

  bool at(const Eigen::Vector2d& x, LocalWarp* local) const {
    const Eigen::Vector3d y = H_ * x.homogeneous();
    if (!(y.z() > 1e-6)) return false;
    local->centre = y.hnormalized();
    local->warp = (H_.topLeftCorner<2, 2>() - local->centre * H_.block<1, 2>(2, 0)) / y.z();
    local->perspective = H_.block<1, 2>(2, 0).transpose() / y.z();
    local->at_stamp = local->warp;
    const double scale = local->warp.determinant();
    return scale > kSmallestScale && scale < kLargestScale;
  }

 private:
  Eigen::Matrix3d H_;
};

// Predicts where to look for corners, and touches the pixels there so that they are in the cache in time.
class Predictions {
 public:
  Predictions(const CameraFrames& frames, const MotionOverGround& predicted, int radius, int coarse_steps)
      : rig_(frames.rig),
        now_(frames.now),
        then_(frames.then),
        mask_(frames.mask),
        motion_(predicted.motion),
        plane_(rig_, motion_, predicted.normal),
        radius_(radius),
        coarse_steps_(coarse_steps),
        height_then_(1 + predicted.normal.dot(motion_.t)) {
    const RowsOverTime& rows = predicted.rows;
    if (rows.times == nullptr || rows.times->atOnce()) return;
    rows_now_ = StampMap(rig_.K(), *rows.times, rows.now, predicted.normal);
    rows_then_ = StampMap(rig_.K(), *rows.times, rows.then, motion_.R.transpose() * predicted.normal);
  }

  // Returns false when there is no prediction.
  bool at(const TrackedCorner& corner, LocalWarp* local) const {
    constexpr int kAround = 3;  // px, for interpolation and the steps of refinement
    const Eigen::Vector2d x(corner.u, corner.v);
    const bool seen = corner.on_plane
                          ? isSeen(corner, plane_, x, local)
                          : isSeen(corner, PointWarp(rig_, motion_, {0, 0, corner.inverse_depth}), x, local);
    if (!seen) return false;
    touchPixel(mask_, local->centre.x(), local->centre.y());
    touchWindow(now_.fine, corner.u, corner.v, radius_ + 1, radius_ + 1);
    touchWindow(then_.fine, local->centre.x(), local->centre.y(), radius_ + kAround, radius_ + kAround);
    if (coarse_steps_ > 0) touchCoarsely(x, local->centre);
    return true;
  }

  // Moves both places of a match to where they would be with all rows exposed at the stamps.
  void carryToStamps(TemporalMatch& match) const {
    if (rows_now_.changesNothing()) return;
    if (match.on_plane) {
      match.now = rows_now_.toStamp(match.now);
      match.then = rows_then_.toStamp(match.then);
    } else {
      match.now = rows_now_.toStamp(match.now, match.inverse_depth);
      match.then = rows_then_.toStamp(match.then, inverseDepthThen(match.now, match.inverse_depth));
    }
  }

 private:
  bool isSeen(const TrackedCorner& corner, const PointWarp& warp, const Eigen::Vector2d& x,
              LocalWarp* local) const {
    return rows_now_.changesNothing() ? warp.at(x, local) : throughRows(corner, warp, x, local);
  }

  // Place of a pixel in the image then, with the times of both rows.
  bool placeThen(const TrackedCorner& corner, const PointWarp& warp, const Eigen::Vector2d& x,
                 LocalWarp* local) const {
    const Eigen::Vector2d now =
        corner.on_plane ? rows_now_.toStamp(x) : rows_now_.toStamp(x, corner.inverse_depth);
    if (!warp.at(now, local)) return false;
    local->centre = corner.on_plane
                        ? rows_then_.toRow(local->centre)
                        : rows_then_.toRow(local->centre, inverseDepthThen(now, corner.inverse_depth));
    return true;
  }

  // Row times shear and stretch the surroundings of a corner. So the warp is computed from differences.
  bool throughRows(const TrackedCorner& corner, const PointWarp& warp, const Eigen::Vector2d& x,
                   LocalWarp* local) const {
    constexpr double kApart = 2;  // px
    if (!placeThen(corner, warp, x, local)) return false;
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = kApart * Eigen::Vector2d::Unit(axis);
      LocalWarp before, behind;
      if (!placeThen(corner, warp, x - step, &before) || !placeThen(corner, warp, x + step, &behind))
        return false;
      local->warp.col(axis) = (behind.centre - before.centre) / (2 * kApart);
    }
    return true;
  }

  // Inverse depth then, times the height then, of a point at this pixel with this inverse depth now.
  double inverseDepthThen(const Eigen::Vector2d& now, double inverse_depth) const {
    const Eigen::Vector3d seen = motion_.seenThen(rig_.ray(now.x(), now.y()), inverse_depth);
    return height_then_ * inverse_depth / seen.z();
  }

  void touchCoarsely(const Eigen::Vector2d& corner, const Eigen::Vector2d& there) const {
    constexpr int kAround = 2;  // px, for interpolation
    const int factor = now_.factor, reach = radius_ + coarse_steps_ + kAround;
    touchWindow(now_.coarse, toCoarse(corner.x(), factor), toCoarse(corner.y(), factor), radius_, radius_);
    touchWindow(then_.coarse, toCoarse(there.x(), factor), toCoarse(there.y(), factor), reach, reach);
  }

  const StereoRig& rig_;
  const MatchImage &now_, &then_;
  const cv::Mat& mask_;
  const CameraMotion& motion_;
  PointWarp plane_;
  int radius_, coarse_steps_;
  double height_then_;  // as a multiple of the height now
  StampMap rows_now_, rows_then_;
};

// Finds corners near their predicted places.
class Follower {
 public:
  Follower(const CameraFrames& frames, const TemporalMatchOptions& options)
      : now_(frames.now),
        then_(frames.then),
        mask_(frames.mask),
        options_(options),
        coarse_(now_.coarse, then_.coarse, options.window_radius),
        fine_(now_.fine, then_.fine, options.window_radius) {}

  // Returns a refinement that has not converged when the corner is not found.
  PatchRefinement find(const TrackedCorner& corner, const LocalWarp& predicted, OwnTexture& own) {
    LocalWarp local = predicted;
    if (options_.coarse_steps > 0 && !searchCoarsely(corner, local)) return {};
    PatchRefinement refined = refine(corner, local.centre, local.warp, own);
    if (!isLike(refined)) {
      // The prediction was not good enough for refinement alone.
      const PatchSearch::Best best = fine_.run(corner.u, corner.v, local.centre, local.warp, kFineSteps);
      if (!best.found || best.score < options_.min_zncc) return {};
      refined = refine(corner, best.position, local.warp, own);
    }
    if (!isLike(refined) || !isSet(mask_, refined.position.x(), refined.position.y()))
      refined.converged = false;
    return refined;
  }

 private:
  // At the coarse level, the window is centred on a whole pixel near the corner. Only its displacement is
  // carried over to full size.
  bool searchCoarsely(const TrackedCorner& corner, LocalWarp& local) {
    const int factor = now_.factor;
    const Eigen::Vector2d centre(toCoarse(corner.u, factor), toCoarse(corner.v, factor));
    const int u = cvRound(centre.x()), v = cvRound(centre.y());
    const Eigen::Vector2d there(toCoarse(local.centre.x(), factor), toCoarse(local.centre.y(), factor));
    const Eigen::Vector2d start = there + local.warp * (Eigen::Vector2d(u, v) - centre);
    const PatchSearch::Best best = coarse_.run(u, v, start, local.warp, options_.coarse_steps);
    if (!best.found || best.score < options_.min_zncc || best.second > kUniqueness * best.score) return false;
    local.centre += factor * (best.position - start);
    return true;
  }

  PatchRefinement refine(const TrackedCorner& corner, const Eigen::Vector2d& at, const Eigen::Matrix2d& warp,
                         OwnTexture& own) const {
    return refinePatch(now_.fine, then_.fine, {corner.u, corner.v, options_.window_radius}, {at, warp}, own);
  }
  bool isLike(const PatchRefinement& refined) const {
    return refined.converged && refined.score >= options_.min_zncc;
  }

  const MatchImage &now_, &then_;
  const cv::Mat& mask_;
  const TemporalMatchOptions& options_;
  PatchSearch coarse_, fine_;
};

// The residuals of most windows contain more than noise: uneven ground and interpolation. The windows that
// fit best show the noise alone.
double noiseVariance(MatchingMemory& memory) {
  constexpr size_t kFit = 4;  // one in so many fits best
  std::vector<double>& residuals = memory.residuals;
  residuals.clear();
  for (const WindowOverTime& corner : memory.windows)
    residuals.push_back(corner.refinement.residual_variance);
  return 0.5 * orderStatistic(residuals.data(), residuals.size(), residuals.size() / kFit);
}

CommonGain commonGainOf(MatchingMemory& memory) {
  memory.means.clear();
  for (const WindowOverTime& corner : memory.windows)
    memory.means.push_back({corner.refinement.evidence.mean, corner.refinement.evidence.mean_there});
  return commonGain(memory.means);
}

// Sets the covariances of the matches and corrects their places. memory: with the windows of the matches.
void claim(const MatchImage& now, const MatchImage& then, int radius, MatchingMemory& memory,
           std::vector<TemporalMatch>& matches) {
  // With a smaller change of exposure, clipped edges move by less than a third of kStddevFloor.
  constexpr double kLeastChange = 0.01;
  if (matches.empty()) return;
  const double noise = noiseVariance(memory);
  const CommonGain gain = commonGainOf(memory);
  const double held = kHeldGain * kGainScatter * kGainScatter / (kGainScatter * kGainScatter + gain.variance);
  const double change = gain.gain > 0 ? std::abs(std::log(gain.gain)) : 0;
  for (size_t i = 0; i < matches.size(); ++i) {
    TemporalMatch& match = matches[i];
    const WindowOverTime& window = memory.windows[i];
    const PatchRefinement::Claim claim = window.refinement.claim(noise);
    // Windows are warped without perspective, so their places need a correction. Over half a second near the
    // ground it is some hundredths of a pixel, always to the same side. In the approach angle it is
    // thousandths of a degree.
    const double off = held * (window.refinement.evidence.gain - gain.gain);
    match.then += claim.by_perspective * window.perspective - off * claim.by_gain;
    double stddev = kStddevFloor;
    if (change > kLeastChange &&
        (isClipped(now.fine, match.now, radius) || isClipped(then.fine, match.then, radius)))
      stddev = std::hypot(stddev, kClippedShift * change);
    match.covariance = claim.covariance + stddev * stddev * Eigen::Matrix2d::Identity();
    match.by_warp = claim.by_warp;
  }
}

}  // namespace

std::vector<TemporalMatch> matchOverTime(const CameraFrames& frames,
                                         const std::vector<TrackedCorner>& corners,
                                         const MotionOverGround& predicted,
                                         const TemporalMatchOptions& options, MatchingMemory& memory) {
  const Predictions predictions(frames, predicted, options.window_radius, options.coarse_steps);
  Follower follower(frames, options);
  std::vector<TemporalMatch> matches = std::move(memory.spare);
  matches.clear();
  matches.reserve(corners.size());
  memory.windows.clear();
  LocalWarp local, next;
  bool next_seen = !corners.empty() && predictions.at(corners.front(), &next);
  for (size_t i = 0; i < corners.size(); ++i) {
    const TrackedCorner& corner = corners[i];
    const bool seen = next_seen;
    local = next;
    if (i + 1 < corners.size()) next_seen = predictions.at(corners[i + 1], &next);
    if (!seen || !isSet(frames.mask, local.centre.x(), local.centre.y())) continue;
    const PatchRefinement refined = follower.find(corner, local, memory.textures.of(i, corner));
    if (!refined.converged) continue;
    TemporalMatch match;
    match.now = {corner.u, corner.v};
    match.then = refined.position;
    match.warp = local.at_stamp;
    match.on_plane = corner.on_plane;
    match.inverse_depth = corner.inverse_depth;
    match.inverse_depth_stddev = corner.inverse_depth_stddev;
    match.extent = 2 * (options.window_radius + kReach) + 1;
    matches.push_back(match);
    memory.windows.push_back({refined, local.perspective});
  }
  claim(frames.now, frames.then, options.window_radius, memory, matches);
  for (TemporalMatch& match : matches) predictions.carryToStamps(match);
  return matches;
}

double likenessOverTime(const CameraFrames& frames, const std::vector<TrackedCorner>& corners,
                        const MotionOverGround& motion, const TemporalMatchOptions& options) {
  const Predictions predictions(frames, motion, options.window_radius, 0);
  PatchSearch there(frames.now.fine, frames.then.fine, options.window_radius);
  double likeness = 0;
  LocalWarp local;
  for (const TrackedCorner& corner : corners) {
    if (!predictions.at(corner, &local) || !isSet(frames.mask, local.centre.x(), local.centre.y())) continue;
    likeness += std::max(0.0, there.run(corner.u, corner.v, local.centre, local.warp, 0).score);
  }
  return likeness;
}

}  // namespace uav_landing
