// docs/bad_configurations.md, line by line: the message, that nothing is half started, and that the others go
// on.
#include <uav_landing/LandingEstimate.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <cstdio>

#include "nodelets/nodelet_fixture.h"
#include "nodelets/nodelet_test_main.h"
#include "nodelets/stereo_scene.h"
#include "support/bad_configurations.h"

using namespace uav_landing::test;

namespace {

/// A value as `rosparam load` takes it from a file.
XmlRpc::XmlRpcValue toXmlRpc(const YAML::Node& node) {
  XmlRpc::XmlRpcValue value;
  bool flag = false;
  int whole = 0;
  double number = 0;
  if (node.IsSequence()) {
    value.setSize(static_cast<int>(node.size()));
    for (int i = 0; i < value.size(); ++i) value[i] = toXmlRpc(node[i]);
  } else if (node.IsMap()) {
    for (const auto& entry : node) value[entry.first.Scalar()] = toXmlRpc(entry.second);
  } else if (YAML::convert<int>::decode(node, whole)) {
    value = whole;
  } else if (YAML::convert<double>::decode(node, number)) {
    value = number;
  } else if (YAML::convert<bool>::decode(node, flag)) {
    value = flag;
  } else {
    value = node.Scalar();
  }
  return value;
}

class BadConfigurationsTest : public NodeletTest {
 protected:
  /// The nodelet is refused with exactly this message, and has left no trace.
  void expectExactRefusal(const std::string& nodelet, const std::string& message) {
    const std::string name = "/uav_landing/" + nodelet;
    log_.clear();
    EXPECT_FALSE(loader_.load(name, "uav_landing/" + nodelet, {}, {}));
    const std::string line = name + ": " + message;
    EXPECT_TRUE(log_.waitFor([&](const rosgraph_msgs::Log& entry) {
      return entry.level == rosgraph_msgs::Log::FATAL && entry.msg == line;
    })) << "expected: "
        << line << "\ngot:\n"
        << wholeLog();
    EXPECT_EQ(traces(), "");
  }

  void expectRefusals(const std::string& heading) {
    for (const BadConfiguration& row : badConfigurations(heading)) {
      SCOPED_TRACE(row.given);
      const YAML::Node given = YAML::Load(row.given);
      const std::string section = given.begin()->first.Scalar();
      ros::param::set("/uav_landing/" + section, toXmlRpc(given.begin()->second));
      for (const std::string& nodelet : readersOf(section)) expectExactRefusal(nodelet, row.message);
      ros::param::del("/uav_landing/" + section);
    }
  }

  static std::vector<std::string> readersOf(const std::string& section) {
    if (section != "rig" && section != "runway") return {section};
    return {"rectify", "stereo_depth", "approach_angle", "kalman_height", "overlay", "autopilot"};
  }

  /// Topics and services under /uav_landing that this process has.
  std::string traces() {
    XmlRpc::XmlRpcValue request, response, state;
    request[0] = ros::this_node::getName();
    if (!ros::master::execute("getSystemState", request, response, state, true)) return "no master";
    std::string found;
    for (int kind = 0; kind < state.size(); ++kind)
      for (int i = 0; i < state[kind].size(); ++i) {
        const std::string topic = state[kind][i][0];
        if (topic.rfind("/uav_landing", 0) == 0 || topic.rfind("/stereo", 0) == 0) found += topic + "\n";
      }
    return found;
  }
};

TEST_F(BadConfigurationsTest, ParametersOutOfPlace) { expectRefusals("Parameters"); }

TEST_F(BadConfigurationsTest, ParametersOfTheNodelets) { expectRefusals("Parameters of the nodelets alone"); }

TEST_F(BadConfigurationsTest, FilesAsAWhole) {
  const std::string path = testing::TempDir() + "bad_configuration_" + std::to_string(getpid()) + ".yaml";
  for (const BadConfiguration& row : badConfigurations("Files")) {
    SCOPED_TRACE(row.given);
    std::ofstream(path) << row.given;
    // A section that is not its own stops a nodelet, too.
    setParameter("rectify", "config_file", path);
    expectExactRefusal("rectify", path + ": " + row.message);
  }
  std::remove(path.c_str());
}

TEST_F(BadConfigurationsTest, AMaskThatCannotBeUsedStopsTheNodeletsThatWouldUseIt) {
  ros::param::set("/uav_landing/rig/left_mask", "/nowhere/nose.png");
  for (const char* nodelet : {"stereo_depth", "approach_angle"})
    expectExactRefusal(nodelet,
                       "rig/left_mask: /nowhere/nose.png: no such file; a relative path begins at the config "
                       "file's folder");
  for (const char* nodelet : {"rectify", "kalman_height", "overlay", "autopilot"}) load(nodelet);
}

TEST_F(BadConfigurationsTest, ABadNodeletLeavesTheOthersRunning) {
  for (const char* nodelet : {"rectify", "stereo_depth", "approach_angle"}) load(nodelet);
  setParameter("kalman_height", "gate", -1);
  expectRefusal("kalman_height", "kalman_height/gate: -1 is out of range");
  setParameter("overlay", "scale", -1);
  expectRefusal("overlay", "overlay/scale: -1 is out of range");
  setParameter("kalman_height", "gate", 5);
  load("kalman_height");
  Listener<uav_landing::LandingEstimate> estimates("/uav_landing/landing_estimate");
  PairPublisher cameras(PairPublisher::kRaw);
  const StereoScene scene;
  double t = 0;
  EXPECT_TRUE(eventually([&] {
    cameras.publish(scene, t += 0.05);
    for (const auto& estimate : estimates.messages())
      if (estimate->height_valid) return true;
    return false;
  })) << wholeLog();
}

}  // namespace

UAV_LANDING_NODELET_TEST_MAIN("bad_configurations_nodelet_test")
