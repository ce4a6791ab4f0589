#include "stereo/plane/plane_search.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "stereo/matching/corner_matching.h"
#include "stereo/plane/plane_consensus.h"
#include "stereo/plane/plane_following.h"
#include "stereo/plane/plane_rivals.h"
#include "stereo/plane/slope_band.h"

namespace uav_landing {
namespace {

constexpr size_t kCoarseCorners = 500, kWideCorners = 256;
// One corner in so many is enough to tell whether images are swapped, when the plane ahead is clear.
constexpr size_t kSample = 4;
// One search in so many failing ones is repeated with left and right swapped, and with the cameras turned
// over.
constexpr int kSwapCheckInterval = 10;
// Costs, in places that could be scored in the same time: to take the images and find corners, to choose
// between planes, and a consensus by itself and per sample.
constexpr double kBeginCost = 50e3, kChoiceCost = 40e3, kConsensusCost = 2e3, kSampleCost = 15;
// With fewer columns in the coarse level, half of that level shows too little.
constexpr int kEnoughColumns = 240;

}  // namespace

PlaneSearch::PlaneSearch(const RigModel& model, int factor, const StereoDepthParameters& parameters,
                         const PlaneLimits& limits)
    : parameters_(parameters), limits_(limits) {
  const int margin = parameters.window_radius + 2;
  ahead_.coarse.level = reduceLevel(model, factor, margin);
  const bool halved = ahead_.coarse.level.rig.size.width >= kEnoughColumns;
  ahead_.wide.level = reduceLevel(model, halved ? 2 * factor : factor, margin);
}

double PlaneSearch::budgetOf(const cv::Size& size, bool alone) {
  // Measured values. When lines and motion are searched as well, a pair then takes two to three times as long
  // as one whose plane is followed. The coarse level has about the same size for all images. Small images
  // leave little time for it, and with large ones the pair that ends the search has much to match.
  constexpr double kAtVga = 240e3, kVga = 640.0 * 480.0, kBelow = 0.84, kAbove = 0.4;
  constexpr double kAloneAtVga = 900e3, kAloneAbove = 0.25, kLeast = 75e3;
  const double ratio = size.area() / kVga;
  if (alone) return kAloneAtVga * std::pow(ratio, ratio < 1 ? kBelow : kAloneAbove);
  return std::max(kLeast, kAtVga * std::pow(ratio, ratio < 1 ? kBelow : kAbove));
}

PlaneSearch::State PlaneSearch::advance(const StereoLevel& coarse, double budget) {
  began_here_ = phase_ == Phase::kNone;
  if (began_here_) {
    begin(coarse);
    budget -= kBeginCost;
  }
  State state = State::kGoesOn;
  while (state == State::kGoesOn && budget > 0) {
    if (band_ < SlopeBands::kAll) {
      budget -= searchOn();
    } else {
      if (phase_ != Phase::kSample) budget -= kChoiceCost;
      state = decide();
    }
  }
  return state;
}

void PlaneSearch::stop() {
  restart();
  failed_ = 0;
  was_upright_ = true;
}

void PlaneSearch::reset() {
  stop();
  looks_like_ = State::kNotFound;
  was_upright_ = false;
}

void PlaneSearch::begin(const StereoLevel& coarse) {
  const auto take = [](const cv::Mat& from, cv::Mat& to, cv::Mat& half, const cv::Size& size) {
    from.copyTo(to);
    if (size == from.size()) {
      half = to;
    } else {
      cv::resize(to(cv::Rect(cv::Point(), size * 2)), half, size, 0, 0, cv::INTER_AREA);
    }
  };
  StereoLevel &whole = ahead_.coarse.level, &wide = ahead_.wide.level;
  take(coarse.left, whole.left, wide.left, wide.rig.size);
  take(coarse.right, whole.right, wide.right, wide.rig.size);
  prepare(ahead_.coarse, kCoarseCorners);
  prepare(ahead_.wide, kWideCorners);
  found_.reset();
  leaders_.clear();
  phase_ = Phase::kAhead;
  beginBand(0);
}

void PlaneSearch::beginOther(Phase phase) {
  const size_t share = phase == Phase::kSample ? kSample : 1;
  const auto seen = phase == Phase::kOverhead ? turnedOver : swapped;
  other_.coarse.level = seen(ahead_.coarse.level);
  other_.wide.level = seen(ahead_.wide.level);
  prepare(other_.coarse, kCoarseCorners / share);
  prepare(other_.wide, kWideCorners / share);
  leaders_.clear();
  phase_ = phase;
  beginBand(0);
}

void PlaneSearch::prepare(Tier& tier, size_t corners) {
  const StereoLevel& level = tier.level;
  addRoomBeside(level.right, tier.right);
  tier.corners = findCorners(level.left, level.left_mask,
                             {static_cast<int>(corners), parameters_.corner_quality,
                              parameters_.min_corner_distance, parameters_.harris_k},
                             memory_);
}

double PlaneSearch::searchOn() {
  const Tiers& tiers = phase_ == Phase::kAhead ? ahead_ : other_;
  const Tier& tier = isWide() ? tiers.wide : tiers.coarse;
  const SlopeBand band = SlopeBands::at(band_);
  return corner_ < tier.corners.size() ? lookAtCorners(band, tier) : endBand(band, tier);
}

double PlaneSearch::lookAtCorners(const SlopeBand& band, const Tier& tier) {
  constexpr size_t kAtOnce = 125;
  const auto first = tier.corners.begin() + static_cast<std::ptrdiff_t>(corner_);
  corner_ = std::min(corner_ + kAtOnce, tier.corners.size());
  const auto last = tier.corners.begin() + static_cast<std::ptrdiff_t>(corner_);
  const BandCandidates found = candidatesOf(band, tier, {first, last}, parameters_, limits_);
  candidates_.insert(candidates_.end(), found.samples.begin(), found.samples.end());
  return found.scored;
}

double PlaneSearch::endBand(const SlopeBand& band, const Tier& tier) {
  constexpr int kFarIterations = 250, kNearIterations = 200, kDraws = 10;
  ConsensusOptions options;
  options.iterations = isWide() ? kNearIterations : kFarIterations;
  options.draws_each = kDraws;
  options.until_sure = true;
  options.slope_range = band.range;
  const std::optional<Consensus> plane = findPlane(tier.level.rig, candidates_, limits_, options);
  const int least = phase_ == Phase::kSample ? limits_.min_points / 2 : limits_.min_points;
  if (plane && plane->support >= least)
    leaders_.push_back({plane->g, plane->score / static_cast<double>(tier.corners.size()), isWide()});
  const double samples = static_cast<double>(candidates_.size());
  beginBand(band_ + 1);
  return kConsensusCost + kSampleCost * samples;
}

void PlaneSearch::beginBand(size_t band) {
  band_ = band;
  corner_ = 0;
  candidates_.clear();
}

PlaneSearch::State PlaneSearch::decide() {
  switch (phase_) {
    case Phase::kAhead:
      return decideAhead();
    case Phase::kSample:
      return decideBySample();
    case Phase::kBehind:
      return decideBehind();
    case Phase::kOverhead:
      return decideOverhead();
    case Phase::kNone:
      break;
  }
  return end(State::kNotFound);
}

// Chooses among the planes with nearly as many votes as the first one. Where texture repeats, a plane that is
// one period off has about as many votes, so the plane wins on which the corners look most alike.
std::optional<PlaneSearch::Best> PlaneSearch::chooseFrom(std::vector<Leader>& leaders, const Tiers& tiers) {
  constexpr double kRivalShare = 0.8;
  std::stable_sort(leaders.begin(), leaders.end(),
                   [](const Leader& a, const Leader& b) { return a.share > b.share; });
  const StereoLevel& level = tiers.coarse.level;
  GroundCornerMemory memory;
  std::optional<RivalPlane> best;
  double most = 0;  // share of the first one
  for (const Leader& leader : leaders) {
    if (best && leader.share < kRivalShare * most) break;
    PlaneVector g = leader.g;
    if (leader.wide && tiers.wide.level.rig.size != level.rig.size) {
      const std::optional<Consensus> closer = trackPlane(level, g, parameters_, limits_, memory);
      if (!closer) continue;
      g = closer->g;
    }
    RivalPlane rival(level, tiers.coarse.corners, g, parameters_);
    if (!best) most = leader.share;
    if (!best || rival.matchesBetterThan(*best, limits_.min_points)) best = std::move(rival);
  }
  if (!best) return std::nullopt;
  return Best{best->g, most};
}

PlaneSearch::State PlaneSearch::decideAhead() {
  found_ = chooseFrom(leaders_, ahead_);
  if (!found_ && failed_ % kSwapCheckInterval != 0) return end(looks_like_);
  beginOther(found_ ? Phase::kSample : Phase::kBehind);
  return State::kGoesOn;
}

// Where texture repeats, as in threshold bars, swapped images also have planes in front of the camera.
PlaneSearch::State PlaneSearch::decideBySample() {
  constexpr double kClearly = 0.5;
  const auto clear = [&](const Leader& leader) { return leader.share < kClearly * found_->share; };
  if (std::all_of(leaders_.begin(), leaders_.end(), clear)) return end(State::kFound);
  beginOther(Phase::kBehind);
  return State::kGoesOn;
}

PlaneSearch::State PlaneSearch::decideBehind() {
  const std::optional<Best> behind = chooseFrom(leaders_, other_);
  looks_like_ = State::kNotFound;
  if (behind && (!found_ || behind->share > found_->share)) return end(looks_like_ = State::kSwapped);
  if (found_) return end(State::kFound);
  if (was_upright_) return end(State::kNotFound);
  beginOther(Phase::kOverhead);
  return State::kGoesOn;
}

PlaneSearch::State PlaneSearch::decideOverhead() {
  if (chooseFrom(leaders_, other_)) looks_like_ = State::kOverhead;
  return end(looks_like_);
}

PlaneSearch::State PlaneSearch::end(State state) {
  if (state == State::kFound) {
    looks_like_ = State::kNotFound;
    was_upright_ = true;
  }
  failed_ = state == State::kFound ? 0 : failed_ + 1;
  phase_ = Phase::kNone;
  return state;
}

}  // namespace uav_landing
