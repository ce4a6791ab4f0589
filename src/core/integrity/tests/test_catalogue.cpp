#include "integrity/tests/test_catalogue.h"

#include <cmath>
#include <sstream>

#include "uav_landing/results/consistency_test.h"

namespace uav_landing {
namespace {

std::string limitOf(const TestDescription& described) {
  std::ostringstream out;
  switch (described.limit.kind) {
    case TestLimit::kChiSquare:
      out << "chi-square";
      break;
    case TestLimit::kSquaredGate:
      out << "`gate`²";
      break;
    case TestLimit::kFixed:
      out << described.limit.value;
      break;
  }
  return out.str();
}

const char* stepOf(const TestDescription& described) {
  switch (described.step) {
    case TestStep::kGround:
      return "ground";
    case TestStep::kPair:
      return "pair";
    case TestStep::kTrack:
      return "track";
    case TestStep::kMemory:
      return "memory";
  }
  return "";
}

}  // namespace

std::string integrityTestPage() {
  std::ostringstream out;
  out << "# Tests of integrity\n\n"
         "`kalman_height` makes these tests on every pair. `LandingEstimate.tests`, the diagnostics and the "
         "CSV column\n"
         "`failed_tests` have them in this order. A test fails when the squared normalised difference "
         "exceeds the limit.\n"
         "Noise alone exceeds *chi-square* with the probability `false_alarm_rate`. Phases are those of the\n"
         "[landing estimate](kalman_height.md#the-phases-of-a-pair). [Integrity](integrity.md) says what the "
         "tests are worth.\n\n"
         "| test | phase | compares | unit | limit | when it fails |\n|---|---|---|---|---|---|\n";
  for (const TestDescription& described : kTestCatalogue)
    out << "| `" << described.name << "` | " << stepOf(described) << " | " << described.compares << " | "
        << described.unit << " | " << limitOf(described) << " | " << described.consequence << " |\n";
  return out.str();
}

}  // namespace uav_landing
