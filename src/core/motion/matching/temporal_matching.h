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

/// When rows are exposed, and how the camera moves while they are. Without times all are at the stamp.
struct RowsOverTime {
  const RowTimes* times = nullptr;
  RowMotion now, then;  ///< each in the frame and the height of its image
};

struct TemporalMatchOptions {
  int window_radius = 5;
  double min_zncc = 0.75;
  int coarse_steps = 10;  ///< searched around the prediction at the coarse level; 0: the prediction is good
  RowsOverTime rows = {};
};

/// What the windows of the corners of one image are by themselves, kept while it is matched with several.
class CornerTextures {
 public:
  /// Before another image, or another size of the windows.
  void clear() { windows_.clear(); }
  /// Of a corner by its place in a list. Lists that differ there share nothing.
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
    int u = 0, v = 0;  // of the middle
    OwnTexture own;
  };
  std::vector<Window> windows_;
};

/// A window that was found over time, with the perspective of the plane around it.
struct WindowOverTime {
  PatchRefinement refinement;
  Eigen::Vector2d perspective;
};

/// Memory that matching over time works in.
struct MatchingMemory {
  std::vector<WindowOverTime> windows;
  std::vector<double> residuals;
  std::vector<WindowMeans> means;
};

/// The paper's image velocity field: finds corners of the image now in the image then, with windows warped as
/// the ground plane (unit normal n) and the predicted motion say. Both places of a match are where they would
/// be had all rows been exposed at the stamps. textures: of the image now. list: one that is no longer
/// needed, for its memory.
std::vector<TemporalMatch> matchOverTime(const StereoRig& rig, const MatchImage& now, const MatchImage& then,
                                         const cv::Mat& mask, const std::vector<TrackedCorner>& corners,
                                         const Eigen::Vector3d& normal, const CameraMotion& predicted,
                                         const TemporalMatchOptions& options, CornerTextures& textures,
                                         MatchingMemory& memory, std::vector<TemporalMatch> list = {});

/// How much the surroundings of the corners now look like those of where the motion puts them then: the sum
/// of their correlations, without a search; what is not in view, or the other way round, adds nothing.
double likenessOverTime(const StereoRig& rig, const MatchImage& now, const MatchImage& then,
                        const cv::Mat& mask, const std::vector<TrackedCorner>& corners,
                        const Eigen::Vector3d& normal, const CameraMotion& motion,
                        const TemporalMatchOptions& options);

}  // namespace uav_landing
