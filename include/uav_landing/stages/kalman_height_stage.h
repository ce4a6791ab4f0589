#pragma once

#include <optional>
#include <string>
#include <vector>

#include "uav_landing/base/innovation_scatter.h"
#include "uav_landing/base/timings.h"
#include "uav_landing/height/attitude_filter.h"
#include "uav_landing/height/height_filter.h"
#include "uav_landing/height/width_height.h"
#include "uav_landing/integrity/clock_watch.h"
#include "uav_landing/integrity/consistency_tests.h"
#include "uav_landing/integrity/ground_memory.h"
#include "uav_landing/integrity/height_memory.h"
#include "uav_landing/integrity/normal_doubt.h"
#include "uav_landing/integrity/recovery.h"
#include "uav_landing/integrity/solution_separation.h"
#include "uav_landing/integrity/speed_memory.h"
#include "uav_landing/integrity/stamp_scatter.h"
#include "uav_landing/integrity/vanishing_memory.h"
#include "uav_landing/integrity/velocity_memory.h"
#include "uav_landing/parameters/kalman_height_parameters.h"
#include "uav_landing/results/stage_results.h"
#include "uav_landing/rig/rig_change.h"
#include "uav_landing/rig/rig_rotation_filter.h"
#include "uav_landing/runway/position_filter.h"

namespace uav_landing {

struct VerticalSpeed;

/// Post-processing for one pair (paper 3.2, 3.3): reconstruction, eqs (4) (5), height filter, eqs (6)-(8),
/// status and validity.
class KalmanHeightStage {
 public:
  /// A height is believed after this many measurements in a row agreed: the first plane of a search can be
  /// wrong, and nothing before it could tell.
  static constexpr int kConfirmations = 3;

  KalmanHeightStage(const StereoRig& rig, const KalmanHeightParameters& parameters);

  /// Results of the same pair. A stamp that does not increase, or that jumps ahead by more than
  /// reset_timeout, resets the filter (reason time_jump), and so does a clock that was set in between.
  LandingResult process(const StereoDepthResult& stereo, const ApproachAngleResult& approach);
  /// What to say when no pair came for max_age: status lost, nothing valid. stamp: of now, s.
  LandingResult timeout(double stamp);
  /// Forgets everything but the count of resets.
  void reset();
  const Timings& timings() const { return timings_; }

 private:
  /// What one pair alone says of height and attitude.
  struct Reconstruction {
    Failure failure;  ///< set when there is no height
    GroundPlane plane;
    bool tilted = false;  ///< the plane contradicts those before: no height, speed or place by it
    GroundNormal normal;  ///< of the ground, averaged over the pairs; set when the plane is valid
    Eigen::Matrix3d common =
        Eigen::Matrix3d::Zero();  ///< share of the plane's covariance common to all pairs
    GroundPlane alone;            ///< by stereo, and by what was learned of the rig, alone
    Eigen::Matrix3d alone_common = Eigen::Matrix3d::Zero();
    GroundPlane below;  ///< tangent of the surface straight below; the plane where not known
    double bend = 0;    ///< its height less the plane's, m
    double height = kUnknown, variance = kUnknown;  ///< m, m^2, the surface's model error included
    double points_height = kUnknown;                ///< m
    bool by_width = false;                          ///< the height is from the runway's width
    double stereo_height = kUnknown, stereo_variance = kUnknown;  ///< m, m^2, before a known width is fused
    bool teaches_width = false;  ///< the runway's width may be learned from the height, when it is accepted
    bool refused = false;        ///< by a test of the pair: no angle that is made of it is believed either
    SolutionSeparation::Measurements without;                   ///< the height with each source left out
    Eigen::Vector3d velocity_change = Eigen::Vector3d::Zero();  ///< against the pairs before, m/s
  };
  Reconstruction reconstruct(const StereoDepthResult& stereo, const ApproachAngleResult& approach);
  /// measured: the plane of stereo with the pair's skew in its covariance.
  void findPlane(const GroundPlane& measured, const StereoDepthResult& stereo,
                 const ApproachAngleResult& approach, Reconstruction& reconstruction);
  /// Turns the plane by a direction that lies in the ground.
  void fuseDirection(const GroundDirection& ground, Reconstruction& reconstruction) const;
  /// Averages the ground normal over the pairs. A plane that contradicts those before gives no height.
  void averageAttitude(const StereoDepthResult& stereo, const ApproachAngleResult& approach,
                       Reconstruction& reconstruction, LandingResult& result);
  /// That the pair sees, n being the ground's normal. One that leaps is of other lines, as of the edge of a
  /// shadow, and the one before takes its place; but for two pairs at most, as the turn that it is compared
  /// by may have been wrong. repeated: the left image is the pair before's.
  VanishingMemory::Direction runwayDirection(bool repeated, const Eigen::Vector3d& n,
                                             const ApproachAngleResult& approach);
  void reportPlane(const Reconstruction& reconstruction, const ApproachAngleResult& approach, bool repeated,
                   LandingResult& result);
  void watchRig(const StereoDepthResult& stereo, const ApproachAngleResult& approach,
                Reconstruction& reconstruction);
  /// What is known of the ground besides the stereo plane.
  RigRotationFilter::Others otherSources(const StereoDepthResult& stereo,
                                         const ApproachAngleResult& approach) const;
  void reportRig(LandingResult& result) const;
  void reportAngle(const ApproachAngleResult& approach, const Reconstruction& reconstruction,
                   const Failure& jump, LandingResult& result) const;
  /// Velocity and turn by the step since the pair before, unless nobody can tell whether it is right.
  void reportMotion(const StereoDepthResult& stereo, const ApproachAngleResult& approach,
                    const Reconstruction& reconstruction, LandingResult& result) const;
  /// What the step does not know of the velocity's covariance. depth_change: by which share of itself lengths
  /// were changed.
  Eigen::Matrix3d doubtOfVelocity(const Eigen::Vector3d& velocity, double depth_change,
                                  const ApproachAngleResult& approach,
                                  const Reconstruction& reconstruction) const;
  /// What the pair measures without each source.
  void leaveOutSources(const StereoDepthResult& stereo, const ApproachAngleResult& approach,
                       Reconstruction& reconstruction) const;
  void leaveOutRegions(const StereoDepthResult& stereo, const ApproachAngleResult& approach,
                       Reconstruction& reconstruction) const;
  /// Tests of this pair's own sources. A failed one makes the pair give no height.
  void testPair(double T, const StereoDepthResult& stereo, const ApproachAngleResult& approach,
                Reconstruction& reconstruction, LandingResult& result);
  void testRegions(const Reconstruction& reconstruction);
  /// The height known last or, without one, that of the pair.
  double heightSoFar(const Reconstruction& reconstruction) const;
  /// height: of the pair, m.
  static std::optional<CameraStep> cameraStep(const ApproachAngleResult::Motion& step, double height);
  /// The way since the pair before against the speed on those before that.
  void testStandstill(double T, const ApproachAngleResult::Motion& step,
                      const Reconstruction& reconstruction);
  /// The step since the pair before against the velocity on those before that. Not of a picture that came
  /// once more: the next step is over the time of both. Only the angle is less certain for it: what is wrong
  /// in the direction of flight hardly changes a height.
  void testVelocity(double T, const ApproachAngleResult& approach, Reconstruction& reconstruction);
  /// Adds to the height's variance what it changes by between the stamp and the time of the images.
  void followStamps(const ApproachAngleResult::Motion& step, Reconstruction& reconstruction);
  /// The vertical speed by motion, uncertain by what the stamps are wrong by as well.
  VerticalSpeed withStamps(VerticalSpeed speed) const;
  /// Where the right camera is by the rows of the pair, against its place and the skew.
  void testBaseline(const StereoDepthResult& stereo, const ApproachAngleResult::Motion& step);
  /// The ground's normal by stereo alone against one known from elsewhere.
  void testNormal(Consistency test, const GroundPlane& plane, const GroundNormal& normal);
  /// The first test of this pair alone that failed.
  std::optional<Consistency> failedTestOfPair() const;
  /// Leaves a pair out that a test contradicts.
  void refusePair(const Failure& failure, Reconstruction& reconstruction, LandingResult& result);
  /// Why the pair is left out, or "".
  std::string problemOfPair();
  /// The published height against the one remembered.
  void testMemory(double T, const Reconstruction& reconstruction, const ApproachAngleResult& approach,
                  LandingResult& result);
  /// Carries on the ground that was in view, and adds that of this pair.
  void rememberGround(const StereoDepthResult& stereo, const ApproachAngleResult::Motion& step,
                      const Reconstruction& reconstruction, bool rejected);
  bool agreesWithFlight(const ApproachAngleResult::Motion& step, double T, double height,
                        const std::optional<Eigen::Vector3d>& normal) const;
  /// Of the ground: by this pair, else that of the pairs before, carried on. After rememberGround.
  Eigen::Vector3d knownNormal(const Reconstruction& reconstruction,
                              const ApproachAngleResult& approach) const;
  /// No height after contradictions before nothing has contradicted for recovery_time.
  void awaitRecovery(double T, LandingResult& result);
  void reportProtection(const Eigen::Vector3d& normal, LandingResult& result) const;
  void refuse(LandingResult& result, const Failure& failure) const;
  void reconstructFromPoints(const StereoDepthResult& stereo, const ApproachAngleResult& approach,
                             Reconstruction& reconstruction);
  /// The second height, from the runway's width, reported, and used where stereo has none or agrees.
  void useWidth(const ApproachAngleResult::Runway& runway, Reconstruction& reconstruction,
                LandingResult& result);
  /// Learns the width from a pair whose height was accepted.
  void learnWidth(const ApproachAngleResult::Runway& runway, const Reconstruction& reconstruction,
                  const LandingResult& result);
  /// One that the ground may have instead of that which the approach angle is measured against.
  struct OtherNormal {
    Eigen::Vector3d normal;
    Eigen::Matrix3d covariance;  ///< by which it is less certain than that, rad^2
    Eigen::Matrix3d by_noise;    ///< of the difference, as far as that is expected, rad^2
    double probability;
    double angleVariance(const Eigen::Vector3d& used, const ApproachAngleResult::Motion& motion) const;
  };
  static GroundNormal normalOfAngle(const ApproachAngleResult& approach,
                                    const ApproachAngleResult::Motion& motion);
  /// Of the angle by this motion, rad^2, as the ground may have another normal than it was measured against.
  double varianceByNormals(const Reconstruction& reconstruction, const ApproachAngleResult& approach,
                           const ApproachAngleResult::Motion& motion) const;
  /// used: the normal that an angle is measured against.
  std::vector<OtherNormal> otherNormals(const Reconstruction& reconstruction,
                                        const ApproachAngleResult& approach, const GroundNormal& used) const;
  /// What the vanishing point says of the normal. After the tests of the pair.
  void doubtNormal(const Reconstruction& reconstruction, const ApproachAngleResult& approach);
  /// What the images' motion says of it.
  void doubtNormalByMotion(const ApproachAngleResult& approach);
  /// The angle over the window, or of the step alone where the window has none.
  static const ApproachAngleResult::Motion& publishedMotion(const ApproachAngleResult& approach);
  /// The ground's normal by what moves in the image over the same time.
  static GroundNormal normalByMotion(const ApproachAngleResult& approach);
  /// How the camera turned since the pair before: where the images do not tell, by the imu.
  ApproachAngleResult::Motion turnSince(const ApproachAngleResult& approach) const;
  /// By how much the surface below may differ from the plane seen ahead, m^2: its general slope and curve,
  /// the unevenness that shows ahead, and what its bend leaves open.
  double modelVariance(double height) const;
  /// Of the last pair's variance what the next pairs have as well.
  CommonVariance commonVariance(double height) const;
  /// By which the filter's own variance is larger than what the pairs claim makes of it.
  double varianceFactor() const { return parameters_.integrity_monitor ? scatter_.factor() : 1; }
  /// From the plane of the surface ahead to its tangent straight below.
  void followBend(const StereoDepthResult& stereo, Reconstruction& reconstruction);
  /// As it was on the last pair with a plane, on one without.
  void carryBend(double stamp, Reconstruction& reconstruction);
  void followSurface(double surface_variance);

  LandingResult withoutStamp(LandingResult result) const;
  Failure followTime(double stamp);
  /// Why everything starts anew, if the clock behind the stamps was set since the pair before: the camera's
  /// way tells another time, and so does the height.
  Failure followClock(const StereoDepthResult& stereo, const ApproachAngleResult::Motion& step,
                      const Reconstruction& reconstruction);
  void filterHeight(double stamp, const Reconstruction& reconstruction,
                    const ApproachAngleResult::Motion& step, LandingResult& result);
  void updateHeight(double stamp, const Reconstruction& reconstruction,
                    const ApproachAngleResult::Motion& step, LandingResult& result);
  void updateSpeed(const Reconstruction& reconstruction, const ApproachAngleResult::Motion& step);
  void start(double stamp, const Reconstruction& reconstruction);
  void accept(double stamp);
  void loseTrack();
  void reportHeight(LandingResult& result) const;

  StereoRig rig_;
  KalmanHeightParameters parameters_;
  HeightFilter filter_;
  InnovationScatter scatter_, speed_scatter_;
  AttitudeFilter attitude_;
  PositionFilter position_;
  RigRotationFilter rig_rotation_;
  WidthHeight width_;
  SolutionSeparation separation_;
  ConsistencyTests tests_;
  RigChange rig_change_;
  int pairs_failed_ = 0, pairs_passed_ = 0;  // tests of one pair: failures before and passes since, up to 3
  bool confirming_ = false;                  // this pair passed, but has been left out for those that failed
  HeightMemory memory_;
  SpeedMemory speed_;
  VelocityMemory velocity_;
  double window_ = 0;      // of the angles of late, s
  double path_doubt_ = 0;  // angle of the last steps that contradicted less the one expected, rad
  StampScatter stamps_;
  ClockWatch clock_;
  Recovery recovery_;
  NormalDoubt doubt_, motion_doubt_;     // by the vanishing point, and by the images' motion
  int headings_held_ = 0;                // pairs in a row
  VanishingMemory vanishing_, heading_;  // of its pitch, and of its yaw
  GroundMemory ground_;
  std::optional<double> ground_stamp_;          // up to which the ground has been carried on, s
  double ground_height_ = kUnknown;             // at that time, m
  std::optional<Eigen::Vector3d> last_normal_;  // of the ground on the pair before
  Timings timings_;

  std::optional<double> last_stamp_;  ///< s
  double last_accepted_ = 0;          ///< stamp of the last measurement that was believed, s
  double width_variance_ = 0;         ///< of the last height, common to all that are from the same width, m^2
  double rig_variance_ = 0;           ///< of the height, by the rig's rotation, m^2
  double surface_mean_ = 0,
         surface_scatter_ = 0;   ///< of the surface's variance of the recent pairs, m^2, m^4
  double surface_variance_ = 0;  ///< of the surface about its plane as far as it is certain, m^2
  int surface_pairs_ = 0;        ///< that the mean is of
  double bend_variance_ = 0;     ///< of the height, by the bend of the surface ahead, m^2
  struct Bend {
    double height, variance, stamp;  ///< of the surface below less that of the plane ahead, m, m^2; s
  };
  std::optional<Bend> last_bend_;
  /// Of a height that is averaged over points, by what makes the average another than the plane's; m^2.
  double averaging_variance_ = 0;
  int confirmations_ = 0;
  int consecutive_rejections_ = 0;
  int resets_ = 0;
  bool lost_ = false;  ///< there was an estimate and it timed out
};

}  // namespace uav_landing
