#include "motion/path/path_angle_filter.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "motion/path/image_errors.h"

namespace uav_landing {
namespace {

// Factor on the variance of a chord. It shares the noise of its two images with the first and the last step,
// so it contains less new information than an independent measurement.
constexpr double kChordShared = 2;
constexpr double kDegree = M_PI / 180;
// Standard deviations of the rate of the angle, rad/s. They range from a steady glide to a rate that leaves
// the angle open.
constexpr std::array<double, 6> kRates = {0.03 * kDegree, 0.3 * kDegree, 1 * kDegree,
                                          3 * kDegree,    10 * kDegree,  30 * kDegree};
// Standard deviations of the errors that vibration makes in images, rad s. At 20 Hz, steps are off by a
// twentieth of a degree to more than any valid angle.
constexpr std::array<double, 7> kShakes = {0.002 * kDegree, 0.005 * kDegree, 0.0125 * kDegree, 0.03 * kDegree,
                                           0.08 * kDegree,  0.2 * kDegree,   0.5 * kDegree};
constexpr double kCorrelationTime = 1.0;       // s, of the rate
constexpr double kStartStddev = 45 * kDegree;  // of the angle before any measurement
constexpr double kMemory = 2.0;  // s, after which a measurement has little weight in the choice of the model
// Vibration has to be within 3 Hz of a multiple of the frame rate for similar errors. Gusts look like them.
constexpr double kSimilarPrior = -3;
// Logarithm of the least weight, beside the largest, that any model keeps with a rolling shutter. So after
// one bad image the models without vibration come back soon.
constexpr double kLeastWeight = -15;
constexpr double kStampRounding = 1e-3;  // s
constexpr size_t kMostSteps = 50;  // however short they are, as the computing time grows with the third power

// Covariance of the angles of all steps relative to the first one, for a rate with a standard deviation of 1
// rad/s.
Eigen::MatrixXd unitCovariance(const std::vector<double>& middles) {
  const int n = static_cast<int>(middles.size());
  Eigen::MatrixXd rates(n, n), integral = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      rates(i, j) = std::exp(-std::abs(middles[i] - middles[j]) / kCorrelationTime);
      // angle_i = start + sum of rate x gap over the gaps before i.
      if (j < i) integral(i, j) = middles[j + 1] - middles[j];
    }
  }
  return integral * rates * integral.transpose();
}

struct Posterior {
  double log_evidence = 0;  // of the newest measurements, given the earlier ones
  double mean = 0, variance = 0;
  double by_readout = 0;  // effect on the mean
};

// 1 sigma of what a model has.
struct Model {
  double rate;            // rad/s
  double single_images;   // errors of images, each with one of its own, rad s
  double similar_images;  // the same, and similar in images that follow each other
  double log_prior;       // logarithm of its weight beforehand, beside the others
};

// All rates in turn for each kind of vibration. The first ones are those for a global shutter.
std::vector<Model> allModels() {
  std::vector<Model> models;
  for (const double rate : kRates) models.push_back({rate, 0, 0, 0});
  for (const double shake : kShakes) {
    for (const double rate : kRates) models.push_back({rate, shake, 0, 0});
    for (const double rate : kRates) models.push_back({rate, 0, shake, kSimilarPrior});
  }
  return models;
}

const std::vector<Model>& models() {
  static const std::vector<Model> all = allModels();
  return all;
}

// Mean and variance of the mixture of posteriors. rate_stddev: the one with the largest weight.
PathAngleFilter::Estimate mixture(const std::vector<Posterior>& posteriors,
                                  const std::vector<double>& log_weights) {
  PathAngleFilter::Estimate estimate;
  double total = 0, mean = 0, square = 0, by_readout = 0;
  std::array<double, kRates.size()> of_rates{};
  for (size_t m = 0; m < posteriors.size(); ++m) {
    const double weight = std::exp(log_weights[m] + models()[m].log_prior);
    total += weight;
    mean += weight * posteriors[m].mean;
    by_readout += weight * posteriors[m].by_readout;
    square += weight * (posteriors[m].variance + posteriors[m].mean * posteriors[m].mean);
    of_rates[m % kRates.size()] += weight;
  }
  estimate.rate_stddev = kRates[std::max_element(of_rates.begin(), of_rates.end()) - of_rates.begin()];
  mean /= total;
  estimate.angle = mean;
  estimate.variance = square / total - mean * mean;
  if (by_readout != 0) estimate.variance += std::pow(by_readout / total, 2);
  return estimate;
}

}  // namespace

// Measurement equations y = H angles + noise for the angles of all steps. Each step has a row; the chord has
// the last one.
struct PathAngleFilter::Equations {
  std::vector<double> middles;  // stamps of the middles of the steps, s
  Eigen::MatrixXd H;
  Eigen::VectorXd y;
  Eigen::MatrixXd noise;
  Eigen::VectorXd by_readout;  // one error, common to all rows
  ImageErrors images;          // those of the rows, with a rolling shutter
  double reference = 0;        // subtracted from y, rad
  bool has_chord = false;      // whether the chord is a measurement of its own
};

// The equations that are measurements, prepared for all models.
class PathAngleFilter::Regression {
 public:
  Regression(const Equations& all, bool rolling)
      : rows_(all.y.size() - (all.has_chord ? 0 : 1)),
        y_(all.y.head(rows_)),
        by_readout_(all.by_readout.head(rows_)),
        noise_(all.noise.topLeftCorner(rows_, rows_)) {
    const auto H = all.H.topRows(rows_);
    const Eigen::MatrixXd unit = unitCovariance(all.middles);
    variance_of_last_ = unit(unit.rows() - 1, unit.cols() - 1);
    with_last_ = H * unit.col(unit.cols() - 1);
    of_rate_ = H * unit * H.transpose();
    if (rolling) {
      const ImageErrors::Covariances of_images = all.images.covariances();
      of_single_images_ = of_images.single.topLeftCorner(rows_, rows_);
      of_similar_images_ = of_images.similar.topLeftCorner(rows_, rows_);
    }
    by_start_ = H.rowwise().sum();
    noise_ += kStartStddev * kStartStddev * by_start_ * by_start_.transpose();
  }

  // Gaussian posterior of the last angle under one model. earlier: number of measurements that are not new.
  Posterior condition(const Model& model, Eigen::Index earlier) const {
    constexpr double kStart = kStartStddev * kStartStddev;
    const double rate = model.rate * model.rate;
    Eigen::MatrixXd covariance = rate * of_rate_ + noise_;
    if (model.single_images > 0) covariance += model.single_images * model.single_images * of_single_images_;
    if (model.similar_images > 0)
      covariance += model.similar_images * model.similar_images * of_similar_images_;
    const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
    Eigen::MatrixXd solved(rows_, 2);  // the measurements, and their covariance with the last angle
    solved << y_, rate * with_last_ + kStart * by_start_;
    llt.matrixL().solveInPlace(solved);
    Posterior posterior;
    posterior.mean = solved.col(1).dot(solved.col(0));
    posterior.variance = rate * variance_of_last_ + kStart - solved.col(1).squaredNorm();
    // Effect on the mean. It differs so little between the measurements that they cannot determine the error
    // itself.
    if (!by_readout_.isZero(0)) posterior.by_readout = solved.col(1).dot(llt.matrixL().solve(by_readout_));
    // The Cholesky factor of the covariance of all measurements begins with that of the earlier ones. So the
    // evidence of the new ones stands at its end.
    const Eigen::Index newest = rows_ - earlier;
    posterior.log_evidence = -0.5 * solved.col(0).tail(newest).squaredNorm() -
                             llt.matrixLLT().diagonal().tail(newest).array().log().sum();
    return posterior;
  }

 private:
  Eigen::Index rows_;
  Eigen::VectorXd y_, by_readout_;
  Eigen::MatrixXd noise_;  // with the uncertainty of the start
  // For a rate of 1 rad/s: variance of the last angle, covariances of the measurements with it, and
  // covariance of the measurements.
  double variance_of_last_;
  Eigen::VectorXd with_last_;
  Eigen::MatrixXd of_rate_;
  Eigen::MatrixXd of_single_images_, of_similar_images_;  // the same for errors of images, see ImageErrors
  Eigen::VectorXd by_start_;  // derivatives of the measurements by the angle at the start
};

void PathAngleFilter::reset() {
  steps_.clear();
  shortest_ = kNone;
  log_weights_.clear();
}

void PathAngleFilter::add(double stamp, const Measurement& step) {
  steps_.push_back({stamp, step});
  const auto isOld = [&](const Step& past) {
    return stamp - (past.stamp - past.measurement.duration) > window_ + kStampRounding;
  };
  while (steps_.size() > 1 && (isOld(steps_.front()) || steps_.size() > kMostSteps)) steps_.pop_front();
}

PathAngleFilter::Equations PathAngleFilter::equations(const Measurement& chord) const {
  const int n = static_cast<int>(steps_.size());
  const Measurement& step = steps_.back().measurement;
  const double begin = steps_.back().stamp - chord.duration + kStampRounding;
  Equations all;
  all.H = Eigen::MatrixXd::Zero(n + 1, n);
  all.y.resize(n + 1);
  all.noise.resize(n + 1, n + 1);
  Eigen::VectorXd variance(n + 1), by_normal(n + 1);
  all.by_readout.resize(n + 1);
  double covered = 0;
  for (int i = 0; i < n; ++i) {
    const Step& past = steps_[i];
    all.middles.push_back(past.stamp - 0.5 * past.measurement.duration);
    all.H(i, i) = 1;
    all.y[i] = past.measurement.angle;
    variance[i] = past.measurement.variance;
    by_normal[i] = past.measurement.by_normal;
    all.by_readout[i] = past.measurement.by_readout;
    if (past.stamp > begin) covered += past.measurement.duration;
  }
  for (int i = 0; i < n; ++i)
    if (steps_[i].stamp > begin) all.H(n, i) = steps_[i].measurement.duration / covered;
  all.y[n] = chord.angle;
  variance[n] = kChordShared * chord.variance;
  by_normal[n] = chord.by_normal;
  all.by_readout[n] = chord.by_readout;
  // Nobody knows how much the errors of the pairs' normals have in common. They are taken to share as much as
  // the smaller one has. So differences of two measurements cannot reduce the error of the normal.
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) all.noise(i, j) = std::pow(std::min(by_normal[i], by_normal[j]), 2);
  all.noise.diagonal() += variance;
  if (step.rolling) {
    for (const Step& past : steps_) all.images.add(past.stamp - past.measurement.duration, past.stamp);
    all.images.add(steps_.back().stamp - chord.duration, steps_.back().stamp);
  }
  // A chord is no additional measurement when it is the step itself, or when some of its steps are missing.
  all.has_chord = chord.duration > step.duration + kStampRounding &&
                  std::abs(covered - chord.duration) < 0.5 * step.duration;
  // Angles are relative to the newest one, so that the wide prior of the start does not cost digits.
  all.reference = all.has_chord ? chord.angle : step.angle;
  all.y.array() -= all.reference;
  return all;
}

PathAngleFilter::Estimate PathAngleFilter::update(double stamp, const Measurement& step,
                                                  const Measurement& chord) {
  add(stamp, step);
  const Equations all = equations(chord);
  const Regression regression(all, step.rolling);
  const auto steps = static_cast<Eigen::Index>(steps_.size());
  const double forget = std::exp(-step.duration / kMemory);
  std::vector<Posterior> posteriors(step.rolling ? models().size() : kRates.size());
  log_weights_.resize(posteriors.size());
  for (size_t m = 0; m < posteriors.size(); ++m) {
    posteriors[m] = regression.condition(models()[m], steps - 1);
    log_weights_[m] = forget * log_weights_[m] + posteriors[m].log_evidence;
  }
  const double largest = *std::max_element(log_weights_.begin(), log_weights_.end());
  for (double& weight : log_weights_) weight -= largest;
  Estimate estimate = mixture(posteriors, log_weights_);
  if (step.rolling)
    for (double& weight : log_weights_) weight = std::max(weight, kLeastWeight);
  estimate.angle += all.reference;
  // The estimate is the angle at the middle of the step. After a gap that is longer ago than usual.
  shortest_ = std::min(shortest_, step.duration);
  estimate.variance += std::pow(estimate.rate_stddev * 0.5 * (step.duration - shortest_), 2);
  return estimate;
}

}  // namespace uav_landing
