#include "bags/pair_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "bags/stamp_epochs.h"

namespace uav_landing {
namespace {

constexpr int64_t kMs = 1000000, kSecond = 1000 * kMs;
const std::array<std::string, 4> kTopics{"/left/image", "/left/info", "/right/image", "/right/info"};

/// Stamps of 20 Hz, ns.
std::vector<int64_t> stamps(int count, int64_t first = 100 * kSecond) {
  std::vector<int64_t> all;
  for (int i = 0; i < count; ++i) all.push_back(first + i * 50 * kMs);
  return all;
}

void append(std::vector<int64_t>& stamps, const std::vector<int64_t>& more) {
  stamps.insert(stamps.end(), more.begin(), more.end());
}

TEST(StampEpochs, MessagesInOrderAreOfOneClock) {
  const StampEpochs epochs = stampEpochs(stamps(10), 0.3);
  EXPECT_EQ(epochs.jumps, 0);
  EXPECT_EQ(epochs.epoch, std::vector<int>(10, 0));
}

TEST(StampEpochs, MessagesThatFillGapsAreLateHoweverLate) {
  std::vector<int64_t> shuffled = stamps(100);
  std::mt19937 random(1);
  // 120 ms late at 20 Hz, as over a network.
  std::vector<std::pair<int64_t, int64_t>> arrivals;
  for (const int64_t stamp : shuffled) arrivals.emplace_back(stamp + random() % (120 * kMs), stamp);
  std::sort(arrivals.begin(), arrivals.end());
  for (size_t i = 0; i < arrivals.size(); ++i) shuffled[i] = arrivals[i].second;
  EXPECT_FALSE(std::is_sorted(shuffled.begin(), shuffled.end()));
  EXPECT_EQ(stampEpochs(shuffled, 0.3).jumps, 0);
  // One that is a second late.
  std::vector<int64_t> late = stamps(40);
  std::rotate(late.begin() + 5, late.begin() + 6, late.begin() + 26);
  EXPECT_EQ(stampEpochs(late, 0.3).jumps, 0);
}

TEST(StampEpochs, OneWrongStampIsNoOtherClock) {
  std::vector<int64_t> wrong = stamps(10);
  wrong[4] += 1000 * kSecond;
  EXPECT_EQ(stampEpochs(wrong, 0.3).jumps, 0);
}

TEST(StampEpochs, AClockThatWasSetBackGivesStampsThatWereThere) {
  std::vector<int> expected(20, 0);
  expected.resize(40, 1);
  for (const int64_t back : {220 * kMs, 800 * kMs, 5 * kSecond}) {
    std::vector<int64_t> set_back = stamps(20);
    append(set_back, stamps(20, set_back.back() + 50 * kMs - back));
    const StampEpochs epochs = stampEpochs(set_back, 0.3);
    EXPECT_EQ(epochs.jumps, 1) << back / kMs;
    EXPECT_EQ(epochs.epoch, expected) << back / kMs;
    EXPECT_EQ(std::count(epochs.late.begin(), epochs.late.end(), true), 0);
  }
}

TEST(StampEpochs, AStampAmongOthersIsLateWhereTooFewFollowToTellAClock) {
  std::vector<int64_t> set_back = stamps(20);
  append(set_back, stamps(20, set_back.back() - 20 * kMs));
  const StampEpochs epochs = stampEpochs(set_back, 0.3);
  EXPECT_EQ(epochs.jumps, 0);
  EXPECT_TRUE(epochs.late[20]);
  EXPECT_EQ(std::count(epochs.late.begin(), epochs.late.end(), true), 1);
}

TEST(StampEpochs, ALoopBeginsAnew) {
  std::vector<int64_t> loop = stamps(20);
  append(loop, stamps(20));
  const StampEpochs epochs = stampEpochs(loop, 0.3);
  EXPECT_EQ(epochs.jumps, 1);
  EXPECT_EQ(std::count(epochs.repeated.begin(), epochs.repeated.end(), true), 0);
}

TEST(StampEpochs, TheSameStampTwiceIsRepeated) {
  std::vector<int64_t> twice = stamps(10);
  twice[3] = twice[2];
  const StampEpochs epochs = stampEpochs(twice, 0.3);
  EXPECT_EQ(epochs.jumps, 0);
  EXPECT_TRUE(epochs.repeated[3]);
  EXPECT_EQ(std::count(epochs.repeated.begin(), epochs.repeated.end(), true), 1);
}

class PairPlanTest : public testing::Test {
 protected:
  void add(size_t input, int64_t stamp) { messages_[input].push_back({stamp, place_++}); }
  void addLeft(int64_t stamp) {
    add(0, stamp);
    add(1, stamp);
  }
  void addRight(int64_t stamp) {
    add(2, stamp);
    add(3, stamp);
  }
  PairPlan plan() const { return planPairs(messages_, kTopics, parameters_); }
  /// Stamps of the messages of each pair, ms after the first one.
  std::vector<std::array<int64_t, 4>> pairs() const {
    std::vector<std::array<int64_t, 4>> found;
    for (const PairPlan::Pair& pair : plan().pairs) {
      found.emplace_back();
      for (size_t i = 0; i < 4; ++i)
        found.back()[i] = (messages_[i][pair.messages[i]].stamp - 100 * kSecond) / kMs;
    }
    return found;
  }

  StereoStamps messages_;
  RectifyParameters parameters_;
  size_t place_ = 0;
};

using Stamps = std::vector<std::array<int64_t, 4>>;

TEST_F(PairPlanTest, OneCameraAfterTheOther) {
  for (const int64_t stamp : stamps(3)) addLeft(stamp);
  for (const int64_t stamp : stamps(3)) addRight(stamp);
  EXPECT_EQ(pairs(), (Stamps{{0, 0, 0, 0}, {50, 50, 50, 50}, {100, 100, 100, 100}}));
  EXPECT_TRUE(plan().notes().empty());
  EXPECT_FALSE(plan().mostLeftOut());
}

TEST_F(PairPlanTest, AClockSetBackKeepsThePairsOfBothClocks) {
  Stamps expected;
  for (const int64_t first : {100 * kSecond, 100 * kSecond + 270 * kMs}) {
    for (const int64_t stamp : stamps(10, first)) {
      addLeft(stamp);
      addRight(stamp);
      const int64_t ms = (stamp - 100 * kSecond) / kMs;
      expected.push_back({ms, ms, ms, ms});
    }
  }
  EXPECT_EQ(pairs(), expected);
  EXPECT_EQ(plan().notes(), std::vector<std::string>{"stamps went back 1 times"});
}

TEST_F(PairPlanTest, AnImageWhoseStampCannotBeTrustedIsLeftOut) {
  for (const int64_t stamp : stamps(20)) {
    addLeft(stamp);
    addRight(stamp);
  }
  addLeft(101 * kSecond - 70 * kMs);
  addRight(101 * kSecond - 70 * kMs);
  EXPECT_EQ(plan().pairs.size(), 20u);
  EXPECT_EQ(plan().notes(),
            (std::vector<std::string>{
                "1 of 21 messages on /left/image belong to no pair, of them 1 came after newer ones",
                "1 of 21 messages on /right/image belong to no pair, of them 1 came after newer ones"}));
}

TEST_F(PairPlanTest, TheLastCameraInfoIsHeldAndTheFirstOneServesTheImagesBeforeIt) {
  for (const int64_t stamp : stamps(6)) {
    add(0, stamp);
    addRight(stamp);
  }
  add(1, 100 * kSecond + 110 * kMs);
  add(1, 100 * kSecond + 200 * kMs);
  EXPECT_EQ(pairs(), (Stamps{{0, 110, 0, 0},
                             {50, 110, 50, 50},
                             {100, 110, 100, 100},
                             {150, 110, 150, 150},
                             {200, 200, 200, 200},
                             {250, 200, 250, 250}}));
  EXPECT_EQ(plan().notes(),
            std::vector<std::string>{
                "/left/info: 2 messages for 6 images; 5 of 6 pairs take the last one before their image"});
}

TEST_F(PairPlanTest, ACameraInfoWithoutAStampServesTheImagesRecordedAfterIt) {
  for (const int64_t stamp : stamps(4)) {
    if (stamp != 100 * kSecond + 50 * kMs) add(1, 0);
    add(0, stamp);
    addRight(stamp);
  }
  std::vector<size_t> infos;
  for (const PairPlan::Pair& pair : plan().pairs) infos.push_back(pair.messages[1]);
  EXPECT_EQ(infos, (std::vector<size_t>{0, 0, 1, 2}));
}

TEST_F(PairPlanTest, ApproximateStampsPairWithTheNearest) {
  for (const int64_t stamp : stamps(4)) addLeft(stamp);
  for (const int64_t stamp : stamps(4, 100 * kSecond + 8 * kMs)) addRight(stamp);
  EXPECT_EQ(plan().complaint(),
            "the stamps do not match (approximate_sync pairs cameras without a hardware trigger, within "
            "max_skew, 10 ms): images on /left/image and /right/image are 8 ms apart");
  parameters_.approximate_sync = true;
  EXPECT_EQ(pairs(), (Stamps{{0, 0, 8, 8}, {50, 50, 58, 58}, {100, 100, 108, 108}, {150, 150, 158, 158}}));
  parameters_.max_skew = 0.007;
  EXPECT_TRUE(plan().pairs.empty());
  EXPECT_EQ(plan().complaint(),
            "images on /left/image and /right/image are 8 ms apart, more than max_skew, 7 ms: raise max_skew "
            "in the config file, rectify: {approximate_sync: true, max_skew: 0.01}");
}

/// The range of max_skew.
struct LargestSkew {
  void flag(const char*, bool, const char*) {}
  template <class Value>
  void number(const std::string& name, Value, double, double most, const char*, const char*) {
    if (name == "max_skew") value = most;
  }
  double value = 0;
};

TEST_F(PairPlanTest, NoSkewIsAdvisedThatTheConfigFileMayNotHave) {
  LargestSkew largest;
  parameters_.visit(largest);
  ASSERT_EQ(largest.value, 0.1);
  parameters_.approximate_sync = true;
  for (const int64_t ms : {0, 500, 1000}) addLeft(100 * kSecond + ms * kMs);
  for (const int64_t ms : {95, 595, 1095}) addRight(100 * kSecond + ms * kMs);
  EXPECT_NE(plan().complaint().find("raise max_skew in the config file, rectify: {approximate_sync: true, "
                                    "max_skew: 0.1}"),
            std::string::npos)
      << plan().complaint();
  messages_[2].clear();
  messages_[3].clear();
  for (const int64_t ms : {120, 620, 1120}) addRight(100 * kSecond + ms * kMs);
  const std::string expected =
      "images on /left/image and /right/image are 120 ms apart, more than max_skew can be, 100 ms: the "
      "clocks "
      "of the cameras differ, the stamps of one of them are offset, or they take images in turn: stamp "
      "both "
      "by one clock, and trigger them together";
  EXPECT_EQ(plan().complaint(), expected);
  parameters_.approximate_sync = false;
  EXPECT_EQ(plan().complaint(), expected) << "approximate_sync would not help";
}

TEST_F(PairPlanTest, ApproximateStampsAreEachOthersNearest) {
  parameters_.approximate_sync = true;
  for (const int64_t ms : {0, 6, 50, 100}) addLeft(100 * kSecond + ms * kMs);
  for (const int64_t ms : {8, 52, 102}) addRight(100 * kSecond + ms * kMs);
  EXPECT_EQ(pairs(), (Stamps{{6, 6, 8, 8}, {50, 50, 52, 52}, {100, 100, 102, 102}}));
}

TEST_F(PairPlanTest, ImagesWithoutAPartnerAreCountedAndTheirReasonIsNamed) {
  for (const int64_t stamp : stamps(9)) {
    addLeft(stamp);
    if (stamp % (100 * kMs) == 0) addRight(stamp);
  }
  add(2, 0);
  EXPECT_EQ(plan().notes(),
            (std::vector<std::string>{
                "4 of 9 messages on /left/image belong to no pair; the nearest on /right/image is 50 ms away",
                "1 of 6 messages on /right/image belong to no pair, of them 1 with the stamp 0"}));
  EXPECT_FALSE(plan().mostLeftOut());
  addLeft(100 * kSecond + 450 * kMs);
  addLeft(100 * kSecond + 500 * kMs);
  EXPECT_TRUE(plan().mostLeftOut()) << "5 pairs of 11 left images";
}

TEST_F(PairPlanTest, WhyThereIsNoPair) {
  for (const int64_t stamp : stamps(3)) addLeft(stamp);
  for (const int64_t stamp : stamps(3)) add(2, stamp);
  EXPECT_EQ(plan().complaint(), "no message on /right/info");
  messages_[2].clear();
  for (const int64_t stamp : stamps(3, 160 * kSecond)) addRight(stamp);
  EXPECT_EQ(plan().complaint(),
            "the cameras were not recorded at the same time, or by clocks that differ: stamps are 100.000 to "
            "100.100 s on /left/image, 160.000 to 160.100 s on /right/image");
  messages_[2] = {{0, 1}, {0, 2}};
  EXPECT_EQ(plan().complaint(), "the stamp (header.stamp) is 0 on /right/image");
  messages_[2] = {{kSecond, 1}, {kSecond, 2}};
  EXPECT_EQ(plan().complaint(), "the stamp never changes on /right/image");
}

}  // namespace
}  // namespace uav_landing
