#pragma once

namespace uav_landing {

/// Variance of a height that is common to many pairs and does not average out, by cause: errors of one cause
/// add up with their sign, those of different causes do not. m^2
struct CommonVariance {
  double lasting = 0;  ///< the surface's general shape, and the rig
  double bend = 0;     ///< what a pair leaves open of the surface's bend: some much, some hardly anything
  double width = 0;    ///< the runway's width, of heights by it

  /// The baseline's length. Unlike the others it is no part of a measurement's variance: what all heights
  /// are wrong by together makes no difference between them.
  double baseline = 0;

  /// Of a measurement, the baseline aside.
  double total() const { return lasting + bend + width; }
  double withBaseline() const { return total() + baseline; }
};

}  // namespace uav_landing
