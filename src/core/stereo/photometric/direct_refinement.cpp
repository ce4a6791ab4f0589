#include "stereo/photometric/direct_refinement.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/bias_variance.h"
#include "stereo/photometric/pair_disparities.h"
#include "stereo/photometric/sample_stddevs.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {
namespace {

// Gauss-Newton steps at most, and the change of the largest disparity that ends them, in pixels or as a share
// of it, whichever is larger. A step leaves about a tenth of itself, so that such a share moves the height by
// 5e-5 of itself; in noise, where less is sure, the share does not count.
constexpr int kSteps = 10, kBriefSteps = 2;
constexpr double kConverged = 0.01, kConvergedShare = 5e-4;
// By how much disparities of the first plane may be off, pixels.
constexpr double kStartStddev = 0.3;
// Share of the blocks that must be on the plane. Blocks are compared where the plane says, nowhere else:
// where much of the picture stands on the ground, those that are on the plane by chance would have too much
// to say.
constexpr double kLeastShare = 0.5;

// What edges say of the rows is no better than this, 1 sigma, pixels: in the middle of the image, and at a
// focal length beside it what is linear in the column. Edges of the same markings are wrong together, and
// over simulated approaches what they said was off by several of the sigmas that independent ones would have.
// Of yaw they say hardly anything: it moves rows only where they are away from both middle lines of the
// image.
constexpr double kEdgesStddev = 0.004, kEdgesSlopeStddev = 0.008, kEdgesYawStddev = 0.2;

/// What rows may be off by besides what matches claim of the rotation, 1 sigma: where much of the texture is
/// noise windows keep a little to where they are looked for. By simulated approaches, as what is needed for
/// the claims to be true.
Eigen::Matrix3d priorOf(const RigRotation& rows, bool noisy) {
  const double unseen = noisy ? 0.1 : 0.04;
  return rows.covariance + unseen * unseen * rows.w * rows.w.transpose();
}

/// What counts of the information (1/rad^2) that edges have of the rows, as a factor on its left: their
/// covariance plus what they are wrong by together.
Eigen::Matrix3d believedShare(const Eigen::Matrix3d& information, double fy) {
  const Eigen::Array3d stddevs(kEdgesStddev, kEdgesYawStddev, kEdgesSlopeStddev);
  const Eigen::Matrix3d together = (stddevs / fy).square().matrix().asDiagonal();
  return (Eigen::Matrix3d::Identity() + information * together).inverse();
}

/// What edges say of the rows, of the last twenty pairs or so together: each pair's noise is its own, and
/// the rig's rotation is not.
class RowsByEdges {
 public:
  /// information: of a pair, 1/rad^2; right: that times the rotation, from about.
  void add(const Eigen::Matrix3d& information, const Eigen::Vector3d& right, const Eigen::Vector3d& about) {
    constexpr double kKept = 0.95;  // of a pair's weight when the next comes
    if (!information.allFinite() || !right.allFinite() || !about.allFinite()) return;
    sums_.information = kKept * before_.information + information;
    sums_.right = kKept * before_.right + right + information * about;
  }
  /// A pair, of which there may be nothing to add.
  void begin() { before_ = sums_; }
  void forgetLast() { sums_ = before_; }
  const Eigen::Matrix3d& information() const { return sums_.information; }
  Eigen::Vector3d right(const Eigen::Vector3d& about) const {
    return sums_.right - sums_.information * about;
  }

 private:
  struct Sums {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
  } sums_, before_;
};

}  // namespace

struct DirectRefinement::Implementation {
  StereoRig rig;
  PairDisparities disparities;
  std::vector<DisparitySample> samples;  // of the disparities found, with true stddevs
  double common_variance = 0;            // of an error that all of them have, pixels^2
  int agreeing = 0;                      // blocks that look alike and are on the plane
  RowsByEdges edges;
  PlaneColumns memory;

  Implementation(const RigModel& model, int margin) : rig(model.rig), disparities(model, margin) {}

  void takeSamples(const Eigen::Vector3d& g, const PlaneDrift& drift) {
    samples.clear();
    for (const BlockDisparity& disparity : disparities.found()) samples.push_back(disparity.sample);
    carryToStamp(rig, drift, samples);
    common_variance = makeStddevsTrue(rig, g, disparities.haveCommonErrors() ? 1 : 0, samples);
  }

  // The plane of what the last comparison found. rough: the first plane, g, may be off by kStartStddev.
  Expected<PlaneFit> fitFound(const Eigen::Vector3d& g, const PlaneDrift& drift, const PlaneLimits& limits,
                              double bias_stddev, bool rough) {
    agreeing = 0;
    if (static_cast<int>(disparities.found().size()) < limits.min_points)
      return tl::make_unexpected(tooFew(limits.min_points));
    takeSamples(g, drift);
    for (DisparitySample& sample : samples)
      if (rough) sample.stddev = std::sqrt(sample.stddev * sample.stddev + kStartStddev * kStartStddev);
    Expected<PlaneFit> fit = refinePlane(rig, samples, g, limits, bias_stddev, memory);
    if (!fit) return fit;
    agreeing = blocksOn(*fit);
    if (agreeing < kLeastShare * disparities.informative()) return tl::make_unexpected(tooFewOnThePlane());
    return fit;
  }

  // Blocks and not samples: a share of them must not depend on how many speak together.
  int blocksOn(const PlaneFit& fit) const {
    int blocks = 0;
    for (size_t i = 0; i < samples.size(); ++i)
      if (fit.agrees[i]) blocks += disparities.found()[i].blocks;
    return blocks;
  }

  // What edges aslant say of the rows: those that lean to opposite sides would be on planes of their own. A
  // step of the least squares problem of plane and rows together, the rows known by their prior, and by the
  // edges of the pairs before. about: rotation that samples have been freed of, of the images as they were.
  void solveWithRows(const Eigen::Matrix3d& prior, const Eigen::Vector3d& about, double bias_stddev,
                     PlaneFit& fit) {
    Eigen::Matrix3d by_plane = Eigen::Matrix3d::Zero(), mixed = by_plane, by_rows = by_plane;
    Eigen::Vector3d plane_right = Eigen::Vector3d::Zero(), rows_right = plane_right;
    for (size_t i = 0; i < samples.size(); ++i) {
      if (!fit.agrees[i]) continue;
      const double precision = 1 / samples[i].stddev;
      const Eigen::Vector3d row = precision * rig.fb() * rig.ray(samples[i].u, samples[i].v);
      const Eigen::Vector3d leak = precision * disparities.found()[i].leak.transpose();
      const double residual = precision * samples[i].disparity - row.dot(fit.plane.g);
      by_plane += row * row.transpose();
      mixed += row * leak.transpose();
      by_rows += leak * leak.transpose();
      plane_right += row * residual;
      rows_right += leak * residual;
    }
    const Eigen::Matrix3d plane_by_rows = by_plane.inverse() * mixed;
    // Residuals that are larger than claimed, or alike, tell the rows the worse, as they tell the plane.
    Eigen::Matrix3d own = fit.plane.covariance;
    own(2, 2) -= biasVariance(rig, bias_stddev);
    const double inflation = std::max(1.0, (by_plane * own).trace() / 3);
    edges.add((by_rows - mixed.transpose() * plane_by_rows) / inflation,
              (rows_right - plane_by_rows.transpose() * plane_right) / inflation, about);
    const Eigen::Matrix3d share = believedShare(edges.information(), rig.fy);
    const Eigen::Matrix3d information = share * edges.information();
    const Eigen::Matrix3d covariance = prior * (Eigen::Matrix3d::Identity() + information * prior).inverse();
    const Eigen::Vector3d w = covariance * share * edges.right(about);
    for (size_t i = 0; i < samples.size(); ++i) samples[i].disparity -= disparities.found()[i].leak.dot(w);
    fit.plane.g -= plane_by_rows * w;
    fit.row_covariance = plane_by_rows * covariance * plane_by_rows.transpose();
    fit.plane.covariance += fit.row_covariance;
  }

  // Of the weighted fit's covariance, by what the samples' variances are made of; the mean of its three
  // directions.
  double lastingShare(const PlaneFit& fit) const {
    constexpr double kLeast = 1e-3;
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero(), lasting = information;
    for (size_t i = 0; i < samples.size(); ++i) {
      if (!fit.agrees[i]) continue;
      const double variance = samples[i].stddev * samples[i].stddev;
      const Eigen::Vector3d row = rig.fb() * rig.ray(samples[i].u, samples[i].v);
      information += row * row.transpose() / variance;
      lasting += common_variance / (variance * variance) * row * row.transpose();
    }
    return std::clamp((information.inverse() * lasting).trace() / 3, kLeast, 1.0);
  }

  Failure tooFew(int least) const {
    return {Reason::kTooFewMatches, std::to_string(disparities.found().size()) + " blocks match, at least " +
                                        std::to_string(least) + " needed"};
  }
  Failure tooFewOnThePlane() const {
    return {Reason::kNoPlane, std::to_string(agreeing) + " of " + std::to_string(disparities.informative()) +
                                  " blocks are on the plane: too few to tell which are ground"};
  }

  // Largest disparity at the bottom of the image, where they are largest, of a plane or of a change of it.
  double largestDisparity(const Eigen::Vector3d& g) const {
    const double bottom = rig.size.height - 1, right = rig.size.width - 1;
    return rig.fb() * std::max(std::abs(g.dot(rig.ray(0, bottom))), std::abs(g.dot(rig.ray(right, bottom))));
  }
};

DirectRefinement::DirectRefinement(const RigModel& model, int margin)
    : implementation_(std::make_unique<Implementation>(model, margin)) {}
DirectRefinement::~DirectRefinement() = default;
DirectRefinement::DirectRefinement(DirectRefinement&&) noexcept = default;

Expected<PlaneFit> DirectRefinement::refine(const cv::Mat& left, const cv::Mat& right,
                                            const RefinementStart& start, const PlaneLimits& limits,
                                            double bias_stddev) {
  Implementation& own = *implementation_;
  own.edges.begin();
  own.disparities.begin(left, right, start.plane, start.rows, start.drift);
  const int last = start.brief ? kBriefSteps : kSteps;
  Eigen::Vector3d g = start.plane;
  bool rough = true;
  for (int step = 0;; ++step) {
    if (step > 0) own.disparities.measure(right, g, start.rows, start.drift);
    Expected<PlaneFit> fit = own.fitFound(g, start.drift, limits, bias_stddev, rough);
    if (!fit && step == 0 && own.disparities.areFaint()) continue;
    if (!fit) return fit;
    const double change = own.largestDisparity(fit->plane.g - g);
    const double share = noisy() ? 0 : kConvergedShare * own.largestDisparity(g);
    const double least = std::max(kConverged, share);
    if (step + 1 == last || (!rough && change < least)) {
      fit->lasting_share = own.lastingShare(*fit);
      own.solveWithRows(priorOf(start.rows, noisy()), start.levelled_by + start.rows.w, bias_stddev, *fit);
      // What has not settled is known no better than it moves.
      if (change > least) fit->plane.covariance(2, 2) += std::pow(change / own.rig.fb(), 2);
      return fit;
    }
    g = fit->plane.g;
    rough = false;
  }
}

void DirectRefinement::forgetLast() { implementation_->edges.forgetLast(); }

void DirectRefinement::reset() { implementation_->edges = RowsByEdges(); }

double DirectRefinement::agreement() const {
  constexpr int kFewest = 20;
  const Implementation& own = *implementation_;
  const int informative = own.disparities.informative();
  return informative < kFewest ? kUnknown : static_cast<double>(own.agreeing) / informative;
}

bool DirectRefinement::noisy() const { return implementation_->disparities.haveCommonErrors(); }

const std::vector<DisparitySample>& DirectRefinement::samples() const { return implementation_->samples; }

bool samePlane(const GroundPlane& a, const GroundPlane& b) {
  constexpr double kSigmas = 5.0;
  const Eigen::Vector3d difference = a.g - b.g;
  const Eigen::Matrix3d covariance = a.covariance + b.covariance;
  return difference.dot(covariance.ldlt().solve(difference)) < kSigmas * kSigmas;
}

void doubt(GroundPlane& plane, const GroundPlane& contradicting) {
  const Eigen::Vector3d between = contradicting.g - plane.g;
  plane.covariance += between * between.transpose();
}

}  // namespace uav_landing
