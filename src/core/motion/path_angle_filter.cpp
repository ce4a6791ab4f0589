#include "uav_landing/motion/path_angle_filter.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
// Standard deviations of the rate of the angle, rad/s: from a steady glide to one that tells nothing.
constexpr std::array<double, 6> kRates = {0.03 * kDegree, 0.3 * kDegree, 1 * kDegree,
                                          3 * kDegree,    10 * kDegree,  30 * kDegree};
constexpr double kCorrelationTime = 1.0;       // s, of the rate
constexpr double kStartStddev = 45 * kDegree;  // of the angle before anything is known
constexpr double kMemory = 2.0;          // s, after which a measurement hardly speaks for a model any more
constexpr double kStampRounding = 1e-3;  // s
constexpr size_t kMostSteps = 50;        // however short they are: the time taken grows with their cube

// The angles of all steps under one model: prior covariance of the process.
Eigen::MatrixXd pathCovariance(const std::vector<double>& middles, double rate_stddev) {
  const int n = static_cast<int>(middles.size());
  // angle_i = start + sum over the gaps before i of rate x gap.
  Eigen::MatrixXd rates(n, n), integral = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      rates(i, j) =
          rate_stddev * rate_stddev * std::exp(-std::abs(middles[i] - middles[j]) / kCorrelationTime);
      if (j < i) integral(i, j) = middles[j + 1] - middles[j];
    }
  }
  return integral * rates * integral.transpose() +
         Eigen::MatrixXd::Constant(n, n, kStartStddev * kStartStddev);
}

struct Posterior {
  double log_evidence = 0, mean = 0, variance = 0;
};

// Gaussian posterior of the last angle given measurements y = H angles + noise.
Posterior condition(const Eigen::MatrixXd& prior, const Eigen::MatrixXd& H, const Eigen::VectorXd& y,
                    const Eigen::VectorXd& noise) {
  Posterior posterior;
  const int last = static_cast<int>(prior.rows()) - 1;
  posterior.variance = prior(last, last);
  if (y.size() == 0) return posterior;
  Eigen::MatrixXd S = H * prior * H.transpose();
  S.diagonal() += noise;
  const Eigen::LLT<Eigen::MatrixXd> llt(S);
  const Eigen::VectorXd gain = llt.solve(H * prior.col(last));
  posterior.mean = gain.dot(y);
  posterior.variance -= gain.dot(H * prior.col(last));
  const Eigen::MatrixXd L = llt.matrixL();
  posterior.log_evidence = -0.5 * y.dot(llt.solve(y)) - L.diagonal().array().log().sum();
  return posterior;
}

}  // namespace

void PathAngleFilter::reset() {
  steps_.clear();
  log_weights_.fill(0);
}

PathAngleFilter::Estimate PathAngleFilter::update(double stamp, const Measurement& step,
                                                  const Measurement& chord) {
  steps_.push_back({stamp, step});
  while ((stamp - (steps_.front().stamp - steps_.front().measurement.duration) > window_ + kStampRounding ||
          steps_.size() > kMostSteps) &&
         steps_.size() > 1) {
    steps_.pop_front();
  }
  const int n = static_cast<int>(steps_.size());
  std::vector<double> middles;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n + 1, n);
  Eigen::VectorXd y(n + 1), noise(n + 1);
  double covered = 0;
  for (int i = 0; i < n; ++i) {
    const Step& past = steps_[i];
    middles.push_back(past.stamp - 0.5 * past.measurement.duration);
    H(i, i) = 1;
    y[i] = past.measurement.angle;
    noise[i] = past.measurement.variance;
    if (past.stamp > stamp - chord.duration + kStampRounding) covered += past.measurement.duration;
  }
  for (int i = 0; i < n; ++i) {
    if (steps_[i].stamp > stamp - chord.duration + kStampRounding) {
      H(n, i) = steps_[i].measurement.duration / covered;
    }
  }
  y[n] = chord.angle;
  noise[n] = chord.variance;
  // A chord that is the step itself, or spans steps that are not known, is no measurement of its own.
  const bool has_chord = chord.duration > step.duration + kStampRounding &&
                         std::abs(covered - chord.duration) < 0.5 * step.duration;
  const int rows = has_chord ? n + 1 : n;

  // Angles relative to the newest, so that the wide prior of the start does not cost digits.
  const double reference = has_chord ? chord.angle : step.angle;
  y.array() -= reference;

  const double forget = std::exp(-step.duration / kMemory);
  std::array<Posterior, kModels> posteriors;
  double largest = -1e300;
  for (int m = 0; m < kModels; ++m) {
    const Eigen::MatrixXd prior = pathCovariance(middles, kRates[m]);
    posteriors[m] = condition(prior, H.topRows(rows), y.head(rows), noise.head(rows));
    const double before = condition(prior, H.topRows(n - 1), y.head(n - 1), noise.head(n - 1)).log_evidence;
    log_weights_[m] = forget * log_weights_[m] + posteriors[m].log_evidence - before;
    largest = std::max(largest, log_weights_[m]);
  }
  Estimate estimate;
  double total = 0, mean = 0, square = 0, heaviest = 0;
  for (int m = 0; m < kModels; ++m) {
    log_weights_[m] -= largest;
    const double weight = std::exp(log_weights_[m]);
    total += weight;
    mean += weight * posteriors[m].mean;
    square += weight * (posteriors[m].variance + posteriors[m].mean * posteriors[m].mean);
    if (weight > heaviest) {
      heaviest = weight;
      estimate.rate_stddev = kRates[m];
    }
  }
  mean /= total;
  estimate.angle = reference + mean;
  estimate.variance = square / total - mean * mean;
  return estimate;
}

}  // namespace uav_landing
