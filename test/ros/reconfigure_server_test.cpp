#include "reconfigure_server.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace uav_landing {
namespace {

/// One parameter of each type.
struct Mixed {
  double length = 2.5;
  int count = 7;
  bool wanted = true;
  std::string frame = "map";

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("length", length, 1.0, 4.0, "m", "how long");
    v.number("count", count, 3, 9, "", "how many");
    v.flag("wanted", wanted, "whether");
    v.text("frame", frame, "where");
  }
};

template <class Value, class Parameter>
void expectOnly(const std::vector<Parameter>& list, const std::string& name, const Value& value) {
  ASSERT_EQ(list.size(), 1u) << name;
  EXPECT_EQ(list[0].name, name);
  EXPECT_EQ(list[0].value, value) << name;
}

TEST(ReconfigureDescription, NamesEachParameterWithTypeMeaningDefaultAndRange) {
  ReconfigureDescription description;
  Mixed().visit(description);
  const dynamic_reconfigure::ConfigDescription& message = description.message();
  ASSERT_EQ(message.groups.size(), 1u);
  const auto& parameters = message.groups[0].parameters;
  const std::vector<std::array<std::string, 3>> expected{{"length", "double", "how long (m)"},
                                                         {"count", "int", "how many"},
                                                         {"wanted", "bool", "whether"},
                                                         {"frame", "str", "where"}};
  ASSERT_EQ(parameters.size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(parameters[i].name, expected[i][0]);
    EXPECT_EQ(parameters[i].type, expected[i][1]);
    EXPECT_EQ(parameters[i].description, expected[i][2]);
  }
  expectOnly(message.dflt.doubles, "length", 2.5);
  expectOnly(message.min.doubles, "length", 1.0);
  expectOnly(message.max.doubles, "length", 4.0);
  expectOnly(message.dflt.ints, "count", 7);
  expectOnly(message.min.ints, "count", 3);
  expectOnly(message.max.ints, "count", 9);
  expectOnly(message.dflt.bools, "wanted", true);
  expectOnly(message.min.bools, "wanted", false);
  expectOnly(message.max.bools, "wanted", true);
  expectOnly(message.dflt.strs, "frame", "map");
  expectOnly(message.min.strs, "frame", "");
  expectOnly(message.max.strs, "frame", "");
  // Clients look for the group among the values, too.
  for (const auto* config : {&message.dflt, &message.min, &message.max}) {
    ASSERT_EQ(config->groups.size(), 1u);
    EXPECT_EQ(config->groups[0].name, message.groups[0].name);
    EXPECT_TRUE(config->groups[0].state);
  }
}

Mixed after(const dynamic_reconfigure::Config& request) {
  Mixed mixed;
  mixed.visit(ReconfigureRequestReader(request, "/node"));
  return mixed;
}

TEST(ReconfigureRequest, ChangesWhatItNamesAndNothingElse) {
  dynamic_reconfigure::Config request;
  EXPECT_EQ(after(request).length, 2.5);
  request.doubles.resize(1);
  request.doubles[0].name = "length";
  request.doubles[0].value = 3.5;
  Mixed mixed = after(request);
  EXPECT_EQ(mixed.length, 3.5);
  EXPECT_EQ(mixed.count, 7);
  EXPECT_TRUE(mixed.wanted);
  EXPECT_EQ(mixed.frame, "map");
  request.ints.resize(1);
  request.ints[0].name = "count";
  request.ints[0].value = 4;
  request.bools.resize(1);
  request.bools[0].name = "wanted";
  request.bools[0].value = 0;
  request.strs.resize(1);
  request.strs[0].name = "frame";
  request.strs[0].value = "odom";
  mixed = after(request);
  EXPECT_EQ(mixed.count, 4);
  EXPECT_FALSE(mixed.wanted);
  EXPECT_EQ(mixed.frame, "odom");
}

TEST(ReconfigureRequest, TakesTheNearestValueThatIsInRangeAndNoNan) {
  dynamic_reconfigure::Config request;
  request.doubles.resize(1);
  request.doubles[0].name = "length";
  request.ints.resize(1);
  request.ints[0].name = "count";
  request.doubles[0].value = -1;
  request.ints[0].value = 100;
  EXPECT_EQ(after(request).length, 1);
  EXPECT_EQ(after(request).count, 9);
  request.doubles[0].value = 100;
  request.ints[0].value = -1;
  EXPECT_EQ(after(request).length, 4);
  EXPECT_EQ(after(request).count, 3);
  request.doubles[0].value = std::nan("");
  EXPECT_EQ(after(request).length, 2.5);
}

}  // namespace
}  // namespace uav_landing
