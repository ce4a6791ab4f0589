#pragma once

#include <optional>

#include "estimation/innovation_scatter.h"
#include "height/height_filter.h"
#include "height/vertical_speed.h"
#include "integrity/memory/ground_memory.h"
#include "integrity/tests/pair_tests.h"
#include "integrity/tests/solution_separation.h"
#include "landing/height/measured_height.h"
#include "uav_landing/parameters/kalman_height_parameters.h"

namespace uav_landing {

/// Expectation of the previous pairs for this one.
struct HeightPrior {
  HeightFilter filter;  ///< predicted to the stamp of this pair
  int confirmations = 0;

  bool known() const { return filter.initialised(); }
  /// The expected height, or the pair's own one when nothing is expected, m.
  double heightOr(double height) const { return known() ? filter.state()[0] : height; }
  /// Whether the height is confirmed (see HeightTrack::kConfirmations).
  bool confirmed() const;
};

/// Result of the track after one pair.
struct TrackVerdict {
  explicit TrackVerdict(const HeightFilter& now) : filter(now) {}

  HeightFilter filter;
  Status status = Status::kSearching;
  Failure rejection;  ///< set when the pair's height failed the gate
  double innovation = kUnknown, innovation_variance = kUnknown;          ///< m, m^2
  double gate_variance = kUnknown;                                       ///< m^2, see HeightFilter::Update
  double height = kUnknown, height_variance = kUnknown;                  ///< filtered, m, m^2
  double vertical_speed = kUnknown, vertical_speed_variance = kUnknown;  ///< up, m/s, m^2/s^2
  Failure failure;  ///< why the filtered height must not be used
  bool height_valid = false;
  bool confirmed = false;
  bool outdated = false;  ///< pairs were rejected for longer than a height may be predicted
  int consecutive_rejections = 0;

  /// Adds the only test of this step, `innovation`.
  void addTo(PairTests& tests) const;
};

/// Follows the height over pairs with the Kalman filter of eqs (6) to (8), and with filters that each leave
/// out one source. It decides when a height is found, confirmed, predicted and lost.
class HeightTrack {
 public:
  /// Number of agreeing measurements in a row that confirm a height. The first plane of a search can be
  /// wrong, and no earlier height could show it.
  static constexpr int kConfirmations = 3;

  /// resets: number of heights given up earlier.
  HeightTrack(const KalmanHeightParameters& parameters, int resets);

  HeightPrior predict(double T);
  /// Adds a pair. measured: height of this pair; not used if left_out. speed: vertical speed from the motion,
  /// NaN when there is none or it is not believed.
  TrackVerdict update(double stamp, const MeasuredHeight& measured, bool left_out,
                      const VerticalSpeed& speed);
  /// Gives up the height, if there is one, because nothing was measured for too long.
  void lose();
  /// Protection level for the height (m, m^2) that update() returned. below: height above the ground straight
  /// below, when it is known. It counts as one more solution.
  SolutionSeparation::Level protectionLevel(double height, double height_variance,
                                            const std::optional<GroundMemory::Below>& below) const;
  Status status() const;
  bool known() const { return filter_.initialised(); }
  int resets() const { return resets_; }

 private:
  void start(double stamp, const MeasuredHeight& measured);
  void follow(double stamp, const MeasuredHeight& measured, const VerticalSpeed& speed,
              TrackVerdict& verdict);
  void followSpeed(const VerticalSpeed& claimed);
  void accept(double stamp);
  void judge(double stamp, TrackVerdict& verdict) const;
  double varianceFactor() const;

  KalmanHeightParameters parameters_;
  HeightFilter filter_;
  SolutionSeparation separation_;
  InnovationScatter scatter_, speed_scatter_;
  double last_accepted_ = 0;  // stamp of the last accepted measurement, s
  int confirmations_ = 0;
  int rejections_ = 0;  // in a row
  int resets_;
  bool lost_ = false;  // there was a height and it was given up
};

inline bool HeightPrior::confirmed() const { return confirmations >= HeightTrack::kConfirmations; }

}  // namespace uav_landing
