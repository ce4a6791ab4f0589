#pragma once

#include <cstddef>
#include <vector>

namespace uav_landing {

/// Samples of a value that may be linear in x and y, by columns, filled up to whole lanes with samples
/// without a vote (kNowhere). u: place from which the value is counted.
struct VoteColumns {
  static constexpr double kNowhere = -1e18;

  std::vector<double> x, y, u, value;
  /// Other values that samples may have instead, in columns of whole lanes. The samples with most values come
  /// first, so that each column is as long as the one before, or shorter.
  std::vector<std::vector<double>> others;

  explicit VoteColumns(size_t count);
};

/// value = x_slope x + y_slope y + constant.
struct LinearValue {
  double x_slope, y_slope, constant;
};

/// How samples vote for a linear value. tolerance: from this difference on a sample does not agree. least:
/// smaller expected values do not count. offset: a sample that disagrees counts only when its place is at
/// least that far ahead of the expected value. below, above: penalties for values that are more than two
/// tolerances too small, and for others that disagree.
struct VoteRules {
  double tolerance, least, offset, below, above;
};

struct Votes {
  double agreeing = 0;  ///< 1 for a sample that agrees exactly; it falls to 0 with the square of the
                        ///< difference
  double penalty = 0;   ///< of samples that disagree
  double net() const { return agreeing - penalty; }
};

/// Votes of all samples. A sample with several values votes with the one nearest to the plane. It is too
/// small when all its values are.
Votes voteForPlane(const VoteColumns& columns, const LinearValue& plane, const VoteRules& rules);

}  // namespace uav_landing
