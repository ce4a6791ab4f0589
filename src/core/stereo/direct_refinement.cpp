#include "uav_landing/stereo/direct_refinement.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "stereo/pair_disparities.h"
#include "stereo/sample_stddevs.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {
namespace {

// Gauss-Newton steps at most, and the change of the largest disparity (pixels) that ends them: a step leaves
// about a tenth of itself.
constexpr int kSteps = 10;
constexpr double kConverged = 0.01;
// By how much disparities of the first plane may be off, pixels.
constexpr double kStartStddev = 0.3;
// Share of the blocks that must be on the plane. Blocks are compared where the plane says, nowhere else:
// where much of the picture stands on the ground, those that are on the plane by chance would have too much
// to say.
constexpr double kLeastShare = 0.5;

}  // namespace

struct DirectRefinement::Implementation {
  StereoRig rig;
  PairDisparities disparities;
  std::vector<DisparitySample> samples;  // of the disparities found, with true stddevs
  int agreeing = 0;                      // blocks that look alike and are on the plane

  Implementation(const RigModel& model, int margin) : rig(model.rig), disparities(model, margin) {}

  void takeSamples(const Eigen::Vector3d& g) {
    samples.clear();
    for (const BlockDisparity& disparity : disparities.found()) samples.push_back(disparity.sample);
    makeStddevsTrue(rig, g, disparities.haveCommonErrors() ? 1 : 0, samples);
  }

  // Blocks and not samples: a share of them must not depend on how many speak together.
  int blocksOn(const PlaneFit& fit) const {
    int blocks = 0;
    for (size_t i = 0; i < samples.size(); ++i)
      if (fit.agrees[i]) blocks += disparities.found()[i].blocks;
    return blocks;
  }

  // What an error of the rows' rotation does to the plane. 1/m per rad.
  Eigen::Matrix3d planeByRows(const PlaneFit& fit) const {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero(), right = Eigen::Matrix3d::Zero();
    for (size_t i = 0; i < samples.size(); ++i) {
      if (!fit.agrees[i]) continue;
      const Eigen::Vector3d by_plane = rig.fb() * rig.ray(samples[i].u, samples[i].v) / samples[i].stddev;
      information += by_plane * by_plane.transpose();
      right += by_plane * disparities.found()[i].leak / samples[i].stddev;
    }
    return information.inverse() * right;
  }

  Failure tooFew(int least) const {
    return {Reason::kTooFewMatches, std::to_string(disparities.found().size()) + " blocks match, at least " +
                                        std::to_string(least) + " needed"};
  }
  Failure tooFewOnThePlane() const {
    return {Reason::kNoPlane, std::to_string(agreeing) + " of " + std::to_string(disparities.informative()) +
                                  " blocks are on the plane: too few to tell which are ground"};
  }

  // Largest change of disparity at the bottom of the image, where disparities are largest.
  double change(const Eigen::Vector3d& before, const Eigen::Vector3d& after) const {
    const double bottom = rig.size.height - 1, right = rig.size.width - 1;
    const Eigen::Vector3d step = rig.fb() * (after - before);
    return std::max(std::abs(step.dot(rig.ray(0, bottom))), std::abs(step.dot(rig.ray(right, bottom))));
  }
};

DirectRefinement::DirectRefinement(const RigModel& model, int margin)
    : implementation_(std::make_unique<Implementation>(model, margin)) {}
DirectRefinement::~DirectRefinement() = default;
DirectRefinement::DirectRefinement(DirectRefinement&&) noexcept = default;

Expected<PlaneFit> DirectRefinement::refine(const cv::Mat& left, const cv::Mat& right,
                                            const Eigen::Vector3d& start, const PlaneLimits& limits,
                                            double bias_stddev, const RigRotation& rows) {
  Implementation& own = *implementation_;
  own.disparities.begin(left, right, start, rows);
  own.agreeing = 0;
  Eigen::Vector3d g = start;
  for (int step = 0;; ++step) {
    if (step > 0) own.disparities.measure(right, g, rows);
    if (static_cast<int>(own.disparities.found().size()) < limits.min_points)
      return tl::make_unexpected(own.tooFew(limits.min_points));
    own.takeSamples(g);
    if (step == 0) {
      for (DisparitySample& sample : own.samples)
        sample.stddev = std::sqrt(sample.stddev * sample.stddev + kStartStddev * kStartStddev);
    }
    Expected<PlaneFit> fit = refinePlane(own.rig, own.samples, g, limits, bias_stddev);
    own.agreeing = fit ? own.blocksOn(*fit) : 0;
    if (!fit) return fit;
    if (own.agreeing < kLeastShare * own.disparities.informative())
      return tl::make_unexpected(own.tooFewOnThePlane());
    const double change = own.change(g, fit->plane.g);
    if (step + 1 == kSteps || (step > 0 && change < kConverged)) {
      const Eigen::Matrix3d by_rows = own.planeByRows(*fit);
      fit->row_covariance = by_rows * rows.covariance * by_rows.transpose();
      fit->plane.covariance += fit->row_covariance;
      // What has not settled is known no better than it moves.
      if (change > kConverged) fit->plane.covariance(2, 2) += std::pow(change / own.rig.fb(), 2);
      return fit;
    }
    g = fit->plane.g;
  }
}

double DirectRefinement::agreement() const {
  constexpr int kFewest = 20;
  const Implementation& own = *implementation_;
  const int informative = own.disparities.informative();
  return informative < kFewest ? kUnknown : static_cast<double>(own.agreeing) / informative;
}

const std::vector<DisparitySample>& DirectRefinement::samples() const { return implementation_->samples; }

bool samePlane(const GroundPlane& a, const GroundPlane& b) {
  constexpr double kSigmas = 5.0;
  const Eigen::Vector3d difference = a.g - b.g;
  const Eigen::Matrix3d covariance = a.covariance + b.covariance;
  return difference.dot(covariance.ldlt().solve(difference)) < kSigmas * kSigmas;
}

}  // namespace uav_landing
