#pragma once

#include <cstddef>
#include <vector>

namespace uav_landing {

/// Samples of a value that may be linear in x and y, by columns, filled up to whole lanes with samples that
/// have no vote (kNowhere). u: place that value is counted from.
struct VoteColumns {
  static constexpr double kNowhere = -1e18;

  std::vector<double> x, y, u, value;
  /// Other values that the first samples may have instead, whole lanes of them: in each of these columns one
  /// for some of the samples that the column before has one for.
  std::vector<std::vector<double>> others;

  explicit VoteColumns(size_t count);
};

/// value = x_slope x + y_slope y + constant.
struct LinearValue {
  double x_slope, y_slope, constant;
};

/// How samples vote for a linear value. tolerance: difference from which on a sample does not agree. least:
/// expected values below it do not count. offset: a sample that disagrees counts only where its place is at
/// least that far ahead of the value expected. below, above: penalties for values that are more than two
/// tolerances too small, and for others that disagree.
struct VoteRules {
  double tolerance, least, offset, below, above;
};

struct Votes {
  double agreeing =
      0;               ///< 1 for a sample that agrees exactly, falling with the square of the difference to 0
  double penalty = 0;  ///< of those that disagree
  double net() const { return agreeing - penalty; }
};

/// The votes of all samples. One with several values votes with that which is nearest to the plane, and is
/// too small when all of them are.
Votes voteForPlane(const VoteColumns& columns, const LinearValue& plane, const VoteRules& rules);

}  // namespace uav_landing
