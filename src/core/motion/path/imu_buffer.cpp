#include "uav_landing/motion/imu_buffer.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "base/text.h"
#include "geometry/rotation.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kSpan = 60;     // s kept, as images may wait that long to be processed
constexpr size_t kMost = 60000;  // largest number of samples kept
constexpr double kLate = 1.0;    // s, largest delay of a message
constexpr double kSameStamp = 1e-7;
constexpr double kRecent = 0.05;            // s
constexpr double kLongestForRows = 5.5e-3;  // s between messages: 200 Hz, whose stamps scatter

Eigen::Quaterniond exponential(const Eigen::Vector3d& w) { return Eigen::Quaterniond(rotationMatrix(w)); }

bool earlier(const ImuSample& sample, double t) { return sample.stamp < t; }

/// Interpolates between two values. Returns nothing when one of them is missing.
template <class Value>
std::optional<Value> between(const std::optional<Value>& a, const std::optional<Value>& b, double share) {
  if (!a || !b) return std::nullopt;
  return Value((1 - share) * *a + share * *b);
}

}  // namespace

void ImuBuffer::add(const ImuSample& sample) {
  if (!samples_.empty() && sample.stamp < samples_.back().stamp - kLate) clear();
  const auto place = std::lower_bound(samples_.begin(), samples_.end(), sample.stamp - kSameStamp, earlier);
  if (place != samples_.end() && place->stamp <= sample.stamp + kSameStamp) return;
  samples_.insert(place, sample);
  while (samples_.size() > kMost || samples_.front().stamp < samples_.back().stamp - kSpan)
    samples_.pop_front();
}

bool ImuBuffer::covers(double stamp) const {
  if (samples_.empty()) return false;
  const double newest = samples_.back().stamp;
  const bool tells_rows = !rows_.atOnce() && longestGap(newest - kRecent, newest) <= kLongestForRows;
  return newest >= stamp + parameters_.imu_delay + (tells_rows ? rows_.last : 0) - kSameStamp;
}

double ImuBuffer::longestGap(double from, double to) const {
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), from + kSameStamp, earlier);
  if (after == samples_.begin()) return kSpan;
  double longest = 0;
  for (auto sample = std::prev(after);; ++sample) {
    if (sample->stamp >= to - kSameStamp) return longest;
    if (std::next(sample) == samples_.end() || !sample->angular_velocity) return kSpan;
    longest = std::max(longest, std::next(sample)->stamp - sample->stamp);
  }
}

// The cubic through the two messages on either side; a cubic follows vibration that a line would cut short.
Eigen::Vector3d ImuBuffer::rateAt(double t) const {
  constexpr std::ptrdiff_t kEachSide = 2;
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), t, earlier);
  const auto first = after - std::min(kEachSide, std::distance(samples_.begin(), after));
  const auto end = after + std::min(kEachSide, std::distance(after, samples_.end()));
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  for (auto i = first; i != end; ++i) {
    double weight = 1;
    for (auto j = first; j != end; ++j)
      if (j != i) weight *= (t - j->stamp) / (i->stamp - j->stamp);
    rate += weight * *i->angular_velocity;
  }
  return rate;
}

void ImuBuffer::addRows(double stamp, const Eigen::Matrix3d& camera_from_imu, AttitudePrior& prior) const {
  if (rows_.atOnce()) return;
  const double t = stamp + parameters_.imu_delay, first = t + rows_.first, last = t + rows_.last;
  const double gap = longestGap(first, std::min(last, samples_.back().stamp));
  if (gap > kLongestForRows) {
    prior.rows_failure = {Reason::kTimeout, text("the imu's messages are up to ", 1e3 * gap,
                                                 " ms apart while rows are exposed: 200 Hz are needed")};
    return;
  }
  if (samples_.back().stamp < last - kSameStamp) {
    prior.rows_failure = {Reason::kTimeout,
                          text("the newest imu message is ", 1e3 * (last - samples_.back().stamp),
                               " ms before the last row: it comes too late")};
    return;
  }
  std::vector<Eigen::Vector3d> rates;
  for (double at = first; at <= last + RowTurns::kInterval; at += RowTurns::kInterval)
    rates.push_back(-(camera_from_imu * rateAt(std::min(at, samples_.back().stamp))));
  const auto sample = std::lower_bound(samples_.begin(), samples_.end(), t, earlier);
  const double bias = parameters_.imu_rate_bias_deg * kDegree;
  const Eigen::Matrix3d of_one = rateCovariance(sample == samples_.end() ? samples_.back() : *sample) -
                                 bias * bias * Eigen::Matrix3d::Identity();
  const double messages = std::max(1.0, (last - first) / std::max(gap, kSameStamp));
  prior.rows = std::make_shared<const RowTurns>(
      rows_.first, std::move(rates),
      Eigen::Matrix3d(camera_from_imu * of_one * camera_from_imu.transpose() / messages));
}

Eigen::Matrix3d ImuBuffer::attitudeCovariance(const ImuSample& sample) const {
  const double stddev = parameters_.imu_attitude_stddev_deg * kDegree;
  return sample.orientation_covariance.value_or(stddev * stddev * Eigen::Matrix3d::Identity());
}

Eigen::Matrix3d ImuBuffer::rateCovariance(const ImuSample& sample) const {
  const double stddev = parameters_.imu_rate_stddev_deg * kDegree;
  const double bias = parameters_.imu_rate_bias_deg * kDegree;
  return sample.angular_velocity_covariance.value_or(stddev * stddev * Eigen::Matrix3d::Identity()) +
         bias * bias * Eigen::Matrix3d::Identity();
}

std::optional<ImuSample> ImuBuffer::interpolate(double t) const {
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), t - kSameStamp, earlier);
  if (after != samples_.end() && after->stamp <= t + kSameStamp) return *after;
  if (after == samples_.begin()) return std::nullopt;
  const ImuSample& a = *std::prev(after);
  ImuSample sample;
  sample.stamp = t;
  if (after == samples_.end()) {
    const double ahead = t - a.stamp;
    if (ahead > parameters_.imu_max_gap || !a.angular_velocity) return std::nullopt;
    sample.angular_velocity = a.angular_velocity;
    sample.angular_velocity_covariance = a.angular_velocity_covariance;
    if (!a.orientation) return sample;
    sample.orientation = *a.orientation * exponential(ahead * *a.angular_velocity);
    sample.orientation_covariance = attitudeCovariance(a) + ahead * ahead * rateCovariance(a);
    return sample;
  }
  const ImuSample& b = *after;
  if (b.stamp - a.stamp > parameters_.imu_max_gap) return std::nullopt;
  const double share = (t - a.stamp) / (b.stamp - a.stamp);
  if (a.orientation && b.orientation) sample.orientation = a.orientation->slerp(share, *b.orientation);
  sample.orientation_covariance = between(a.orientation_covariance, b.orientation_covariance, share);
  sample.angular_velocity = between(a.angular_velocity, b.angular_velocity, share);
  sample.angular_velocity_covariance =
      between(a.angular_velocity_covariance, b.angular_velocity_covariance, share);
  return sample;
}

Failure ImuBuffer::missing(double t) const {
  if (samples_.empty()) return {Reason::kNotYet, "no imu message"};
  if (samples_.back().stamp < t)
    return {Reason::kTimeout,
            text("the newest imu message is ", t - samples_.back().stamp, " s before the image")};
  if (samples_.front().stamp > t)
    return {Reason::kNotYet,
            text("the oldest imu message is ", samples_.front().stamp - t, " s after the image")};
  return {Reason::kTimeout, text("no imu message within ", parameters_.imu_max_gap, " s around the image")};
}

// Rotation of the sensor: product of the small rotations from sample to sample.
std::optional<Eigen::Quaterniond> ImuBuffer::integrate(const ImuSample& from, const ImuSample& to) const {
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  const ImuSample* last = &from;
  const auto step = [&](const ImuSample& next) {
    const double T = next.stamp - last->stamp;
    if (T > parameters_.imu_max_gap || !last->angular_velocity || !next.angular_velocity) return false;
    turn = turn * exponential(0.5 * T * (*last->angular_velocity + *next.angular_velocity));
    last = &next;
    return true;
  };
  const auto first = std::lower_bound(samples_.begin(), samples_.end(), from.stamp + kSameStamp, earlier);
  const auto end = std::lower_bound(first, samples_.end(), to.stamp - kSameStamp, earlier);
  for (auto sample = first; sample != end; ++sample)
    if (!step(*sample)) return std::nullopt;
  if (!step(to)) return std::nullopt;
  return turn;
}

AttitudePrior ImuBuffer::at(double stamp, std::optional<double> before,
                            const Eigen::Matrix3d& camera_from_imu) const {
  AttitudePrior prior;
  const std::optional<ImuSample> now = interpolate(stamp + parameters_.imu_delay);
  if (!now) {
    prior.failure = missing(stamp + parameters_.imu_delay);
    return prior;
  }
  if (now->orientation) {
    prior.failure = {};
    prior.normal = camera_from_imu * (now->orientation->conjugate() * Eigen::Vector3d(0, 0, -1));
    const Eigen::Matrix3d by_turn = crossMatrix(prior.normal) * camera_from_imu;
    prior.normal_covariance = by_turn * attitudeCovariance(*now) * by_turn.transpose();
  } else {
    prior.failure = {Reason::kInputInvalid, "the imu messages have no orientation"};
  }
  addRows(stamp, camera_from_imu, prior);
  if (!before || !(*before < stamp)) return prior;
  const std::optional<ImuSample> then = interpolate(*before + parameters_.imu_delay);
  if (!then) return prior;
  std::optional<Eigen::Quaterniond> turn = integrate(*then, *now);
  if (!turn && now->orientation && then->orientation)
    turn = then->orientation->conjugate() * *now->orientation;
  if (!turn) return prior;
  prior.duration = stamp - *before;
  // The prior is the rotation of the scene in the camera, which is opposite to that of the sensor.
  prior.rotation = camera_from_imu * rotationVector(turn->conjugate().toRotationMatrix());
  prior.rotation_covariance =
      prior.duration * prior.duration * camera_from_imu * rateCovariance(*now) * camera_from_imu.transpose();
  return prior;
}

}  // namespace uav_landing
