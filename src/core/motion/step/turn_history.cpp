#include "motion/step/turn_history.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "estimation/aircraft.h"
#include "geometry/rotation.h"

namespace uav_landing {
namespace {

constexpr double kKept = 0.9;  // share of the scatters that is left at the next step

// Derivatives of the polynomial through these values (Newton's divided differences).
RowMotion derivatives(const std::vector<double>& times, std::vector<Eigen::Vector3d> values, double at) {
  const size_t n = times.size();
  for (size_t order = 1; order < n; ++order)
    for (size_t i = n - 1; i >= order; --i)
      values[i] = (values[i] - values[i - 1]) / (times[i] - times[i - order]);
  Eigen::Vector3d value = values[n - 1];
  RowMotion rate;
  for (size_t i = n - 1; i-- > 0;) {
    rate.a = 2 * rate.w + (at - times[i]) * rate.a;
    rate.w = value + (at - times[i]) * rate.w;
    value = values[i] + (at - times[i]) * value;
  }
  return rate;
}

}  // namespace

bool TurnHistory::Scatter::isTelling() const {
  constexpr double kFewest = 3;
  return weight >= kFewest * kKept * kKept;
}

// The step itself is one more point than those of the stamps before.
int TurnHistory::mostDegree() const { return std::min(static_cast<int>(turned_.size()), kMostDegree); }

int TurnHistory::bestDegree() const {
  // A higher degree has to be far better. The rates carry the rows of the next step, so errors of the steps
  // come back by them, and the more so the higher the degree.
  constexpr double kFarBetter = 0.25;  // of the squares
  const int most = mostDegree();
  int best = std::min(most, 2);
  for (int degree = 1; degree <= most; ++degree)
    if (scatters_[degree].isTelling() && scatters_[best].isTelling() &&
        scatters_[degree].mean().trace() < (degree > best ? kFarBetter : 1) * scatters_[best].mean().trace())
      best = degree;
  return best;
}

StepEnds TurnHistory::turnBy(int degree, double duration, const Eigen::Vector3d& turn) const {
  const Turned& begin = turned_.back();
  std::vector<double> times = {begin.time + duration};
  std::vector<Eigen::Vector3d> values = {begin.sum + turn};
  for (auto past = turned_.rbegin(); static_cast<int>(times.size()) <= degree; ++past) {
    times.push_back(past->time);
    values.push_back(past->sum);
  }
  return {derivatives(times, values, begin.time), derivatives(times, values, times.front())};
}

StepEnds TurnHistory::ends(const CameraMotion& step, double duration, double height_then) const {
  StepEnds ends = turnBy(bestDegree(), duration, rotationVector(step.R));
  ends.now.v = step.t / duration;
  ends.then.v = step.R.transpose() * ends.now.v / height_then;
  return ends;
}

Eigen::Matrix3d TurnHistory::doubt(double duration) const {
  const Scatter& scatter = scatters_[bestDegree()];
  if (turned_.size() == 1) return Eigen::Matrix3d::Zero();
  constexpr double kUsual = aircraft::kTurnJerk / 2;
  return std::pow(duration, 4) *
         (weight_of_usual_ * kUsual * kUsual * Eigen::Matrix3d::Identity() + scatter.sum) /
         (weight_of_usual_ + scatter.weight);
}

void TurnHistory::add(const CameraMotion& step, double duration) {
  const Eigen::Vector3d turn = rotationVector(step.R);
  for (int degree = 1; degree <= mostDegree(); ++degree) {
    const StepEnds ends = turnBy(degree, duration, turn);
    if (degree < static_cast<int>(turned_.size())) {
      const Eigen::Vector3d off = (ends.then.w - rates_[degree]) / (duration * duration);
      Scatter& scatter = scatters_[degree];
      scatter.weight = kKept * scatter.weight + 1;
      scatter.sum = kKept * scatter.sum + off * off.transpose();
    }
    rates_[degree] = ends.now.w;
  }
  if (turned_.size() > 1) weight_of_usual_ *= kKept;
  turned_.push_back({turned_.back().time + duration, turned_.back().sum + turn});
  if (turned_.size() > kMostDegree + 1) turned_.pop_front();
}

}  // namespace uav_landing
