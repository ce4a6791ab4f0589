#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace uav_landing {
namespace fuzz {

/// Puts one input through a part of the program. A finding is a crash, a sanitizer's report, or a violated
/// promise, which aborts with a message.
using Harness = void (*)(const uint8_t* data, size_t size);

void fuzzCalibrationFile(const uint8_t* data, size_t size);  ///< bytes of a calibration file
void fuzzCameraInfo(const uint8_t* data, size_t size);       ///< numbers of two camera_infos
void fuzzConfig(const uint8_t* data, size_t size);           ///< text of config and simulator files
void fuzzImageMessage(const uint8_t* data, size_t size);     ///< any encoding, size, step and data length
void fuzzImagePair(const uint8_t* data, size_t size);        ///< pictures through all stages
void fuzzImu(const uint8_t* data, size_t size);              ///< inertial messages and their mounting
void fuzzMessages(const uint8_t* data, size_t size);         ///< StereoDepth and ApproachAngle of anybody
void fuzzBag(const uint8_t* data, size_t size);              ///< bytes of a bag
void fuzzDataset(const uint8_t* data, size_t size);          ///< files of a dataset folder

struct NamedHarness {
  const char* name;
  Harness run;
};
/// All of them.
const std::vector<NamedHarness>& harnesses();

/// Stops the log: libraries report every input that they cannot read.
void silenceLog();

/// A promise of the program; text says which.
void require(bool kept, const char* text);

}  // namespace fuzz
}  // namespace uav_landing
