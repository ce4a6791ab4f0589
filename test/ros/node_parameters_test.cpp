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

TEST(NodeParameterTable, IsTheOneInTheDocumentation) {
  test::expectPage("node_parameters.md", nodeParameterTable(), "--list-node-parameters");
}

}  // namespace
}  // namespace uav_landing
