#pragma once

#include <optional>

#include "estimation/innovation_scatter.h"
#include "height/height_filter.h"
#include "height/vertical_speed.h"
#include "integrity/ground_memory.h"
#include "integrity/pair_tests.h"
#include "integrity/solution_separation.h"
#include "landing/height/measured_height.h"
#include "uav_landing/parameters/kalman_height_parameters.h"

namespace uav_landing {

/// What the pairs before expect of this one.
struct HeightPrior {
  HeightFilter filter;  ///< predicted to the stamp of this pair
  int confirmations = 0;

  bool known() const { return filter.initialised(); }
  /// The height expected or, without one, that of the pair, m.
  double heightOr(double height) const { return known() ? filter.state()[0] : height; }
  /// The height is one that can be believed: see HeightTrack::kConfirmations.
  bool confirmed() const;
};

/// What the track says after a pair.
struct TrackVerdict {
  explicit TrackVerdict(const HeightFilter& now) : filter(now) {}

  HeightFilter filter;
  Status status = Status::kSearching;
  Failure rejection;                                             ///< the pair's height failed the gate
  double innovation = kUnknown, innovation_variance = kUnknown;  ///< m, m^2
  double gate_variance = kUnknown;                               ///< m^2, see HeightFilter::Update
  double height = kUnknown, height_variance = kUnknown;          ///< filtered, m, m^2
  double vertical_speed = kUnknown, vertical_speed_variance = kUnknown;  ///< up, m/s, m^2/s^2
  Failure failure;  ///< why the filtered height may not be used
  bool height_valid = false;
  bool confirmed = false;
  bool outdated = false;  ///< pairs were left out, for longer than a height may be predicted
  int consecutive_rejections = 0;

  /// The test of the step: innovation.
  void addTo(PairTests& tests) const;
};

/// The height over the pairs: the Kalman filter, eqs (6) to (8), with the filters that leave one source out,
/// and when it is found, believed, predicted and lost.
class HeightTrack {
 public:
  /// A height is believed after this many measurements in a row agreed: the first plane of a search can be
  /// wrong, and nothing before it could tell.
  static constexpr int kConfirmations = 3;

  /// resets: how often a height was given up before.
  HeightTrack(const KalmanHeightParameters& parameters, int resets);

  HeightPrior predict(double T);
  /// measured: of this pair, unless left_out. speed: vertical speed by the motion, NaN where it has none or
  /// none is believed.
  TrackVerdict update(double stamp, const MeasuredHeight& measured, bool left_out,
                      const VerticalSpeed& speed);
  /// Gives the height up, if there is one: nothing has been measured for too long.
  void lose();
  /// Of the height (m, m^2) that update() gave. below: by the ground straight below, where that is known; one
  /// more solution.
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
  double last_accepted_ = 0;  // stamp of the last measurement that was believed, s
  int confirmations_ = 0;
  int rejections_ = 0;  // in a row
  int resets_;
  bool lost_ = false;  // there was a height and it was given up
};

inline bool HeightPrior::confirmed() const { return confirmations >= HeightTrack::kConfirmations; }

}  // namespace uav_landing
