#pragma once

namespace uav_landing {

/// What blocks of the left image, one or several, tell of the shift to the right one. Values are sums over
/// pixels, in squares of grey levels if not stated otherwise.
struct ShiftEvidence {
  int blocks = 0;
  double score = 0;                   ///< slope times right image: the shift times its response
  double score_variance = 0;          ///< of the score, if the residuals of the pixels are independent
  double energy = 0;                  ///< slope^2, noise included
  double signal = 0;                  ///< measured change of the score by a shift of a pixel
  double signal_variance = 0;         ///< of that measurement
  double usual = 0;                   ///< the signal that is usual for as many blocks
  double moment_u = 0, moment_v = 0;  ///< energy times its place, pixels
  double down = 0;                    ///< change of the score by a shift of a row

  void add(const ShiftEvidence& other);
  /// Whether the signal is beyond doubt. A ratio with it as the denominator is then nearly normal.
  bool isCertain() const;
  /// The mean of the true signal by Bayes' rule.
  double likelySignal() const;
};

}  // namespace uav_landing
