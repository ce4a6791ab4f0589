#include "stereo/plane/spread_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/rare_pairs.h"

namespace uav_landing {
namespace {

// When a plane was known so long ago (s), it is within the reach of following. Older planes need a reach that
// grows with their age.
constexpr double kUsualAge = 0.1;

// Following a plane in vain takes as long as scoring so many places, at any image size.
constexpr double kFollowingCost = 55e3;

// A plane above the horizon must persist so long (s) before it is reported. The roof of a hangar, trees, and
// clouds over water look like one, too.
constexpr double kOverheadLasts = 1.5;

Failure noPlane() { return {Reason::kNoPlane, "the matches of the pair do not agree on one ground plane"}; }

Failure perhapsUpsideDown() {
  return {Reason::kNoPlane,
          "what looks like the ground is above the horizon: if this stays, the cameras may be mounted upside "
          "down: set rig/upside_down: true"};
}

Failure stillSearching() {
  return {Reason::kNotYet, "the ground plane is being searched for, over several pairs"};
}

}  // namespace

SpreadSearch::SpreadSearch(const RigModel& model, int factor, const StereoDepthParameters& parameters,
                           const PlaneLimits& limits)
    : search_(model, factor, parameters, limits),
      size_(model.rig.size),
      at_once_(parameters.search_at_once) {}

void SpreadSearch::begin(double duration) {
  duration_before_ = std::exchange(duration_, duration);
  age_ += duration;
  if (overhead_age_) *overhead_age_ += duration;
  if (std::isinf(duration)) {
    reset();
  } else if (duration > kRarePairs) {
    search_.restart();
  }
}

void SpreadSearch::stop() {
  search_.stop();
  first_ = false;
  not_found_ = {};
  overhead_age_.reset();
}

void SpreadSearch::reset() {
  search_.reset();
  first_ = true;
  not_found_ = {};
  overhead_age_.reset();
}

Expected<PlaneVector> SpreadSearch::find(const StereoLevel& coarse, PlaneTracker& tracker, bool followed) {
  if (overhead_age_ && *overhead_age_ >= kOverheadLasts && !overhead_lasts_) search_.lookAgain();
  const PlaneSearch::State state = search_.advance(coarse, budget(followed));
  if (state != PlaneSearch::State::kGoesOn) first_ = false;
  if (search_.beganHere()) age_ = 0;
  if (state == PlaneSearch::State::kGoesOn)
    return tl::make_unexpected(not_found_ ? not_found_ : stillSearching());
  noteOverhead(state == PlaneSearch::State::kOverhead);
  switch (state) {
    case PlaneSearch::State::kFound: {
      not_found_ = {};
      if (search_.beganHere()) return search_.plane();
      const std::optional<PlaneVector> followed =
          tracker.followFrom(search_.plane(), coarse, std::max(1.0, age_ / kUsualAge));
      if (followed) return *followed;
      return tl::make_unexpected(stillSearching());
    }
    case PlaneSearch::State::kSwapped:
      not_found_ = {
          Reason::kNegativeDisparity,
          "disparities are negative: left and right images are swapped, or the baseline has the wrong sign"};
      break;
    case PlaneSearch::State::kOverhead:
      not_found_ = overhead_lasts_ ? perhapsUpsideDown() : noPlane();
      break;
    case PlaneSearch::State::kNotFound:
    case PlaneSearch::State::kGoesOn:
      not_found_ = noPlane();
      break;
  }
  return tl::make_unexpected(not_found_);
}

// Only two searches that began seconds apart count.
void SpreadSearch::noteOverhead(bool seen) {
  if (!seen) overhead_age_.reset();
  overhead_lasts_ = overhead_age_ && *overhead_age_ - age_ >= kOverheadLasts;
  if (seen && !overhead_age_) overhead_age_ = age_;
}

// One long gap does not make a slow camera, and after the first pair nobody knows when the next one comes.
double SpreadSearch::budget(bool followed) const {
  const bool rare = std::min(duration_, duration_before_) > kRarePairs && std::isfinite(duration_);
  if (at_once_ || rare) return std::numeric_limits<double>::infinity();
  // Lines and motion wait for the first search only.
  return PlaneSearch::budgetOf(size_, first_) - (followed ? kFollowingCost : 0);
}

}  // namespace uav_landing
