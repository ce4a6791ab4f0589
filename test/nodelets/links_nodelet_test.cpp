#include <std_msgs/Header.h>

#include <atomic>
#include <map>

#include "nodelets/nodelet_fixture.h"
#include "nodelets/nodelet_test_main.h"
#include "nodelets/stage_nodelet.h"

using namespace uav_landing::test;
using uav_landing::InputWatch;
using uav_landing::StageNodelet;

namespace {

constexpr size_t kTopics = 200;
std::string topicOf(size_t i) { return "links/topic" + std::to_string(i); }

/// A stage that pairs nothing.
class Bystander : public StageNodelet {
 protected:
  Bystander() : StageNodelet("links") {}
  void setUp() override {}
  bool wanted() const override { return false; }
  void subscribe() override {}
  void unsubscribe() override {}
  std::vector<InputWatch::Input> inputs() const override { return {}; }
  std::string complaint() override { return ""; }
};

/// Subscribes one topic after another, in a thread of the manager.
class Reader : public Bystander {
 public:
  ~Reader() override { stop(); }
  size_t subscribed() const { return subscribed_; }
  uint32_t linksOf(size_t i) const { return subscribers_[i].getNumPublishers(); }

 private:
  bool wanted() const override { return true; }
  void subscribe() override {
    for (subscribed_ = 0; subscribed_ < kTopics; ++subscribed_)
      subscribers_.push_back(getNodeHandle().subscribe(topicOf(subscribed_), 1, &Reader::ignore));
  }
  void unsubscribe() override { subscribers_.clear(); }
  static void ignore(const std_msgs::HeaderConstPtr&) {}

  std::vector<ros::Subscriber> subscribers_;
  std::atomic<size_t> subscribed_{0};
};

/// Advertises the topics in the thread that loads it, first those that the reader subscribes at that moment.
class Writer : public Bystander {
 public:
  explicit Writer(const Reader& reader) : reader_(reader) {}
  ~Writer() override { stop(); }

 private:
  void setUp() override {
    std::vector<ros::Publisher> publishers(kTopics);
    for (size_t next = 0; next < kTopics;) {
      const size_t wanted = reader_.subscribed();
      const size_t topic = wanted < kTopics && !publishers[wanted] ? wanted : next;
      publishers[topic] = getNodeHandle().advertise<std_msgs::Header>(topicOf(topic), 1);
      while (next < kTopics && publishers[next]) ++next;
    }
    publishers_ = std::move(publishers);
  }

  const Reader& reader_;
  std::vector<ros::Publisher> publishers_;
};

TEST(LinksTest, ATopicIsLinkedOnceThoughItIsSubscribedWhileItIsAdvertised) {
  const Reader* reader = nullptr;
  nodelet::Loader loader([&](const std::string& type) -> boost::shared_ptr<nodelet::Nodelet> {
    if (type == "writer") return boost::make_shared<Writer>(*reader);
    const auto created = boost::make_shared<Reader>();
    reader = created.get();
    return created;
  });
  ASSERT_TRUE(loader.load("/reader", "reader", {}, {}));
  ASSERT_TRUE(eventually([&] { return reader->subscribed() > 0; }));
  ASSERT_TRUE(loader.load("/writer", "writer", {}, {}));
  ASSERT_TRUE(eventually([&] { return reader->subscribed() == kTopics; }));
  std::map<uint32_t, size_t> topics_of_links;
  for (size_t i = 0; i < kTopics; ++i) ++topics_of_links[reader->linksOf(i)];
  EXPECT_EQ(topics_of_links, (std::map<uint32_t, size_t>{{1, kTopics}}));
}

}  // namespace

UAV_LANDING_NODELET_TEST_MAIN("links_nodelet_test")
