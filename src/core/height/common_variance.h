#pragma once

namespace uav_landing {

/// Variance of a height that is common to many pairs and does not average out, by cause, m^2. Errors of one
/// cause add up with their sign; those of different causes do not.
struct CommonVariance {
  double lasting = 0;  ///< the surface's general shape, and the rig
  double bend = 0;     ///< the part of the surface's bend that a pair leaves open: much in some pairs, next
                       ///< to nothing in others
  double width = 0;    ///< the runway's width, for heights by it

  /// The baseline's length. It is not part of a measurement's variance, because an error common to all
  /// heights makes no difference between them.
  double baseline = 0;

  /// Variance of a measurement, without the baseline.
  double total() const { return lasting + bend + width; }
  double withBaseline() const { return total() + baseline; }
};

}  // namespace uav_landing
