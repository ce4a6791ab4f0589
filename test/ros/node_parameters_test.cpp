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

TEST(NodeParameterTable, IsTheOneInTheDocumentation) {
  test::expectPage("node_parameters.md", nodeParameterTable(), "--list-node-parameters");
}

}  // namespace
}  // namespace uav_landing
