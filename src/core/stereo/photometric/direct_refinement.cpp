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

// Limits of the Gauss-Newton iteration. It ends when the largest disparity changes by less than kConverged
// pixels or kConvergedShare of itself, whichever is larger. A step leaves about a tenth of itself, so this
// share moves the height by 5e-5 of itself. In noise less is certain, so the share does not count there.
constexpr int kSteps = 10, kBriefSteps = 2;
constexpr double kConverged = 0.01, kConvergedShare = 5e-4;
// Error of the first plane's disparities, pixels.
constexpr double kStartStddev = 0.3;
// Share of the blocks that must be on the plane. Blocks are compared only where the plane predicts them. If
// much of the image stands on the ground, the blocks that agree by chance would decide too much.
constexpr double kLeastShare = 0.5;

// Smallest 1 sigma of the rows by edges, pixels: in the middle of the image, and for the part linear in the
// column at a focal length beside it. Edges of the same markings are wrong together: over simulated
// approaches they were off by several sigmas of independent errors. They hardly tell the yaw, which moves
// rows only away from both middle lines of the image.
constexpr double kEdgesStddev = 0.004, kEdgesSlopeStddev = 0.008, kEdgesYawStddev = 0.2;

/// Covariance of the rows: what matches claim, plus an error that they do not see, 1 sigma. Where much of the
/// texture is noise, windows stay a little near the place where they are looked for. The sizes make the
/// claims true over simulated approaches.
Eigen::Matrix3d priorOf(const RigRotation& rows, bool noisy) {
  const double unseen = noisy ? 0.1 : 0.04;
  return rows.covariance + unseen * unseen * rows.w * rows.w.transpose();
}

/// Factor from the left on the edges' information of the rows (1/rad^2), which makes their common errors
/// count.
Eigen::Matrix3d believedShare(const Eigen::Matrix3d& information, double fy) {
  const Eigen::Array3d stddevs(kEdgesStddev, kEdgesYawStddev, kEdgesSlopeStddev);
  const Eigen::Matrix3d together = (stddevs / fy).square().matrix().asDiagonal();
  return (Eigen::Matrix3d::Identity() + information * together).inverse();
}

/// Evidence of edges about the rows, over about the last twenty pairs. Each pair has its own noise, but the
/// rotation of the rig stays.
class RowsByEdges {
 public:
  /// information: of a pair, 1/rad^2. right: information times the rotation, counted from about.
  void add(const Eigen::Matrix3d& information, const Eigen::Vector3d& right, const Eigen::Vector3d& about) {
    constexpr double kKept = 0.95;  // a pair's weight falls by this factor with each later pair
    if (!information.allFinite() || !right.allFinite() || !about.allFinite()) return;
    sums_.information = kKept * before_.information + information;
    sums_.right = kKept * before_.right + right + information * about;
  }
  /// Begins a pair, which may add nothing.
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
  double common_variance = 0;            // of an error that all samples share, pixels^2
  int agreeing = 0;                      // blocks that look alike and are on the plane
  RowsByEdges edges;
  PlaneColumns memory;

  Implementation(const RigModel& model, int margin) : rig(model.rig), disparities(model, margin) {}

  void takeSamples(const PlaneVector& g, const PlaneDrift& drift) {
    samples.clear();
    for (const BlockDisparity& disparity : disparities.found()) samples.push_back(disparity.sample);
    carryToStamp(rig, drift, samples);
    common_variance = makeStddevsTrue(rig, g, disparities.haveCommonErrors() ? 1 : 0, samples);
  }

  // Fits the plane to the last comparison. rough: the first plane, g, may be off by kStartStddev.
  Expected<PlaneFit> fitFound(const PlaneVector& g, const PlaneDrift& drift, const PlaneLimits& limits,
                              double bias_stddev, bool rough) {
    agreeing = 0;
    if (static_cast<int>(disparities.found().size()) < limits.min_points)
      return tl::make_unexpected(tooFew(limits.min_points));
    takeSamples(g, drift);
    for (DisparitySample& sample : samples)
      if (rough) sample.stddev = std::sqrt(sample.stddev * sample.stddev + kStartStddev * kStartStddev);
    Expected<PlaneFit> fit = refinePlane(rig, {samples, bias_stddev}, g, limits, memory);
    if (!fit) return fit;
    agreeing = blocksOn(*fit);
    if (agreeing < kLeastShare * disparities.informative()) return tl::make_unexpected(tooFewOnThePlane());
    return fit;
  }

  // Counts blocks, not samples, because a share must not depend on how many blocks are joined.
  int blocksOn(const PlaneFit& fit) const {
    int blocks = 0;
    for (size_t i = 0; i < samples.size(); ++i)
      if (fit.agrees[i]) blocks += disparities.found()[i].blocks;
    return blocks;
  }

  // Solves for plane and rows together. Slanted edges tell the rows: with wrong rows, those that lean to
  // opposite sides would lie on different planes. The rows have a prior and the edges of the pairs before.
  // about: rotation that was removed from the samples, counted from the images as they came.
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
    // When residuals are larger than claimed, or alike, they tell the rows less well, too.
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

  // Share of the weighted fit's covariance that comes from the samples' common variance, as the mean of its
  // three directions.
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

  // Largest disparity of a plane, or of a change of it. It lies at the bottom of the image.
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
  PlaneVector g = start.plane;
  bool rough = true;
  for (int step = 0;; ++step) {
    if (step > 0) own.disparities.measure(right, g, start.rows, start.drift);
    Expected<PlaneFit> fit = own.fitFound(g, start.drift, limits, bias_stddev, rough);
    if (!fit && step == 0 && own.disparities.areFaint()) continue;
    if (!fit) return fit;
    const double change = own.largestDisparity(fit->plane.g - g.vector());
    const double share = noisy() ? 0 : kConvergedShare * own.largestDisparity(g);
    const double least = std::max(kConverged, share);
    if (step + 1 == last || (!rough && change < least)) {
      fit->lasting_share = own.lastingShare(*fit);
      own.solveWithRows(priorOf(start.rows, noisy()), start.levelled_by + start.rows.w, bias_stddev, *fit);
      // While it has not converged, the plane is known no better than it still moves.
      if (change > least) fit->plane.covariance(2, 2) += std::pow(change / own.rig.fb(), 2);
      return fit;
    }
    g = PlaneVector(fit->plane.g);
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
