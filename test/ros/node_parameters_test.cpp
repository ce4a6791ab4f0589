#include "node_parameters.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "autopilot_messages.h"

namespace uav_landing {
namespace {

/// Names of a struct's parameters.
struct Names {
  std::multiset<std::string> all;

  template <class... Rest>
  void number(const char* name, Rest&&...) {
    all.insert(name);
  }
  template <class... Rest>
  void flag(const char* name, Rest&&...) {
    all.insert(name);
  }
  template <class... Rest>
  void text(const char* name, Rest&&...) {
    all.insert(name);
  }
  template <class Enum>
  void choice(const char* name, Enum&, std::initializer_list<const char*>, const char*) {
    all.insert(name);
  }
};

template <class Section>
class NodeParametersOf : public testing::Test {};
using Sections = testing::Types<RectifyParameters, StereoDepthParameters, ApproachAngleParameters,
                                KalmanHeightParameters, OverlayParameters, AutopilotParameters>;
TYPED_TEST_SUITE(NodeParametersOf, Sections);

// One would be taken for the other: both are private parameters of the same nodelet.
TYPED_TEST(NodeParametersOf, HaveNoNameOfTheSection) {
  Names names;
  NodeParameters().visit(names);
  TypeParam().visit(names);
  ASSERT_GT(names.all.size(), 14u);
  for (const std::string& name : names.all) EXPECT_EQ(names.all.count(name), 1u) << name;
}

}  // namespace
}  // namespace uav_landing
