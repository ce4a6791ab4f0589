#include "uav_landing/stages/stereo_depth_stage.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "image/input/image_check.h"
#include "image/input/learned_frame.h"
#include "image/windows/corners.h"
#include "image/windows/match_image.h"
#include "stereo/matching/corner_matcher.h"
#include "stereo/matching/corner_matching.h"
#include "stereo/photometric/direct_refinement.h"
#include "stereo/plane/corner_plane.h"
#include "stereo/plane/plane_fit.h"
#include "stereo/plane/plane_tracker.h"
#include "stereo/plane/spread_search.h"
#include "stereo/rows/vertical_disparity.h"
#include "stereo/surface/surface_profile.h"
#include "stereo/surface/surface_variance.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180.0;
// Factor by which errors of corners exceed their claims when texture is hardly more than noise. Gradients in
// the windows are then those of the noise. Measured in a hundred pairs of one simulated scene: 1.6.
constexpr double kNoisyCorners = 2.0;

}  // namespace

struct StereoDepthStage::Implementation {
  RigModel model;
  StereoDepthParameters parameters;
  PlaneLimits limits;
  std::unique_ptr<CornerMatcher> matcher;
  PlaneTracker tracker;
  StereoLevel fine, coarse;
  LearnedFrame own_frame;
  cv::Mat left_mask;  // of the fine level, before the aircraft's own frame is left out
  MatchImage left, right;
  RowAlignment rows;
  cv::Mat level_fine, level_coarse;  // right images whose rows were made level
  std::unique_ptr<DirectRefinement> direct;
  cv::Mat right_grey, level_grey, level_image;  // for the direct refinement with a bent rig
  RepeatedImage left_repeated, right_repeated;
  SpreadSearch search;
  SurfaceMemory surface_memory;
  ReadoutCheck readout;
  double later_rows;  // s, by which the rows of the right camera are later
  Timings timings;

  Implementation(const RigModel& rig, const StereoDepthParameters& p, std::unique_ptr<CornerMatcher> given)
      : model(rig),
        parameters(p),
        limits{p.max_roll_deg * kDegree, p.max_pitch_deg * kDegree, p.min_points, p.plane_tolerance},
        matcher(given ? std::move(given) : makeRowMatcher(p)),
        tracker(rig.rig, p, limits, cornerBudget(rig.rig.size, p.corner_count, p.pixels_per_corner),
                *matcher),
        own_frame(rig.rig.size),
        rows(p.vertical_disparities, p.window_radius, p.disparity_bias_stddev, p.row_bias_stddev),
        search(rig, coarseFactor(rig.rig.size), p, limits),
        readout(rig.left_times, rig.right_times),
        later_rows(laterRows(rig.left_times, rig.right_times, rig.rig.size)) {
    fine.rig = rig.rig;
    fine.left_mask = erodeMask(rig.left_mask, p.window_radius + 2);
    fine.right_mask = erodeMask(rig.right_mask, p.window_radius + 2);
    left_mask = fine.left_mask;
    coarse = reduceLevel(rig, coarseFactor(rig.rig.size), p.window_radius + 2);
    if (p.direct_refinement) direct = std::make_unique<DirectRefinement>(rig, p.window_radius + 2);
  }

  StereoDepthResult process(double stamp, const cv::Mat& left_image, const cv::Mat& right_image) {
    timings.clear();
    StereoDepthResult result;
    result.stamp = stamp;
    tracker.begin(stamp);
    search.begin(tracker.duration());
    result.failure = checkPair(model, left_image, right_image);
    const Failure too_long = readout.follow(stamp);
    if (!result.failure) result.failure = too_long;
    fine.drift = {tracker.steadyRate(), &model.left_times};
    if (result.failure.reason != Reason::kInputInvalid) {
      result.left_repeated = left_repeated.check(left_image);
      result.right_repeated = right_repeated.check(right_image);
    }
    if (!result.failure) estimate(left_image, right_image, result);
    if (result.failure) {
      tracker.miss();
      own_frame.reset();
    }
    leaveOutOwnFrame();
    return result;
  }

  // In the next pair no corner is looked for on the aircraft's own frame, as this pair shows it. The margin
  // keeps the matching windows free of it, too.
  void leaveOutOwnFrame() { fine.left_mask = own_frame.leftOut(left_mask, parameters.window_radius + 2); }

  void learnOwnFrame(double stamp, const cv::Mat& left_image, const MatchedCorners& corners) {
    ScopedTimer timer(timings, "own_frame");
    std::vector<cv::Point> on_ground;
    const std::vector<DisparitySample>& samples = corners.matches.samples;
    for (size_t i = 0; i < samples.size(); ++i)
      if (corners.fit.agrees[i] != 0) on_ground.emplace_back(cvRound(samples[i].u), cvRound(samples[i].v));
    own_frame.observe(stamp, left_image, corners.corners, on_ground);
  }

  // The drift that the rows of the pair see. When no readout time is given, this is the drift at a readout of
  // 1 s.
  PlaneDrift rowDrift() const {
    return {fine.drift.rate, model.left_unit_times.atOnce() ? fine.drift.times : &model.left_unit_times};
  }

  // Width and height of the corners' matching windows, pixels.
  int window() const { return 2 * parameters.window_radius + 1; }

  void estimate(const cv::Mat& left_image, const cv::Mat& right_image, StereoDepthResult& result) {
    {
      ScopedTimer timer(timings, "match_images");
      // Making rows level takes other rows of the image.
      const FirstRows first = tracker.hasLast() && rows.isLevel() ? tracker.lastGroundRows() : FirstRows();
      left.assign(left_image, first);
      right.assign(right_image, first);
    }
    fine.left = left.fine;
    coarse.left = left.coarse;
    levelRows();
    std::optional<MatchedCorners> steady = matchSteadily(left_image, right_image, result);
    const MatchedCorners corners =
        steady ? std::move(*steady) : searchAndMatch(left_image, right_image, result);
    if (result.failure) return;
    learnOwnFrame(result.stamp, left_image, corners);
    measureRows(corners, result);
    const bool refined = direct && refineDirectly(left_image, right_image, result);
    if (!refined) keepPlaneOf(corners, result);
    // When the images contradict the plane, the next pair searches again.
    tracker.remember(result, refined || !direct);
    if (!refined && result.from_search) waitForNextPair(result);
  }

  // A search finds some plane even in pure noise. A plane that the alignment of the images does not confirm
  // counts only when the next pair has it as well.
  void waitForNextPair(StereoDepthResult& result) {
    StereoDepthResult waiting;
    waiting.stamp = result.stamp;
    waiting.failure = {Reason::kNotYet, "a new ground plane: the next pair has to confirm it"};
    waiting.corners = result.corners;
    waiting.points = std::move(result.points);
    for (StereoDepthResult::Point& point : waiting.points) point.on_plane = false;
    waiting.from_search = true;
    waiting.photometric_agreement = result.photometric_agreement;
    waiting.left_repeated = result.left_repeated;
    waiting.right_repeated = result.right_repeated;
    result = std::move(waiting);
  }

  void levelRows() {
    ScopedTimer timer(timings, "vertical_disparities");
    fine.right = rows.level(fine.rig, right.fine, level_fine);
    coarse.right = rows.level(coarse.rig, right.coarse, level_coarse);
  }

  // Matching needs these rows of the images, too.
  void extend(const cv::Mat& left_image, const cv::Mat& right_image, const FirstRows& first) {
    ScopedTimer timer(timings, "match_images");
    left.extend(left_image, first);
    right.extend(right_image, first);
  }

  // Matches with the plane as it is expected to move on, unless the pair shows that it is elsewhere.
  std::optional<MatchedCorners> matchSteadily(const cv::Mat& left_image, const cv::Mat& right_image,
                                              StereoDepthResult& result) {
    const std::optional<PlaneVector> steady = tracker.steadyPlane(timings);
    if (!steady) return std::nullopt;
    extend(left_image, right_image, tracker.groundRows(*steady));
    StereoDepthResult attempt = result;
    MatchedCorners corners = matchedCorners(*steady, attempt);
    if (attempt.failure || !tracker.bearsOut(attempt)) return std::nullopt;
    result = std::move(attempt);
    return corners;
  }

  // Matches with a plane that is followed from the previous pair, or that is searched.
  MatchedCorners searchAndMatch(const cv::Mat& left_image, const cv::Mat& right_image,
                                StereoDepthResult& result) {
    const bool known = tracker.hasLast();
    const std::optional<PlaneVector> followed = tracker.follow(fine, coarse, left.factor, timings);
    if (followed) {
      search.stop();
    } else {
      extend(left_image, right_image, FirstRows());
    }
    const Expected<PlaneVector> start = followed ? *followed : searchedPlane(known, result);
    if (!start) {
      result.failure = start.error();
      return {};
    }
    extend(left_image, right_image, tracker.groundRows(*start));
    return matchedCorners(*start, result);
  }

  Expected<PlaneVector> searchedPlane(bool followed, StereoDepthResult& result) {
    ScopedTimer timer(timings, "plane_search");
    result.from_search = true;
    return search.find(coarse, tracker, followed);
  }

  // Matches the corners and fits their plane. If that fails, the result says why.
  MatchedCorners matchedCorners(const PlaneVector& start, StereoDepthResult& result) {
    MatchedCorners matched;
    matched.corners = tracker.cornersOn(fine, start, timings);
    result.corners = static_cast<int>(matched.corners.size());
    // The rows of a bent rig must be level before anything is matched along them.
    if (result.from_search && rows.search(fine, matched.corners, start)) levelRows();
    {
      ScopedTimer timer(timings, "feature_matching");
      matched.matches = matcher->match(fine, matched.corners, start);
      carryToStamp(model.rig, fine.drift, matched.matches.samples);
    }
    fit(start, matched, result);
    return matched;
  }

  void fit(const PlaneVector& expected, MatchedCorners& corners, StereoDepthResult& result) {
    ScopedTimer timer(timings, "plane_fit");
    const std::vector<DisparitySample>& samples = corners.matches.samples;
    for (const DisparitySample& sample : samples)
      result.points.push_back({sample.u, sample.v, sample.disparity, sample.stddev, false});
    Expected<PlaneFit> plane =
        fitCorners(model.rig, {samples, parameters.disparity_bias_stddev}, result.corners, expected, limits);
    if (!plane) {
      result.failure = plane.error();
      return;
    }
    corners.fit = std::move(*plane);
    const PlaneFit& fit = corners.fit;
    result.plane = fit.plane;
    if (!rowDrift().isStill()) result.plane_rate = fine.drift.rate;
    result.plane_by_rate = planeByRate(model.rig, rowDrift(), samples, fit.agrees);
    result.residual_stddev = fit.residual_stddev;
    result.surface_variance = surfaceVariance(model.rig, samples, fit, window(), surface_memory);
    for (size_t i = 0; i < samples.size(); ++i) result.points[i].on_plane = fit.agrees[i] != 0;
    result.disparity_bias_stddev = parameters.disparity_bias_stddev;
    result.row_bias_stddev = parameters.row_bias_stddev;
  }

  void measureRows(const MatchedCorners& corners, StereoDepthResult& result) {
    ScopedTimer timer(timings, "vertical_disparities");
    const PlaneVector g(result.plane.g);
    const RowAlignment::Measured measured = rows.measure(fine, corners.corners, corners.matches, g);
    result.vertical_rotation = measured.rotation;
    result.baseline_direction = measured.baseline;
    result.row_agreement = measured.agreement;
    result.row_covariance = rowLeak(fine.rig, rows.residual(fine.rig), g);
    result.plane.covariance += result.row_covariance;
  }

  // The right image as the camera saw it, with its rows made level if they are not.
  cv::Mat withLevelRows(const cv::Mat& right_image) {
    if (fine.right.data == right.fine.data) return right_image;
    right_image.convertTo(right_grey, CV_32F);
    rows.levelAgain(fine.rig, right_grey, level_grey).convertTo(level_image, CV_8U);
    return level_image;
  }

  // Refines the plane by the alignment of the images. If that leads elsewhere, the plane of the corners
  // stays, and the function returns false.
  bool refineDirectly(const cv::Mat& left_image, const cv::Mat& right_image, StereoDepthResult& result) {
    ScopedTimer timer(timings, "direct_refinement");
    RefinementStart start{PlaneVector(result.plane.g), rows.residual(fine.rig), rows.levelledBy(),
                          fine.drift};
    start.brief = result.from_search && !parameters.search_at_once;
    const Expected<PlaneFit> fit = direct->refine(left_image, withLevelRows(right_image), start, limits,
                                                  parameters.disparity_bias_stddev);
    result.photometric_agreement = direct->agreement();
    if (!fit) return false;
    if (direct->noisy()) result.plane.covariance *= kNoisyCorners * kNoisyCorners;
    if (!samePlane(fit->plane, result.plane)) {
      doubt(result.plane, fit->plane);
      direct->forgetLast();
      return false;
    }
    result.plane = fit->plane;
    result.plane_by_rate = planeByRate(model.rig, rowDrift(), direct->samples(), fit->agrees);
    result.row_covariance = fit->row_covariance;
    result.lasting_share = fit->lasting_share;
    // Rows that are not level move all corners of a marking, as if the ground rose. Blocks are free of that.
    result.surface_variance = surfaceVariance(model.rig, direct->samples(), *fit, 1, surface_memory);
    bend(direct->samples(), *fit, result.row_covariance, result);
    return true;
  }

  void keepPlaneOf(const MatchedCorners& corners, StereoDepthResult& result) {
    result.plane.covariance +=
        sharedCovariance(model.rig, corners, window(), parameters.disparity_bias_stddev);
    bend(corners.matches.samples, corners.fit, result.plane.covariance - corners.fit.plane.covariance,
         result);
  }

  // flat: the fit to the samples. besides: part of the covariance that the samples do not know.
  void bend(const std::vector<DisparitySample>& seen, const PlaneFit& flat, const Eigen::Matrix3d& besides,
            StereoDepthResult& result) {
    if (!parameters.surface_curvature) return;
    ScopedTimer timer(timings, "surface_profile");
    const std::optional<SurfaceProfile> profile =
        fitSurfaceProfile(model.rig, {seen, parameters.disparity_bias_stddev}, flat, limits,
                          parameters.slope_change_deg * kDegree);
    if (!profile) return;
    result.below = profile->below;
    result.below.covariance += besides;
    result.curvature = profile->curvature;
    result.curvature_variance = profile->curvature_variance;
  }
};

StereoDepthStage::StereoDepthStage(const RigModel& rig, const StereoDepthParameters& parameters)
    : StereoDepthStage(rig, parameters, nullptr) {}
StereoDepthStage::StereoDepthStage(const RigModel& rig, const StereoDepthParameters& parameters,
                                   std::unique_ptr<CornerMatcher> matcher)
    : implementation_(std::make_unique<Implementation>(rig, parameters, std::move(matcher))) {}
StereoDepthStage::~StereoDepthStage() = default;
StereoDepthStage::StereoDepthStage(StereoDepthStage&&) noexcept = default;

StereoDepthResult StereoDepthStage::process(double stamp, const cv::Mat& left, const cv::Mat& right,
                                            double skew) {
  StereoDepthResult result = implementation_->process(stamp, left, right);
  result.skew = skew + implementation_->later_rows;
  return result;
}

void StereoDepthStage::reset() {
  implementation_->tracker.forget();
  implementation_->search.reset();
  implementation_->own_frame.reset();
  implementation_->leaveOutOwnFrame();
  implementation_->rows.reset();
  if (implementation_->direct) implementation_->direct->reset();
  implementation_->readout.reset();
  implementation_->left_repeated.reset();
  implementation_->right_repeated.reset();
}

double StereoDepthStage::ownFrame() const { return implementation_->own_frame.share(); }

const Timings& StereoDepthStage::timings() const { return implementation_->timings; }

}  // namespace uav_landing
