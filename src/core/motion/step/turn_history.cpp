#include "motion/step/turn_history.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/steadiness.h"
#include "estimation/aircraft.h"
#include "geometry/rotation.h"

namespace uav_landing {
namespace {

constexpr double kKept = 0.9;  // share of the scatters that is left at the next step

// First and second derivative at `at` of the polynomial through these values, a row of `values` for each
// time.
RowMotion derivatives(const Eigen::VectorXd& times, const Eigen::MatrixX3d& values, double at) {
  const Eigen::Index n = times.size();
  Eigen::MatrixXd powers = Eigen::MatrixXd::Ones(n, n);
  for (Eigen::Index k = 1; k < n; ++k) powers.col(k) = powers.col(k - 1).cwiseProduct(times);
  const Eigen::MatrixX3d coefficients = powers.partialPivLu().solve(values);
  RowMotion rate;
  for (Eigen::Index k = 1; k < n; ++k) rate.w += k * std::pow(at, k - 1) * coefficients.row(k).transpose();
  for (Eigen::Index k = 2; k < n; ++k)
    rate.a += k * (k - 1) * std::pow(at, k - 2) * coefficients.row(k).transpose();
  return rate;
}

bool alike(double a, double b) { return std::max(a, b) < Steadiness::kLongestRegular * std::min(a, b); }

}  // namespace

void TurnHistory::Scatter::add(const Eigen::Vector3d& error) {
  ++count;
  weight = kKept * weight + 1;
  sum = kKept * sum + error * error.transpose();
}

void TurnHistory::interrupt() { turned_ = {{0, Eigen::Vector3d::Zero()}}; }

double TurnHistory::lastDuration() const {
  return turned_.size() < 2 ? 0 : turned_.back().time - turned_[turned_.size() - 2].time;
}

// Error of degree 2, at the end of the step against its beginning, when the acceleration changes evenly.
double TurnHistory::errorByJerk(double duration) const {
  return duration * (duration + 2 * lastDuration()) / 6;
}

int TurnHistory::bestDegree() const {
  // The rates carry the rows of the next step, so errors of the steps come back by them. The higher the
  // degree, the larger they are then. So it has to be far better.
  constexpr double kFarBetter = 0.25;  // of the squares
  const int most = std::min(static_cast<int>(turned_.size()), kMostDegree);
  if (most < kMostDegree) return most;
  const Scatter &lower = scatters_[kMostDegree - 1], &higher = scatters_[kMostDegree];
  const bool better =
      lower.isTelling() && higher.isTelling() && higher.mean().trace() < kFarBetter * lower.mean().trace();
  return better ? kMostDegree : kMostDegree - 1;
}

// The step itself is one more point than those of the stamps before. Times are since its beginning.
StepEnds TurnHistory::turnBy(int degree, double duration, const Eigen::Vector3d& turn) const {
  Eigen::VectorXd times(degree + 1);
  Eigen::MatrixX3d sums(degree + 1, 3);
  times[0] = duration;
  sums.row(0) = turn;
  const Turned& begin = turned_.back();
  for (int i = 1; i <= degree; ++i) {
    const Turned& past = turned_[turned_.size() - i];
    times[i] = past.time - begin.time;
    sums.row(i) = past.sum - begin.sum;
  }
  return {derivatives(times, sums, 0), derivatives(times, sums, duration)};
}

StepEnds TurnHistory::ends(const CameraMotion& step, double duration, double height_then) const {
  StepEnds ends = turnBy(bestDegree(), duration, rotationVector(step.R));
  ends.now.v = step.t / duration;
  ends.then.v = step.R.transpose() * ends.now.v / height_then;
  return ends;
}

Eigen::Matrix3d TurnHistory::doubt(double duration) const {
  const int degree = bestDegree();
  const Scatter& scatter = scatters_[degree];
  if (degree == 1) {
    if (!scatter.isTelling()) return Eigen::Matrix3d::Zero();
    return duration * duration * scatter.mean();
  }
  constexpr double kUsual = aircraft::kTurnJerk * aircraft::kTurnJerk;
  // By the degree: noise of the steps is in the end minus the beginning more than in what the scatter sees.
  // The variances' ratio follows from the coefficients for even steps.
  constexpr std::array<double, kMostDegree + 1> kByNoise = {1, 1, 4.0 / 3, 2.9};
  const double by_jerk = errorByJerk(std::max(duration, lastDuration()));
  return by_jerk * by_jerk *
         (weight_of_usual_ * kUsual * Eigen::Matrix3d::Identity() + kByNoise[degree] * scatter.sum) /
         (weight_of_usual_ + scatter.weight);
}

void TurnHistory::add(const CameraMotion& step, double duration) {
  const Eigen::Vector3d turn = rotationVector(step.R);
  const int known = static_cast<int>(turned_.size());
  // Errors after an unusual step are unusual, too.
  const bool tells = known > 1 && alike(duration, lastDuration());
  for (int degree = 1; degree <= std::min(known, kMostDegree); ++degree) {
    const StepEnds ends = turnBy(degree, duration, turn);
    if (tells && degree < known) {
      const Eigen::Vector3d error = ends.then.w - rates_[degree];
      scatters_[degree].add(error / (degree == 1 ? duration : errorByJerk(duration)));
    }
    rates_[degree] = ends.now.w;
  }
  if (tells) weight_of_usual_ *= kKept;
  turned_.push_back({turned_.back().time + duration, turned_.back().sum + turn});
  if (turned_.size() > kMostDegree + 1) turned_.pop_front();
}

}  // namespace uav_landing
