#pragma once

namespace uav_landing {

/// What a block of the left image, or several together, tells of the shift to the right one: sums over
/// pixels, squares of grey levels unless they say otherwise.
struct ShiftEvidence {
  int blocks = 0;
  double score = 0;                   ///< slope times right image: the shift times its response
  double score_variance = 0;          ///< of the score, if the residuals of the pixels are independent
  double energy = 0;                  ///< slope^2, noise included
  double signal = 0;                  ///< what a shift by a pixel does to the score as far as it is measured
  double signal_variance = 0;         ///< of that measurement
  double usual = 0;                   ///< the signal that is usual for as many blocks
  double moment_u = 0, moment_v = 0;  ///< energy times its place, pixels
  double down = 0;                    ///< what a shift by a row does to the score

  void add(const ShiftEvidence& other);
  /// Whether the signal is beyond doubt: its ratio to anything is then as good as normal.
  bool isCertain() const;
  /// The signal that was there: the mean by Bayes' rule.
  double likelySignal() const;
};

}  // namespace uav_landing
