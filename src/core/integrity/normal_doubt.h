#pragma once

#include <Eigen/Core>
#include <deque>

namespace uav_landing {

/// How likely the ground's normal is another than that of the stereo plane, by a witness that contradicts it:
/// the vanishing point, or the normal that the motion in the image asks for. Far below the limit of a test a
/// contradiction is no proof, but says more than the variances of both: that one of them is wrong in a way
/// that no variance knows has a prior probability, too.
class NormalDoubt {
 public:
  /// fault_probability: prior, per pair. memory: s, after which pairs count for nothing.
  NormalDoubt(double fault_probability, double memory)
      : fault_probability_(fault_probability), memory_(memory) {}

  /// A pair that has the witness. stamp: s. ratio: squared normalised contradiction. turn: from the normal in
  /// use to the one that the witness asks for; variance: of that, rad^2. turned: the plane has turned against
  /// the pairs before, so that they say nothing of it.
  void add(double stamp, double ratio, const Eigen::Vector3d& turn, double variance, bool turned);
  /// Posterior probability of a fault, of whatever size: the median of the last three pairs (the lesser of
  /// two), as a witness that is wrong, or that says nothing, comes and goes, and a wrong plane does not. On a
  /// pair without one, what three have said.
  double probability(double stamp) const;
  const Eigen::Vector3d& turn() const { return turn_; }
  double variance() const { return variance_; }

 private:
  double fault_probability_, memory_;
  std::deque<double> probabilities_;  // of the last pairs, three at most
  double stamp_ = 0;                  // s, of the last one
  Eigen::Vector3d turn_ = Eigen::Vector3d::Zero();
  double variance_ = 0;
};

}  // namespace uav_landing
