// The entry point that libFuzzer calls; built once for each harness.
#include "fuzz/harnesses.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  UAV_LANDING_HARNESS(data, size);
  return 0;
}
