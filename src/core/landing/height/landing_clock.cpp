#include "landing/height/landing_clock.h"

#include <cmath>

#include "base/text.h"

namespace uav_landing {
namespace {

constexpr double kTells = 2;  // in sigmas: how much better the height must fit the other time

}  // namespace

LandingClock::Time LandingClock::follow(double stamp) {
  const std::optional<double> last = last_stamp_;
  last_stamp_ = stamp;
  if (!last) return {};
  const double T = stamp - *last;
  if (T > 0 && T <= reset_timeout_) return {T, {}};
  watch_ = ClockWatch();
  if (T == 0) return {0, {Reason::kTimeJump, "the stamp is that of the pair before"}};
  return {0,
          {Reason::kTimeJump, text("the stamp went ", T < 0 ? "back" : "ahead", " by ", std::abs(T), " s")}};
}

Failure LandingClock::compare(const PairInput& in, const MeasuredHeight& pair, const HeightPrior& prior) {
  if (in.repeated()) return {};  // the next step covers the time of both
  // The distance uses the pair's own height, because the expected one belongs to the wrong time.
  const std::optional<CameraStep> way = pair.failure ? std::nullopt : cameraStep(in.step(), pair.height);
  if (!way) {
    watch_.skip();
    return {};
  }
  const std::optional<double> by_way = watch_.follow(*way);
  if (!by_way || !prior.known()) return {};
  // The distance can be wrong, for example by one period of a pattern. So the height must say the same.
  const double off = pair.height - prior.filter.state()[0];
  const double off_by_way = off - prior.filter.state()[1] * (*by_way - in.step().duration);
  const double sum = pair.variance + prior.filter.covariance()(0, 0);
  if (off * off - off_by_way * off_by_way < kTells * kTells * pair.variance) return {};
  if (off_by_way * off_by_way > gate_ * gate_ * sum) return {};
  return {Reason::kTimeJump,
          text("the stamp went ahead by ", rounded(in.step().duration), " s, the camera moved as far as in ",
               rounded(*by_way), " s: the clock was set")};
}

std::optional<double> LandingClock::since(double stamp) const {
  if (!last_stamp_) return std::nullopt;
  return stamp - *last_stamp_;
}

void LandingClock::reset() {
  last_stamp_.reset();
  watch_ = ClockWatch();
}

}  // namespace uav_landing
