#include "motion/step/plane_proof.h"

#include "base/text.h"

namespace uav_landing {
namespace {

constexpr double kLeastOnPlane = 0.7;  // share of the corners that stand out from noise
// Grey levels, 1 sigma in a window: three times the noise of a usual sensor.
constexpr double kLeastContrast = 6;
constexpr int kFewest = 10;  // corners that stand out from noise
constexpr int kRadius = 4;   // of the window, px

bool hasContrast(const cv::Mat& image, const cv::Point& corner) {
  const cv::Rect window(corner.x - kRadius, corner.y - kRadius, 2 * kRadius + 1, 2 * kRadius + 1);
  cv::Scalar mean, stddev;
  cv::meanStdDev(image(window & cv::Rect({}, image.size())), mean, stddev);
  return stddev[0] >= kLeastContrast;
}

}  // namespace

Failure doubtOfPlane(const cv::Mat& image, const std::vector<TrackedCorner>& corners,
                     const std::vector<TemporalMatch>& matches, const MotionEstimate& estimate) {
  int seen = 0, on_plane = 0;
  for (const TrackedCorner& corner : corners)
    if (hasContrast(image, {corner.u, corner.v})) ++seen;
  for (size_t i = 0; i < matches.size(); ++i)
    if (estimate.inliers[i] != 0 &&
        hasContrast(image, {cvRound(matches[i].now.x()), cvRound(matches[i].now.y())}))
      ++on_plane;
  if (seen < kFewest)
    return {Reason::kPlaneUnproven,
            text(seen, " corners stand out from noise, at least ", kFewest, " needed without stereo")};
  if (on_plane >= kLeastOnPlane * seen) return {};
  return {Reason::kPlaneUnproven, text(on_plane, " of ", seen, " corners move as on one plane, at least ",
                                       100 * kLeastOnPlane, " % needed without stereo")};
}

}  // namespace uav_landing
