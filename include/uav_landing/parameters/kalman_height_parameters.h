#pragma once

namespace uav_landing {

// visit(): see parameters.h.

enum class HeightSource { kPlane, kPoints };
enum class ReconstructionAngle { kPitch, kApproach };

/// Reconstruction and the height filter (nodelet kalman_height; paper 3.2, 3.3, eqs 4-8).
struct KalmanHeightParameters {
  HeightSource height_source = HeightSource::kPlane;
  ReconstructionAngle reconstruction_angle = ReconstructionAngle::kPitch;
  bool fuse_vanishing_point = true;
  double vanishing_point_gate = 3.0;
  bool fuse_imu = true;
  bool fuse_motion_normal = true;
  bool use_motion = true;
  bool average_attitude = true;
  double acceleration_stddev = 1.5;
  double initial_speed_stddev = 5.0;
  double height_model_error = 0.001;
  double gate = 5.0;
  double max_age = 0.3;
  double reset_timeout = 1.0;
  double max_height_error = 0.05;
  double min_height_error = 0.15;
  double max_angle_stddev_deg = 1.0;
  bool fuse_width_height = true;
  bool rig_watch = true;
  double rig_memory = 60.0;
  double max_rig_rotation_deg = 0.2;
  bool integrity_monitor = true;
  double integrity_risk = 1e-5;
  double fault_probability = 1e-3;
  double false_alarm_rate = 1e-5;
  double max_deceleration = 3.0;
  double recovery_time = 1.0;
  double alert_limit = 0.15;
  double alert_limit_relative = 0.05;
  double unwatched_scale_error = 0.02;
  double runway_height_limit = 0.15;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.choice("height_source", height_source, {"plane", "points"},
             "height of the fitted plane, or the average of eq (5) over the points as in the paper");
    v.choice("reconstruction_angle", reconstruction_angle, {"pitch", "approach"},
             "angle in eqs (4) and (5): pitch levels the camera; approach is the paper to the letter");
    v.flag("fuse_vanishing_point", fuse_vanishing_point,
           "correct the stereo plane's pitch with the vanishing point");
    v.number("vanishing_point_gate", vanishing_point_gate, 1.0, 20.0, "sigma",
             "gate of the vanishing point and of the other normals: one that disagrees more with "
             "the stereo plane is rejected as an outlier");
    v.flag("fuse_imu", fuse_imu,
           "correct the stereo plane's pitch and roll, and watch the rig, with the attitude of an imu");
    v.flag("fuse_motion_normal", fuse_motion_normal,
           "correct the stereo plane's pitch and roll, and watch the rig, with the ground's normal by what "
           "moves in the left image");
    v.flag("use_motion", use_motion, "measure the vertical speed by the motion between the frames as well");
    v.flag("average_attitude", average_attitude,
           "smooth pitch and roll over the last second's pairs, along the rotation between them, "
           "and make the test tilt; else they are those of each pair alone");
    v.number("acceleration_stddev", acceleration_stddev, 0.01, 50.0, "m/s^2",
             "1 sigma of the random vertical acceleration, the process noise of eq (7): a smaller "
             "one smooths the height more");
    v.number("initial_speed_stddev", initial_speed_stddev, 0.1, 100.0, "m/s",
             "1 sigma of the initial vertical speed, which starts at 0");
    v.number("height_model_error", height_model_error, 0.0, 0.1, "of height",
             "1 sigma by which the surface below differs from the plane seen ahead; does not average out. "
             "For a baseline that is not known well there is rig/baseline_stddev");
    v.number("gate", gate, 1.0, 20.0, "sigma",
             "innovation gate of the height filter: a height with a larger normalised innovation is "
             "rejected as an outlier");
    v.number("max_age", max_age, 0.05, 10.0, "s",
             "timeout of the height: without a believable one for this long, while coasting, it is "
             "not valid; without a pair for this long the status is lost");
    v.number("reset_timeout", reset_timeout, 0.1, 60.0, "s",
             "timeout of the filter: without an accepted measurement for this long it starts anew");
    v.number("max_height_error", max_height_error, 0.001, 1.0, "of height",
             "3 sigma above this share of the height (and min_height_error) is not valid");
    v.number("min_height_error", min_height_error, 0.001, 10.0, "m",
             "3 sigma below this is valid at any height");
    v.number("max_angle_stddev_deg", max_angle_stddev_deg, 0.01, 20.0, "deg",
             "1 sigma of the approach angle above this is not valid");
    v.flag("fuse_width_height", fuse_width_height,
           "use the height from the runway's width: where stereo has none, and, when runway/width is "
           "given, together with stereo if both agree");
    v.flag("rig_watch", rig_watch,
           "watch for a bent rig: estimate how far the right camera has turned since the "
           "calibration, and correct the plane for it");
    v.number("rig_memory", rig_memory, 1.0, 36000.0, "s",
             "for how long what was seen of the rig's rotation counts; shorter follows a rig that moves");
    v.number("max_rig_rotation_deg", max_rig_rotation_deg, 0.01, 5.0, "deg",
             "largest bend of the rig: when the right camera has certainly turned by more, the "
             "estimate is not valid (rig_bent)");
    v.flag("integrity_monitor", integrity_monitor,
           "make the tests of integrity, which compare the sources of the height, and compute the "
           "height's protection level");
    v.number("integrity_risk", integrity_risk, 1e-12, 0.1, "per pair",
             "probability that the height's error exceeds the protection level");
    v.number("fault_probability", fault_probability, 1e-9, 1.0, "per pair",
             "prior probability that one source is wrong and no test says so; 1: the protection level holds "
             "with integrity_risk even then");
    v.number("false_alarm_rate", false_alarm_rate, 1e-12, 0.1, "per test and pair",
             "probability of a false alarm: a test of integrity fails without a fault, as far as "
             "the claimed variances are true. A larger one makes the limits of the tests tighter");
    v.number("max_deceleration", max_deceleration, 0.01, 1000.0, "m/s^2",
             "largest change of the aircraft's ground speed. If the image stops faster than this "
             "allows, the camera is treated as frozen (test standstill). If the speed seems to jump "
             "by more, the stamps are treated as wrong. An image that repeats bit by bit is treated "
             "as frozen, too (test repeated_image); that has no limit to set");
    v.number("recovery_time", recovery_time, 0.0, 60.0, "s",
             "wait after contradictions: when tests took the height away, or failed among the first "
             "heights, none may fail for this long before the height is valid. After test velocity "
             "failed, the velocity waits as long. 0: both are there as soon as the tests pass");
    v.number("alert_limit", alert_limit, 0.001, 100.0, "m",
             "the height is not valid when its protection level exceeds this and alert_limit_relative");
    v.number("alert_limit_relative", alert_limit_relative, 0.0, 1.0, "of height",
             "the alert limit as a share of the height, see alert_limit");
    v.number("unwatched_scale_error", unwatched_scale_error, 0.0, 0.5, "of height",
             "largest error by a factor that all heights have in common, such as that of a wrong baseline. "
             "Heights, motion and the size of the ground are then wrong by the same factor, so a test that "
             "compares them with each other does not find it. The protection level allows for it by this "
             "share of the height, and the variance by rig/baseline_stddev");
    v.number(
        "runway_height_limit", runway_height_limit, 0.0, 1.0, "of height",
        "the height above the runway is not known when its protection level exceeds this share of it and "
        "alert_limit");
  }
};

}  // namespace uav_landing
