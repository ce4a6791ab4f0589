#include "pairs_in_flight.h"

#include <algorithm>
#include <map>

namespace uav_landing {

namespace {

constexpr std::chrono::seconds kLostAfter{1};

}  // namespace

std::shared_ptr<PairsInFlight> PairsInFlight::of(const std::string& topic) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<PairsInFlight>> known;
  const std::lock_guard<std::mutex> lock(mutex);
  std::shared_ptr<PairsInFlight> shared = known[topic].lock();
  if (!shared) known[topic] = shared = std::make_shared<PairsInFlight>();
  return shared;
}

std::unique_ptr<PairsInFlight::Consumer> PairsInFlight::join(const std::string& topic) {
  std::unique_ptr<Consumer> consumer(new Consumer(of(topic)));
  const std::lock_guard<std::mutex> lock(consumer->owner_->mutex_);
  consumer->owner_->consumers_.push_back(consumer.get());
  return consumer;
}

PairsInFlight::Consumer::~Consumer() {
  const std::lock_guard<std::mutex> lock(owner_->mutex_);
  owner_->consumers_.remove(this);
  owner_->changed_.notify_all();
}

void PairsInFlight::Consumer::finished(const ros::Time& stamp) {
  const std::lock_guard<std::mutex> lock(owner_->mutex_);
  const auto pair =
      std::find_if(pairs_.begin(), pairs_.end(), [&](const Pair& p) { return p.stamp == stamp; });
  if (pair != pairs_.end()) pairs_.erase(pairs_.begin(), pair + 1);
  last_finished_ = std::chrono::steady_clock::now();
  owner_->changed_.notify_all();
}

void PairsInFlight::handedOn(const ros::Time& stamp) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (Consumer* consumer : consumers_) consumer->pairs_.push_back({stamp, std::chrono::steady_clock::now()});
}

bool PairsInFlight::waitUntilBelow(size_t limit, std::chrono::milliseconds timeout) {
  std::unique_lock<std::mutex> lock(mutex_);
  forgetLost();
  return changed_.wait_for(lock, timeout, [&] { return below(limit); });
}

bool PairsInFlight::below(size_t limit) const {
  return std::all_of(consumers_.begin(), consumers_.end(),
                     [&](const Consumer* consumer) { return consumer->pairs_.size() < limit; });
}

void PairsInFlight::forgetLost() {
  const auto now = std::chrono::steady_clock::now();
  for (Consumer* consumer : consumers_) {
    // A stage that finishes other pairs is only slow.
    if (now - consumer->last_finished_ <= kLostAfter) continue;
    while (!consumer->pairs_.empty() && now - consumer->pairs_.front().since > kLostAfter)
      consumer->pairs_.pop_front();
  }
}

}  // namespace uav_landing
