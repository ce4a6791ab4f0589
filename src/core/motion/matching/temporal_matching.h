#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "image/windows/match_image.h"
#include "image/windows/patch_refinement.h"
#include "motion/matching/camera_motion.h"
#include "motion/matching/common_gain.h"
#include "motion/matching/temporal_match.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Two rectified frames of one camera.
struct CameraFrames {
  const StereoRig& rig;  ///< with the camera's K
  const MatchImage &now, &then;
  const cv::Mat& mask;  ///< pixels that are usable in both frames
};

/// Row times, and the velocities of the camera while rows are exposed. Without times all rows are exposed at
/// the stamp.
struct RowsOverTime {
  const RowTimes* times = nullptr;
  RowMotion now, then;  ///< each in its own image's frame and units of height
};

/// Motion of the camera between two frames, over the ground.
struct MotionOverGround {
  CameraMotion motion;
  Eigen::Vector3d normal;  ///< unit ground normal now
  RowsOverTime rows = {};
};

struct TemporalMatchOptions {
  int window_radius = 5;
  double min_zncc = 0.75;
  /// Distance of the search around the prediction at the coarse level; 0: the prediction is good enough.
  int coarse_steps = 10;
};

/// Properties of the corners' windows that follow from one image alone. They are kept while that image is
/// matched with several others.
class CornerTextures {
 public:
  /// Call it before another image or another window size.
  void clear() { windows_.clear(); }
  /// Entry for a corner by its place in a list. Lists with different corners at that place share nothing.
  OwnTexture& of(size_t place, const TrackedCorner& corner) {
    if (place >= windows_.size()) windows_.resize(place + 1);
    Window& window = windows_[place];
    if (window.u != corner.u || window.v != corner.v) window.own.known = window.own.distances_known = false;
    window.u = corner.u;
    window.v = corner.v;
    return window.own;
  }

 private:
  struct Window {
    int u = 0, v = 0;  // middle of the window
    OwnTexture own;
  };
  std::vector<Window> windows_;
};

/// A window that was found in the other image, with the perspective of the plane around it.
struct WindowOverTime {
  PatchRefinement refinement;
  Eigen::Vector2d perspective;
};

/// Working memory of matching over time.
struct MatchingMemory {
  CornerTextures textures;           ///< of the image now; clear it before another image comes
  std::vector<TemporalMatch> spare;  ///< a list that is no longer needed; the next one takes its memory
  std::vector<WindowOverTime> windows;
  std::vector<double> residuals;
  std::vector<WindowMeans> means;
};

/// The paper's image velocity field: finds corners of the image now in the image then. Windows are warped
/// according to the ground plane and the predicted motion. Both places of a match are those that would be
/// seen with all rows exposed at the stamps.
std::vector<TemporalMatch> matchOverTime(const CameraFrames& frames,
                                         const std::vector<TrackedCorner>& corners,
                                         const MotionOverGround& predicted,
                                         const TemporalMatchOptions& options, MatchingMemory& memory);

/// Similarity between the surroundings of the corners and the places where the motion puts them then. It is
/// the sum of their correlations, without any search. Corners that are out of view or have a negative
/// correlation add nothing.
double likenessOverTime(const CameraFrames& frames, const std::vector<TrackedCorner>& corners,
                        const MotionOverGround& motion, const TemporalMatchOptions& options);

}  // namespace uav_landing
