#include "kernels/samples/plane_votes.h"

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {

VoteColumns::VoteColumns(size_t count)
    : x(wholeDoubleLanes(count), 0), y(x), u(x.size(), kNowhere), value(u) {}

namespace {

// Votes of one group of lanes for a plane.
struct Voter {
  double x_slope, y_slope, constant, unit, far, least, offset;
  DoubleLanes below, above;
  DoubleLanes agreeing{}, penalty{};

  [[gnu::always_inline]] Voter(const LinearValue& plane, const VoteRules& rules)
      : x_slope(plane.x_slope),
        y_slope(plane.y_slope),
        constant(plane.constant),
        unit(1 / (rules.tolerance * rules.tolerance)),
        far(2 * rules.tolerance),
        least(rules.least),
        offset(rules.offset),
        below(DoubleLanes{} + rules.below),
        above(DoubleLanes{} + rules.above) {}

  [[gnu::always_inline]] void expect(const VoteColumns& columns, size_t i, DoubleLanes& expected) const {
    DoubleLanes x, y;
    load(&columns.x[i], x);
    load(&columns.y[i], y);
    expected = x_slope * x + y_slope * y + constant;
  }
  // nearest and largest: excess of a sample's values over the expected one.
  [[gnu::always_inline]] void add(const VoteColumns& columns, size_t i, const DoubleLanes& expected,
                                  const DoubleLanes& nearest, const DoubleLanes& largest) {
    const DoubleLanes none{};
    DoubleLanes u;
    load(&columns.u[i], u);
    const DoubleLanes missing = 1 - nearest * nearest * unit;
    const auto counts = expected >= least;
    const auto seen = u - expected >= offset;
    const DoubleLanes price = largest < -far ? below : above;
    agreeing += (counts & (missing > 0)) ? missing : none;
    penalty += (counts & seen & (missing <= 0)) ? price : none;
  }
};

}  // namespace

UAV_LANDING_MULTIVERSION Votes voteForPlane(const VoteColumns& columns, const LinearValue& plane,
                                            const VoteRules& rules) {
  Voter voter(plane, rules);
  const size_t ambiguous = columns.others.empty() ? 0 : columns.others.front().size();
  for (size_t i = 0; i < ambiguous; i += kDoubleLanes) {
    DoubleLanes expected, nearest, largest;
    voter.expect(columns, i, expected);
    load(&columns.value[i], nearest);
    nearest -= expected;
    largest = nearest;
    for (const std::vector<double>& others : columns.others) {
      if (i >= others.size()) break;
      DoubleLanes other;
      load(&others[i], other);
      other -= expected;
      nearest = other * other < nearest * nearest ? other : nearest;
      largest = other > largest ? other : largest;
    }
    voter.add(columns, i, expected, nearest, largest);
  }
  for (size_t i = ambiguous; i < columns.x.size(); i += kDoubleLanes) {
    DoubleLanes expected, residual;
    voter.expect(columns, i, expected);
    load(&columns.value[i], residual);
    residual -= expected;
    voter.add(columns, i, expected, residual, residual);
  }
  return {sum(voter.agreeing), sum(voter.penalty)};
}

}  // namespace uav_landing
