#include "bags/pair_plan.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "bags/stamp_epochs.h"

namespace uav_landing {
namespace {

constexpr double kLargestSkewMs = 100;  // largest possible max_skew
constexpr size_t kLeftImage = 0, kLeftInfo = 1, kRightImage = 2, kRightInfo = 3;

using Key = std::pair<int, int64_t>;      // epoch and stamp
using Sorted = std::map<Key, size_t>;     // to the index in the list
using Match = std::pair<size_t, size_t>;  // left and right image

std::vector<int64_t> stampsOf(const std::vector<MessageStamp>& messages) {
  std::vector<int64_t> stamps;
  for (const MessageStamp& message : messages) stamps.push_back(message.stamp);
  return stamps;
}

/// The messages that can be paired, each stamp once.
Sorted sortedBy(const std::vector<MessageStamp>& messages, const StampEpochs& epochs, bool one_epoch) {
  Sorted sorted;
  for (size_t i = 0; i < messages.size(); ++i)
    if (messages[i].stamp != 0 && !epochs.repeated[i] && !epochs.late[i])
      sorted.emplace(Key{one_epoch ? 0 : epochs.epoch[i], messages[i].stamp}, i);
  return sorted;
}

/// The nearest of the same epoch; end() when there is none.
Sorted::const_iterator nearest(const Sorted& sorted, const Key& key) {
  const auto after = sorted.lower_bound(key);
  const bool next = after != sorted.end() && after->first.first == key.first;
  if (after == sorted.begin()) return next ? after : sorted.end();
  const auto before = std::prev(after);
  if (before->first.first != key.first) return next ? after : sorted.end();
  if (!next) return before;
  return key.second - before->first.second <= after->first.second - key.second ? before : after;
}

std::vector<Match> matchImages(const Sorted& left, const Sorted& right, int64_t most) {
  std::vector<Match> matches;
  for (const auto& [key, i] : left) {
    const auto found = nearest(right, key);
    if (found == right.end() || std::abs(found->first.second - key.second) > most) continue;
    if (nearest(left, found->first)->second == i) matches.emplace_back(i, found->second);
  }
  return matches;
}

/// The camera_infos of one camera, for its images.
class Infos {
 public:
  /// image_jumps: jumps of the clock that the images show. If the camera_infos show another number, because
  /// they come seldom, they are treated as one epoch.
  Infos(const std::vector<MessageStamp>& messages, double max_late, int image_jumps) : messages_(messages) {
    const StampEpochs epochs = stampEpochs(stampsOf(messages), max_late);
    one_epoch_ = epochs.jumps != image_jumps;
    sorted_ = sortedBy(messages, epochs, one_epoch_);
  }

  /// The camera_info of an image; none when there is none at all. most: ns, largest difference of equal
  /// stamps.
  std::optional<size_t> of(int epoch, const MessageStamp& image, int64_t most, bool& held) const {
    const Key key{one_epoch_ ? 0 : epoch, image.stamp};
    const auto closest = nearest(sorted_, key);
    held = closest == sorted_.end() || std::abs(closest->first.second - image.stamp) > most;
    if (!held) return closest->second;
    if (sorted_.empty()) return byPlace(image.place);
    const auto after = sorted_.upper_bound(key);
    return after == sorted_.begin() ? after->second : std::prev(after)->second;
  }

 private:
  /// The camera_info for an image when messages have no stamp: the last one before the image in the
  /// recording.
  std::optional<size_t> byPlace(size_t place) const {
    if (messages_.empty()) return std::nullopt;
    const auto after =
        std::upper_bound(messages_.begin(), messages_.end(), place,
                         [](size_t wanted, const MessageStamp& message) { return wanted < message.place; });
    return after == messages_.begin() ? 0 : after - messages_.begin() - 1;
  }

  const std::vector<MessageStamp>& messages_;
  Sorted sorted_;
  bool one_epoch_ = false;
};

/// Median distance from the images without a partner to the nearest one of the other camera, ms.
double nearestOf(const Sorted& images, const Sorted& others, const std::vector<bool>& paired) {
  std::vector<double> distances;
  for (const auto& [key, i] : images) {
    const auto other = nearest(others, key);
    if (!paired[i] && other != others.end())
      distances.push_back(1e-6 * static_cast<double>(std::abs(other->first.second - key.second)));
  }
  if (distances.empty()) return std::nan("");
  std::nth_element(distances.begin(), distances.begin() + distances.size() / 2, distances.end());
  return distances[distances.size() / 2];
}

PairPlan::Input countOf(const std::string& topic, const std::vector<MessageStamp>& messages,
                        const StampEpochs& epochs) {
  PairPlan::Input input;
  input.topic = topic;
  input.received = messages.size();
  input.repeated = std::count(epochs.repeated.begin(), epochs.repeated.end(), true);
  input.late = std::count(epochs.late.begin(), epochs.late.end(), true);
  for (const MessageStamp& message : messages) {
    if (message.stamp == 0) {
      ++input.unstamped;
      continue;
    }
    input.first = input.first == 0 ? message.stamp : std::min(input.first, message.stamp);
    input.last = std::max(input.last, message.stamp);
  }
  return input;
}

std::string seconds(int64_t ns) {
  std::ostringstream text;
  text << ns / 1000000000 << '.';
  text.width(3);
  text.fill('0');
  text << ns / 1000000 % 1000;
  return text.str();
}

std::string milliseconds(double ms) {
  std::ostringstream text;
  text.precision(ms < 1000 ? 3 : 15);
  text << (ms < 1000 ? ms : std::round(ms)) << " ms";
  return text.str();
}

std::string listed(const std::array<PairPlan::Input, 4>& inputs, bool (*which)(const PairPlan::Input&)) {
  std::string topics;
  for (const PairPlan::Input& input : inputs)
    if (which(input)) topics += (topics.empty() ? "" : ", ") + input.topic;
  return topics;
}

}  // namespace

PairPlan planPairs(const StereoStamps& messages, const std::array<std::string, 4>& topics,
                   const RectifyParameters& parameters) {
  PairPlan plan;
  plan.approximate = parameters.approximate_sync;
  plan.max_skew = parameters.max_skew;
  std::array<StampEpochs, 4> epochs;
  for (size_t i = 0; i < 4; ++i) {
    epochs[i] = stampEpochs(stampsOf(messages[i]), parameters.max_late);
    plan.inputs[i] = countOf(topics[i], messages[i], epochs[i]);
  }
  plan.jumps = std::max(epochs[kLeftImage].jumps, epochs[kRightImage].jumps);
  // If one camera does not show that the clock was set back, only the stamps count.
  const bool one_epoch = epochs[kLeftImage].jumps != epochs[kRightImage].jumps;
  const Sorted left = sortedBy(messages[kLeftImage], epochs[kLeftImage], one_epoch);
  const Sorted right = sortedBy(messages[kRightImage], epochs[kRightImage], one_epoch);
  const int64_t most = parameters.approximate_sync ? std::llround(1e9 * parameters.max_skew) : 0;

  const Infos left_infos(messages[kLeftInfo], parameters.max_late, plan.jumps);
  const Infos right_infos(messages[kRightInfo], parameters.max_late, plan.jumps);
  std::array<std::vector<bool>, 4> paired;
  for (size_t i = 0; i < 4; ++i) paired[i].resize(messages[i].size());
  for (const auto& [i, j] : matchImages(left, right, most)) {
    const MessageStamp &left_image = messages[kLeftImage][i], &right_image = messages[kRightImage][j];
    bool left_held = false, right_held = false;
    const auto left_info = left_infos.of(epochs[kLeftImage].epoch[i], left_image, most, left_held);
    const auto right_info = right_infos.of(epochs[kRightImage].epoch[j], right_image, most, right_held);
    if (!left_info || !right_info) continue;
    plan.pairs.push_back({{i, *left_info, j, *right_info}, std::min(left_image.place, right_image.place)});
    for (size_t k = 0; k < 4; ++k) paired[k][plan.pairs.back().messages[k]] = true;
    plan.inputs[kLeftInfo].held += left_held ? 1 : 0;
    plan.inputs[kRightInfo].held += right_held ? 1 : 0;
  }
  for (size_t i = 0; i < 4; ++i) plan.inputs[i].paired = std::count(paired[i].begin(), paired[i].end(), true);
  plan.inputs[kLeftImage].nearest_ms = nearestOf(left, right, paired[kLeftImage]);
  plan.inputs[kRightImage].nearest_ms = nearestOf(right, left, paired[kRightImage]);
  return plan;
}

std::string PairPlan::complaint() const {
  const auto silent = listed(inputs, [](const Input& input) { return input.received == 0; });
  if (!silent.empty()) return "no message on " + silent;
  const auto unstamped =
      listed(inputs, [](const Input& input) { return input.held == 0 && input.unstamped == input.received; });
  if (!unstamped.empty()) return "the stamp (header.stamp) is 0 on " + unstamped;
  const auto still = listed(
      inputs, [](const Input& input) { return input.received > 1 && input.repeated + 1 == input.received; });
  if (!still.empty()) return "the stamp never changes on " + still;
  const Input &left = inputs[kLeftImage], &right = inputs[kRightImage];
  if (left.last < right.first || right.last < left.first)
    return "the cameras were not recorded at the same time, or by clocks that differ: stamps are " +
           seconds(left.first) + " to " + seconds(left.last) + " s on " + left.topic + ", " +
           seconds(right.first) + " to " + seconds(right.last) + " s on " + right.topic;
  const std::string apart =
      "images on " + left.topic + " and " + right.topic + " are " + milliseconds(left.nearest_ms) + " apart";
  if (left.nearest_ms > kLargestSkewMs)
    return apart + ", more than max_skew can be, " + milliseconds(kLargestSkewMs) +
           ": the clocks of the cameras differ, the stamps of one of them are offset, or they take images "
           "in turn: stamp both by one clock, and trigger them together";
  const std::string limit = milliseconds(1e3 * max_skew);
  if (!approximate)
    return "the stamps do not match (approximate_sync pairs cameras without a hardware trigger, within "
           "max_skew, " +
           limit + "): " + apart;
  std::ostringstream enough;  // with a margin of a fifth
  enough << 1e-3 * std::min(std::ceil(1.2 * left.nearest_ms), kLargestSkewMs);
  return apart + ", more than max_skew, " + limit + ": raise max_skew in the config file, rectify: " +
         "{approximate_sync: true, max_skew: " + enough.str() + "}";
}

std::vector<std::string> PairPlan::notes() const {
  std::vector<std::string> notes;
  for (const size_t i : {kLeftImage, kRightImage}) {
    const Input &input = inputs[i], &other = inputs[kRightImage - i];
    const size_t unpaired = input.received - input.paired;
    if (unpaired == 0) continue;
    std::string note = std::to_string(unpaired) + " of " + std::to_string(input.received) + " messages on " +
                       input.topic + " belong to no pair";
    if (input.unstamped > 0) note += ", of them " + std::to_string(input.unstamped) + " with the stamp 0";
    if (input.repeated > 0) note += ", of them " + std::to_string(input.repeated) + " with a repeated stamp";
    if (input.late > 0) note += ", of them " + std::to_string(input.late) + " came after newer ones";
    if (unpaired > input.unstamped + input.repeated + input.late)
      note += "; the nearest on " + other.topic + " is " + milliseconds(input.nearest_ms) + " away" +
              (approximate ? ", max_skew is " + milliseconds(1e3 * max_skew) : "");
    notes.push_back(note);
  }
  for (const size_t i : {kLeftInfo, kRightInfo}) {
    const Input& input = inputs[i];
    if (input.held == 0) continue;
    notes.push_back(input.topic + ": " + std::to_string(input.received) +
                    (input.received == 1 ? " message" : " messages") + " for " +
                    std::to_string(inputs[i - 1].received) + " images; " + std::to_string(input.held) +
                    " of " + std::to_string(pairs.size()) + " pairs take the last one before their image");
  }
  if (jumps > 0) notes.push_back("stamps went back " + std::to_string(jumps) + " times");
  return notes;
}

bool PairPlan::mostLeftOut() const {
  return 2 * pairs.size() < std::max(inputs[kLeftImage].received, inputs[kRightImage].received);
}

}  // namespace uav_landing
