#include "kernels/samples/plane_votes.h"

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {

VoteColumns::VoteColumns(size_t count)
    : x(wholeDoubleLanes(count), 0), y(x), u(x.size(), kNowhere), value(u) {}

UAV_LANDING_MULTIVERSION Votes voteForPlane(const VoteColumns& columns, const LinearValue& plane,
                                            const VoteRules& rules) {
  const double x_slope = plane.x_slope, y_slope = plane.y_slope, constant = plane.constant;
  const double unit = 1 / (rules.tolerance * rules.tolerance), far = 2 * rules.tolerance;
  const double least = rules.least, offset = rules.offset;
  const DoubleLanes none{}, below = none + rules.below, above = none + rules.above;
  DoubleLanes agreeing{}, penalty{};
  for (size_t i = 0; i < columns.x.size(); i += kDoubleLanes) {
    DoubleLanes x, y, u, value;
    load(&columns.x[i], x);
    load(&columns.y[i], y);
    load(&columns.u[i], u);
    load(&columns.value[i], value);
    const DoubleLanes expected = x_slope * x + y_slope * y + constant, residual = value - expected;
    const DoubleLanes missing = 1 - residual * residual * unit;
    const auto counts = expected >= least;
    const auto seen = u - expected >= offset;
    const DoubleLanes price = residual < -far ? below : above;
    agreeing += (counts & (missing > 0)) ? missing : none;
    penalty += (counts & seen & (missing <= 0)) ? price : none;
  }
  return {sum(agreeing), sum(penalty)};
}

}  // namespace uav_landing
