#include <algorithm>
#include <cmath>

#include "faults/fault_lists.h"
#include "faults/fault_makers.h"

namespace uav_landing {
namespace {

constexpr int kGroup = 20;             // images from one key frame of a video to the next
constexpr int kGood = 70, kPoor = 25;  // quality of a key frame, and of the images between

void encode(FaultRun& run, int frame, cv::Mat& image) {
  compress(image, (frame - run.onset) % kGroup == 0 ? kGood : kPoor);
}

/// Loses the image at this place of each group. The decoder has a ghost of it until the next key frame.
void lose(FaultRun& run, int frame, int place, cv::Mat Flight::Frame::*side, cv::Mat& image) {
  const int now = (frame - run.onset) % kGroup;
  if (now >= place) {
    const Flight::Frame* lost = &run.flight.frames[static_cast<size_t>(frame - now + place)];
    leaveGhost(image, (lost - 1)->*side, lost->*side);
  }
  encode(run, frame, image);
}

}  // namespace

void addSensorFaults(std::vector<Fault>& all) {
  all.push_back(both("video", Place::kSensor, "a video codec: blocks, and a key frame every second", encode));
  all.push_back(spoils("video_loss", Place::kSensor,
                       "the same, which loses an image of each camera every second",
                       [](FaultRun& run, int frame, Delivery& pair) {
                         lose(run, frame, 5, &Flight::Frame::left, pair.left);
                         lose(run, frame, 11, &Flight::Frame::right, pair.right);
                       }));
  all.push_back(spoils("torn", Place::kTiming, "the upper part of the left image is of the pair before",
                       [](FaultRun& run, int frame, Delivery& pair) {
                         const double share = 0.5 + 0.3 * std::sin(0.7 * frame);
                         tear(pair.left, run.flight.frames[static_cast<size_t>(std::max(0, frame - 1))].left,
                              static_cast<int>(share * pair.left.rows));
                       }));
  all.push_back(spoils("exposure_pump", Place::kSensor,
                       "gains swing between 0.4 and 1.6 in 1.5 s, each camera's its own",
                       [](FaultRun& run, int frame, Delivery& pair) {
                         const double phase = 2 * M_PI * sinceOnset(run, frame) / 1.5;
                         changeExposure(pair.left, 1 + 0.6 * std::sin(phase), 0);
                         changeExposure(pair.right, 1 + 0.6 * std::sin(phase - 0.6), 0);
                       }));
  all.push_back(spoils("dead_rows", Place::kSensor, "four rows of the right sensor are black or white",
                       [](FaultRun& run, int, Delivery& pair) { killRows(pair.right, run.seed); }));
  all.push_back(spoils("stuck_pixels", Place::kSensor, "stuck pixels and columns on both sensors",
                       [](FaultRun& run, int, Delivery& pair) {
                         stickPixels(pair.left, run.seed);
                         stickPixels(pair.right, run.seed + 1);
                       }));
}

}  // namespace uav_landing
