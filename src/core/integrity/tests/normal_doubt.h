#pragma once

#include <Eigen/Core>
#include <deque>

namespace uav_landing {

/// Probability that the stereo plane's normal is wrong, by a witness that contradicts it. The witness is the
/// vanishing point, or the normal that fits the motion in the image. Far below the limit of a test a
/// contradiction is no proof. But it says more than the two variances: there is a prior probability of a
/// fault that no variance contains.
class NormalDoubt {
 public:
  /// fault_probability: prior, per pair. memory: s, after which pairs do not count any more.
  NormalDoubt(double fault_probability, double memory)
      : fault_probability_(fault_probability), memory_(memory) {}

  /// Adds a pair with a witness. stamp: s. ratio: squared normalised contradiction. turn: rotation from the
  /// normal in use to that of the witness. variance: of the turn, rad^2. turned: the plane has turned against
  /// the pairs before, so those say nothing about it.
  void add(double stamp, double ratio, const Eigen::Vector3d& turn, double variance, bool turned);
  /// Posterior probability of a fault of any size: the median of the last three pairs, or the smaller one of
  /// two. A witness that is wrong or says nothing comes and goes, but a wrong plane stays. A pair without a
  /// witness gets the median of three earlier ones.
  double probability(double stamp) const;
  const Eigen::Vector3d& turn() const { return turn_; }
  double variance() const { return variance_; }

 private:
  double fault_probability_, memory_;
  std::deque<double> probabilities_;  // of the last three pairs at most
  double stamp_ = 0;                  // s, of the last pair
  Eigen::Vector3d turn_ = Eigen::Vector3d::Zero();
  double variance_ = 0;
};

}  // namespace uav_landing
