#include <algorithm>

#include "faults/fault_lists.h"
#include "faults/fault_makers.h"

namespace uav_landing {

void addLightFaults(std::vector<Fault>& all) {
  all.push_back(both("exposure_jump", Place::kSensor, "gain jumps between 0.5 and 1.6 every 0.3 s",
                     [](FaultRun& run, int frame, cv::Mat& image) {
                       const bool dark = static_cast<int>(sinceOnset(run, frame) / 0.3) % 2 == 0;
                       changeExposure(image, dark ? 0.5 : 1.6, 0);
                     }));
  all.push_back(both("overexposed", Place::kSensor, "gain 3, saturated",
                     [](FaultRun&, int, cv::Mat& image) { changeExposure(image, 3, 0); }));
  all.push_back(both("underexposed", Place::kSensor, "gain 0.1",
                     [](FaultRun&, int, cv::Mat& image) { changeExposure(image, 0.1, 0); }));
  all.push_back(spoils("gain_drift", Place::kSensor, "right camera's gain falls to 0.3 within 2 s",
                       [](FaultRun& run, int frame, Delivery& pair) {
                         changeExposure(pair.right, std::max(0.3, 1 - 0.35 * sinceOnset(run, frame)), 0);
                       }));
  all.push_back(both("noise", Place::kSensor, "noise of 15 grey levels",
                     [](FaultRun& run, int, cv::Mat& image) { addNoise(image, 15, run.random); }));
  all.push_back(spoils("bands", Place::kSensor, "brightness bands that roll through both images",
                       [](FaultRun& run, int frame, Delivery& pair) {
                         band(pair.left, 9 * sinceOnset(run, frame));
                         band(pair.right, 9 * sinceOnset(run, frame) + 0.5);
                       }));
  all.push_back(both("defocus", Place::kOptics, "both lenses out of focus, 1 sigma of 3 px",
                     [](FaultRun&, int, cv::Mat& image) { blur(image, 3); }));
  all.push_back(spoils("defocus_right", Place::kOptics, "right lens out of focus, 1 sigma of 2 px",
                       [](FaultRun&, int, Delivery& pair) { blur(pair.right, 2); }));
  all.push_back(spoils("black_right", Place::kSensor, "right image is black",
                       [](FaultRun&, int, Delivery& pair) { pair.right.setTo(0); }));
  all.push_back(spoils("fogged_right", Place::kOptics, "right lens is fogged: a veil, 1 sigma of 8 px",
                       [](FaultRun& run, int, Delivery& pair) { fogLens(pair.right, run.random); }));
  all.push_back(both("motion_blur", Place::kOptics, "9 px along the rows",
                     [](FaultRun&, int, cv::Mat& image) { smear(image, 9); }));
  all.push_back(spoils("dirt", Place::kOptics, "25 dark spots on the left lens",
                       [](FaultRun& run, int, Delivery& pair) { soil(pair.left, 7 + run.onset); }));
  all.push_back(spoils("droplets", Place::kOptics, "20 drops of water on the left lens",
                       [](FaultRun& run, int, Delivery& pair) { wet(pair.left, 7 + run.onset); }));
  all.push_back(both("glare", Place::kOptics, "the sun near the horizon, with veiling glare",
                     [](FaultRun&, int, cv::Mat& image) { glare(image); }));
  all.push_back(both("night", Place::kOptics, "light of 4 %, noise of 2 grey levels",
                     [](FaultRun& run, int frame, cv::Mat& image) { night(image, 31 * run.onset + frame); }));
}

}  // namespace uav_landing
