#include "node_parameters.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "autopilot_messages.h"
#include "node_parameter_table.h"
#include "parameter_names.h"
#include "support/documentation.h"

namespace uav_landing {
namespace {

template <class Section>
class NodeParametersOf : public testing::Test {};
using Sections = testing::Types<RectifyParameters, StereoDepthParameters, ApproachAngleParameters,
                                KalmanHeightParameters, OverlayParameters, AutopilotParameters>;
TYPED_TEST_SUITE(NodeParametersOf, Sections);

// One would be taken for the other: both are private parameters of the same nodelet.
TYPED_TEST(NodeParametersOf, HaveNoNameOfTheSection) {
  const std::vector<std::string> names = parameterNames<NodeParameters, TypeParam>();
  ASSERT_GT(names.size(), 14u);
  const std::set<std::string> different(names.begin(), names.end());
  EXPECT_EQ(different.size(), names.size());
}

/// One parameter of each kind.
struct EveryKind {
  enum class Colour { kRed, kGreen } colour = Colour::kRed;
  double length = 1;
  bool wanted = true;
  std::string frame;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("length", length, 0.0, 2.0, "m", "");
    v.choice("colour", colour, {"red", "green"}, "");
    v.flag("wanted", wanted, "");
    v.text("frame", frame, "");
  }
};

TEST(ParameterNames, AreThoseOfEveryKindOfParameter) {
  EXPECT_EQ(parameterNames<EveryKind>(), (std::vector<std::string>{"length", "colour", "wanted", "frame"}));
}

TEST(ResolveFiles, ARelativeMaskBeginsAtTheConfigFile) {
  RigParameters rig;
  rig.left_mask = "masks/nose.png";
  NodeParameters node;
  node.config_file = "/home/me/rig.yaml";
  EXPECT_FALSE(resolveFiles(node, rig));
  EXPECT_EQ(rig.left_mask, "/home/me/masks/nose.png");
  EXPECT_EQ(rig.right_mask, "");
}

TEST(ResolveFiles, WithoutAConfigFileAMaskNeedsItsFullPath) {
  RigParameters rig;
  rig.left_mask = "/home/me/nose.png";
  EXPECT_FALSE(resolveFiles(NodeParameters(), rig));
  EXPECT_EQ(rig.left_mask, "/home/me/nose.png");
  rig.right_mask = "nose.png";
  EXPECT_EQ(
      resolveFiles(NodeParameters(), rig).detail,
      "rig/right_mask: nose.png: a relative path begins at the folder of config_file, which is not set; give "
      "the full path");
}

TEST(NodeParameterTable, IsTheOneInTheDocumentation) {
  test::expectPage("node_parameters.md", nodeParameterTable(), "--list-node-parameters");
}

}  // namespace
}  // namespace uav_landing
