#include "fuzz/harnesses.h"
#include "uav_landing/parameters/parameter_file.h"
#include "uav_landing/simulator/parameter_file.h"

namespace uav_landing {
namespace fuzz {

void fuzzConfig(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (const auto chain = parseParameters(text, "config"); !chain)
    require(chain.error().detail.rfind("config: ", 0) == 0, "the message begins with the file");
  if (const auto simulator = parseSimulatorParameters(text, "config"); !simulator)
    require(simulator.error().detail.rfind("config: ", 0) == 0, "the message begins with the file");
}

}  // namespace fuzz
}  // namespace uav_landing
