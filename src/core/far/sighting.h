#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "far/outline_fit.h"
#include "far/picture_patch.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/parameters/approach_angle_parameters.h"
#include "uav_landing/parameters/runway_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// The ground as it is known without the runway; see SeenGround.
struct KnownGround {
  GroundNormal normal;  ///< without what the runway slopes against it
  GroundPlane plane;    ///< by stereo, or not valid
};

/// The runway from afar, from pair to pair: its outline is searched for, fitted, and followed.
///
/// An outline is taken for the runway's if it is possible: a surface of a runway's size ahead, seen on an
/// approach, that fits charts, horizon and stereo together. Another one that is possible as well, and shows
/// as clearly, leaves it open. It counts after some pairs in a row; each fits its size and place anew.
class Sighting {
 public:
  /// Pairs in a row that must agree.
  static constexpr int kConfirmations = 4;

  Sighting(const RigModel& rig, const ApproachAngleParameters& parameters, const RunwayParameters& runway);

  /// left: rectified image.
  ApproachAngleResult::Sight process(double stamp, const cv::Mat& left, const KnownGround& ground);
  void reset();

 private:
  /// The outline of one pair with the pose that belongs to it.
  struct Seen {
    FittedOutline outline;
    OutlinePose pose;
    Corners corners;
  };
  bool byChart() const { return runway_.width > 0 || runway_.length > 0; }
  static bool isNear(const OutlinePose& pose);
  bool mayStart(const KnownGround& ground) const;
  bool isPlausible(const Corners& corners, const KnownGround& ground) const;
  PoseKnowledge knowledge(const KnownGround& ground) const;
  cv::Rect region(const KnownGround& ground) const;
  Expected<Seen> fit(const cv::Mat& left, const Corners& start, const KnownGround& ground) const;
  Failure problemOf(const OutlinePose& pose) const;
  Expected<Seen> fitFrom(const cv::Mat& left, const Corners& start, const KnownGround& ground) const;
  Expected<Seen> fitCandidate(const cv::Mat& left, const Corners& corners, const KnownGround& ground) const;
  Expected<Seen> search(const cv::Mat& left, const KnownGround& ground) const;
  Expected<Seen> follow(const cv::Mat& left, const KnownGround& ground) const;
  double widthDoubt(const OutlinePose& pose) const;
  bool agrees(const OutlinePose& pose) const;
  void keep(const cv::Mat& left, const Seen& seen);
  ApproachAngleResult::Sight report(const Seen& seen, const KnownGround& ground) const;

  RigModel model_;
  double max_yaw_, slope_;  // rad
  RunwayParameters runway_;
  std::optional<double> last_stamp_;
  std::optional<Seen> last_;
  PicturePatch patch_;
  int confirmations_ = 0;
  double missed_ = 0;      // s
  double wait_until_ = 0;  // stamp until which there is no search
};

}  // namespace uav_landing
