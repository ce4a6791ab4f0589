#pragma once

#include <initializer_list>

#include "uav_landing/simulator/scenery_parameters.h"

namespace uav_landing {

// All parameters of the simulator, with name, default, range, unit and meaning. The visitor is that of
// uav_landing/parameters/parameters.h. config/simulator/full_scale.yaml explains how they work together. The
// defaults are a full-scale approach seen by an ideal rig. Grey levels are those of the 8-bit image before
// gain and offset.

/// Common parameters of both cameras (section image). A rolling shutter exposes its rows one after the other.
/// The middle of row v of the raw image is exposed at stamp + ((v + 0.5) / height - stamp_row) readout_time.
struct SimulatedImageParameters {
  enum class RowDirection { kRows, kColumns };

  int width = 640;
  int height = 480;
  int supersampling = 2;
  double blur = 0.5;
  double noise = 2.0;
  double exposure_time = 0.0;
  int exposure_samples = 4;
  double readout_time = 0.0;
  double stamp_row = 0.5;
  RowDirection row_direction = RowDirection::kRows;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("width", width, 16, 4096, "px", "image width");
    v.number("height", height, 16, 4096, "px", "image height");
    v.number("supersampling", supersampling, 1, 8, "", "samples along each side of a pixel");
    v.number("blur", blur, 0.0, 10.0, "px", "1 sigma of the lens's blur");
    v.number("noise", noise, 0.0, 50.0, "grey levels", "1 sigma of the sensor's noise");
    v.number("exposure_time", exposure_time, 0.0, 0.1, "s",
             "motion blur over this time around the stamp; 0: none");
    v.number("exposure_samples", exposure_samples, 1, 64, "", "images averaged over the exposure time");
    v.number("readout_time", readout_time, -0.5, 0.5, "s",
             "of a rolling shutter, from the top row to the bottom row; negative: from bottom to top; 0: all "
             "rows at once");
    v.number("stamp_row", stamp_row, -2.0, 2.0, "image heights",
             "row that is in the middle of its exposure at the stamp; 0: top, 1: bottom");
    v.choice("row_direction", row_direction, {"rows", "columns"},
             "what is exposed one after the other; columns: from left to right");
  }
};

enum class SimulatedLens { kPlumbBob, kEquidistant };

/// One camera's lens and sensor (sections left_camera, right_camera).
struct SimulatedCameraParameters {
  double fx = 554.26, fy = 554.26;
  double cx = 319.5, cy = 239.5;
  SimulatedLens lens = SimulatedLens::kPlumbBob;
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0, k4 = 0;
  double gain = 1.0;
  double offset = 0.0;
  double clock_drift = 0, clock_drift_start = 0;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("fx", fx, 10.0, 1e5, "px", "focal length along the rows");
    v.number("fy", fy, 10.0, 1e5, "px", "focal length along the columns");
    v.number("cx", cx, 0.0, 4096.0, "px", "column of the principal point; the first pixel's centre is 0");
    v.number("cy", cy, 0.0, 4096.0, "px", "row of the principal point");
    v.choice("lens", lens, {"plumb_bob", "equidistant"},
             "distortion model: that of usual lenses, or that of fisheye lenses, which has k1 to k4 alone");
    v.number("k1", k1, -1.0, 1.0, "", "radial distortion");
    v.number("k2", k2, -2.0, 2.0, "", "radial distortion");
    v.number("p1", p1, -0.1, 0.1, "", "tangential distortion");
    v.number("p2", p2, -0.1, 0.1, "", "tangential distortion");
    v.number("k3", k3, -2.0, 2.0, "", "radial distortion");
    v.number("k4", k4, -2.0, 2.0, "", "radial distortion of the lens equidistant");
    v.number("gain", gain, 0.1, 10.0, "", "grey level = gain x scene + offset");
    v.number("offset", offset, -200.0, 200.0, "grey levels", "see gain");
    v.number("clock_drift", clock_drift, -0.1, 0.1, "s/s",
             "by which its exposures get later than their stamps; 0: the clocks of both cameras go alike");
    v.number("clock_drift_start", clock_drift_start, 0.0, 3600.0, "s",
             "since the start of the sequence, until which they go alike");
  }
};

/// Position of the right camera in the left camera's axes (x right, y down, z forward) (section rig).
struct SimulatedRigParameters {
  double x = 1.0, y = 0, z = 0;
  double rx_deg = 0, ry_deg = 0, rz_deg = 0;
  double bend_rx_deg = 0, bend_ry_deg = 0, bend_rz_deg = 0;
  double stretch = 0;
  double lens_rows = 0, lens_tilt_deg = 0;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("x", x, 0.001, 100.0, "m", "the right camera's centre to the right of the left one");
    v.number("y", y, -10.0, 10.0, "m", "below it");
    v.number("z", z, -10.0, 10.0, "m", "in front of it");
    v.number("rx_deg", rx_deg, -20.0, 20.0, "deg",
             "rotation vector of the right camera's axes against the left one's, component along x");
    v.number("ry_deg", ry_deg, -20.0, 20.0, "deg", "component along y");
    v.number("rz_deg", rz_deg, -20.0, 20.0, "deg", "component along z");
    v.number(
        "bend_rx_deg", bend_rx_deg, -2.0, 2.0, "deg",
        "rotation vector by which the right camera has turned since the calibration, which does not know "
        "of it; in rectified axes, component along x");
    v.number("bend_ry_deg", bend_ry_deg, -2.0, 2.0, "deg", "component along y");
    v.number("bend_rz_deg", bend_rz_deg, -2.0, 2.0, "deg", "component along z");
    v.number("stretch", stretch, -0.5, 0.5, "of the baseline",
             "by which the real baseline is longer than the calibration says");
    v.number("lens_rows", lens_rows, -10.0, 10.0, "px",
             "by which the right camera's image lies lower than the calibration of its lens says");
    v.number("lens_tilt_deg", lens_tilt_deg, -2.0, 2.0, "deg",
             "by which its rows are inclined, and its columns are not, without the calibration knowing");
  }
};

/// The runway and its markings, which are the same at both ends (section runway). A marking with a length,
/// count or width of 0 does not exist.
struct SimulatedRunwayParameters {
  double length = 1500, width = 45;
  double displaced_threshold = 0;
  double edge_line_width = 0.9, edge_line_inset = 0.5;
  double centre_line_width = 0.9, centre_dash_length = 30, centre_gap_length = 20, centre_line_start = 60;
  double threshold_line_width = 1.2;
  int threshold_bars = 6;
  double threshold_bar_length = 30, threshold_bar_width = 1.75, threshold_bar_gap = 1.75;
  double threshold_centre_gap = 3.5, threshold_bars_start = 6;
  double aiming_point_distance = 300, aiming_point_length = 45, aiming_point_width = 6, aiming_point_gap = 18;
  double tyre_marks = 0.35;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("length", length, 0.1, 1e5, "m", "from threshold to threshold");
    v.number("width", width, 0.01, 1000.0, "m", "of the surface");
    v.number(
        "displaced_threshold", displaced_threshold, 0.0, 2000.0, "m",
        "of surface before the threshold and beyond the other one, not for landing; its middle is marked "
        "by the shafts of arrows");
    v.number("edge_line_width", edge_line_width, 0.0, 10.0, "m", "of the line along each side");
    v.number("edge_line_inset", edge_line_inset, 0.0, 100.0, "m", "from the surface's edge to the line");
    v.number("centre_line_width", centre_line_width, 0.0, 10.0, "m", "of the dashed centre line");
    v.number("centre_dash_length", centre_dash_length, 0.001, 1000.0, "m", "of one dash");
    v.number("centre_gap_length", centre_gap_length, 0.0, 1000.0, "m", "between two dashes");
    v.number("centre_line_start", centre_line_start, 0.0, 1e4, "m", "from the threshold to the first dash");
    v.number("threshold_line_width", threshold_line_width, 0.0, 10.0, "m",
             "of the line across the threshold");
    v.number("threshold_bars", threshold_bars, 0, 50, "bars",
             "zebra at the threshold, on each side of the middle");
    v.number("threshold_bar_length", threshold_bar_length, 0.0, 200.0, "m", "of each bar");
    v.number("threshold_bar_width", threshold_bar_width, 0.0, 20.0, "m", "of each bar");
    v.number("threshold_bar_gap", threshold_bar_gap, 0.0, 20.0, "m", "between two bars");
    v.number("threshold_centre_gap", threshold_centre_gap, 0.0, 50.0, "m",
             "between the two bars in the middle");
    v.number("threshold_bars_start", threshold_bars_start, 0.0, 1000.0, "m",
             "from the threshold to the bars");
    v.number("aiming_point_distance", aiming_point_distance, 0.0, 1e4, "m",
             "from the threshold to the two broad stripes; tyre marks lie around them");
    v.number("aiming_point_length", aiming_point_length, 0.0, 200.0, "m", "of each stripe");
    v.number("aiming_point_width", aiming_point_width, 0.0, 50.0, "m", "of each stripe");
    v.number("aiming_point_gap", aiming_point_gap, 0.0, 100.0, "m", "between the two stripes");
    v.number("tyre_marks", tyre_marks, 0.0, 1.0, "", "share of light that the darkest tyre marks take away");
  }
};

/// Brightness and texture of all surfaces (section surface).
struct SimulatedSurfaceParameters {
  double runway_brightness = 70, runway_contrast = 0.1, runway_grain = 0.02;
  double grass_brightness = 105, grass_contrast = 0.14, grass_grain = 0.03;
  double marking_brightness = 205;
  double visibility = 8000;
  double sky_horizon = 165, sky_zenith = 120, cloud_contrast = 25;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("runway_brightness", runway_brightness, 0.0, 255.0, "grey levels",
             "mean of the runway's surface");
    v.number("runway_contrast", runway_contrast, 0.0, 1.0, "of brightness",
             "1 sigma of each scale of its texture");
    v.number("runway_grain", runway_grain, 1e-4, 10.0, "m", "smallest detail of its texture");
    v.number("grass_brightness", grass_brightness, 0.0, 255.0, "grey levels", "mean of the ground beside it");
    v.number("grass_contrast", grass_contrast, 0.0, 1.0, "of brightness",
             "1 sigma of each scale of its texture");
    v.number("grass_grain", grass_grain, 1e-4, 10.0, "m", "smallest detail of its texture");
    v.number("marking_brightness", marking_brightness, 0.0, 255.0, "grey levels", "mean of what is painted");
    v.number("visibility", visibility, 1.0, 1e6, "m",
             "distance at which haze has taken 63 % of the contrast");
    v.number("sky_horizon", sky_horizon, 0.0, 255.0, "grey levels", "sky just above the horizon, and haze");
    v.number("sky_zenith", sky_zenith, 0.0, 255.0, "grey levels", "sky overhead");
    v.number("cloud_contrast", cloud_contrast, 0.0, 100.0, "grey levels", "1 sigma of the clouds");
  }
};

/// The ground's height along the runway, z(x) (section profile). A straight slope, a parabola and another
/// straight slope follow each other, with a hill on them. The height is the same all across, and 0 at the
/// threshold.
struct SimulatedProfileParameters {
  double slope_before_deg = 0, slope_after_deg = 0;
  double change_start = 0, change_length = 0;
  double hill_height = 0, hill_x = -400, hill_length = 400;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("slope_before_deg", slope_before_deg, -5.0, 5.0, "deg",
             "rise of the ground in the landing direction before the change of slope");
    v.number("slope_after_deg", slope_after_deg, -5.0, 5.0, "deg", "and after it");
    v.number("change_start", change_start, -1e5, 1e5, "m",
             "along the runway from the threshold; negative: before it");
    v.number("change_length", change_length, 0.0, 1e5, "m", "over which the slope changes at a steady rate");
    v.number("hill_height", hill_height, 0.0, 500.0, "m", "of a hill across the path; 0: no hill");
    v.number("hill_x", hill_x, -1e5, 1e5, "m", "of its top, along the runway from the threshold");
    v.number("hill_length", hill_length, 10.0, 1e5, "m", "from its foot to its other foot");
  }
};

/// Boxes and poles that stand above the ground beside the runway (section objects).
struct SimulatedObjectsParameters {
  int boxes = 0;
  double box_size = 8;
  int poles = 0;
  double pole_height = 3, pole_width = 0.15;
  double clearance = 10, band = 60;
  double first = 0, last = 600;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("boxes", boxes, 0, 1000, "", "buildings and vehicles at random places on both sides");
    v.number("box_size", box_size, 0.01, 200.0, "m", "largest length, width and height of a box");
    v.number("poles", poles, 0, 1000, "", "masts at random places on both sides");
    v.number("pole_height", pole_height, 0.01, 200.0, "m", "largest height of a pole");
    v.number("pole_width", pole_width, 0.001, 10.0, "m", "its thickness");
    v.number("clearance", clearance, 0.0, 1000.0, "m", "from the runway's edge to where they may begin");
    v.number("band", band, 0.0, 1e4, "m", "and how far beyond that they may stand");
    v.number("first", first, -1e4, 1e5, "m", "nearest to the aircraft, along the runway from the threshold");
    v.number("last", last, -1e4, 1e5, "m", "farthest, along the runway from the threshold");
  }
};

/// Lamps of the runway, which show as points (section lights). Lamps that are left out have a size of 0.
struct SimulatedLightsParameters {
  double edge_spacing = 0;
  double approach_length = 0;
  double papi_angle_deg = 0;
  double brightness = 5000;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("edge_spacing", edge_spacing, 0.0, 1000.0, "m",
             "between lamps along the edges, with rows of lamps across both ends; 0: no edge lights");
    v.number("approach_length", approach_length, 0.0, 2000.0, "m",
             "of the approach lights before the threshold, a bar every 30 m; 0: none");
    v.number("papi_angle_deg", papi_angle_deg, 0.0, 10.0, "deg",
             "of the glide path that four PAPI units beside the aiming point show; 0: no PAPI");
    v.number("brightness", brightness, 0.0, 1e7, "grey levels m^2",
             "of a lamp: it is as bright as a surface of 1 m^2 with this grey level");
  }
};

/// The path of the left camera and its mean attitude (section path).
struct SimulatedPathParameters {
  double duration = 34;
  double rate = 20;
  double start_height = 40, start_x = -330, start_y = 0;
  double speed = 20;
  double glide_angle_deg = 3.5;
  double track_deg = 0;
  double flare_height = 5, flare_duration = 3, flare_angle_deg = 0.8, flare_pitch_deg = 2;
  double pitch_deg = -4, roll_deg = 0, yaw_deg = 0;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("duration", duration, 0.0, 3600.0, "s", "of the sequence");
    v.number("rate", rate, 0.1, 1000.0, "Hz", "pairs per second");
    v.number("start_height", start_height, 0.01, 1e4, "m", "above the runway at the start");
    v.number("start_x", start_x, -1e5, 1e5, "m", "along the runway from the threshold; negative: before it");
    v.number("start_y", start_y, -1000.0, 1000.0, "m", "left of the centre line");
    v.number("speed", speed, 0.0, 200.0, "m/s", "along the path");
    v.number("glide_angle_deg", glide_angle_deg, -30.0, 45.0, "deg", "of the path below the horizontal");
    v.number("track_deg", track_deg, -45.0, 45.0, "deg",
             "direction of the path left of the landing direction");
    v.number("flare_height", flare_height, 0.0, 1000.0, "m", "at which the flare begins; 0: no flare");
    v.number("flare_duration", flare_duration, 0.1, 60.0, "s",
             "over which the angle changes at a steady rate");
    v.number("flare_angle_deg", flare_angle_deg, -30.0, 45.0, "deg", "angle of the path after the flare");
    v.number("flare_pitch_deg", flare_pitch_deg, -30.0, 30.0, "deg",
             "by which the nose comes up in the flare");
    v.number("pitch_deg", pitch_deg, -60.0, 60.0, "deg",
             "optical axis above the horizontal; negative: looks down");
    v.number("roll_deg", roll_deg, -60.0, 60.0, "deg", "right side down");
    v.number("yaw_deg", yaw_deg, -60.0, 60.0, "deg", "optical axis left of the landing direction (crab)");
  }
};

/// Disturbances of the path and the attitude (section wobble). Each is a sum of two sines with random phases.
/// One has the period. The other one is 2.7 times as fast and 0.4 times as large.
struct SimulatedWobbleParameters {
  double roll_deg = 3, roll_period = 4;
  double pitch_deg = 0.7, pitch_period = 3;
  double yaw_deg = 1, yaw_period = 5;
  double sway = 0.3, sway_period = 9;
  double heave = 0.05, heave_period = 3.5;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("roll_deg", roll_deg, 0.0, 30.0, "deg", "amplitude of the roll");
    v.number("roll_period", roll_period, 0.1, 1000.0, "s", "its period");
    v.number("pitch_deg", pitch_deg, 0.0, 30.0, "deg", "amplitude of the pitch");
    v.number("pitch_period", pitch_period, 0.1, 1000.0, "s", "its period");
    v.number("yaw_deg", yaw_deg, 0.0, 30.0, "deg", "amplitude of the yaw");
    v.number("yaw_period", yaw_period, 0.1, 1000.0, "s", "its period");
    v.number("sway", sway, 0.0, 100.0, "m", "amplitude of the path to the sides");
    v.number("sway_period", sway_period, 0.1, 1000.0, "s", "its period");
    v.number("heave", heave, 0.0, 100.0, "m", "amplitude of the path up and down (gusts)");
    v.number("heave_period", heave_period, 0.1, 1000.0, "s", "its period");
  }
};

/// One vertical gust in the shape 1 - cos, as certification rules have it (section gust).
struct SimulatedGustParameters {
  double speed = 0, start = 0, duration = 1;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("speed", speed, -50.0, 50.0, "m/s",
             "by which the aircraft sinks faster at the gust's peak; negative: slower");
    v.number("start", start, 0.0, 3600.0, "s", "since the start of the sequence");
    v.number("duration", duration, 0.05, 600.0, "s", "from nothing to the peak and back");
  }
};

/// Vibration of the whole rig about the left camera: one sine about each axis, with random phases (section
/// vibration). The true attitude and the inertial sensor contain it.
struct SimulatedVibrationParameters {
  double frequency = 50;
  double roll_deg = 0, pitch_deg = 0, yaw_deg = 0;
  double start = 0;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("frequency", frequency, 0.1, 1000.0, "Hz", "of the vibration");
    v.number("roll_deg", roll_deg, 0.0, 10.0, "deg", "amplitude of the roll");
    v.number("pitch_deg", pitch_deg, 0.0, 10.0, "deg", "amplitude of the pitch");
    v.number("yaw_deg", yaw_deg, 0.0, 10.0, "deg", "amplitude of the yaw");
    v.number("start", start, 0.0, 3600.0, "s",
             "since the start of the sequence; it grows over one period; 0: there all the time");
  }
};

/// An inertial sensor on the rig and its errors (section imu).
struct SimulatedImuParameters {
  double rate = 0;
  double delay = 0;
  double pitch_error_deg = 0, roll_error_deg = 0;
  double attitude_noise_deg = 0.05;
  double gyro_bias_x_deg = 0, gyro_bias_y_deg = 0, gyro_bias_z_deg = 0;
  double gyro_noise_deg = 0.1;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("rate", rate, 0.0, 2000.0, "Hz", "messages per second; 0: no inertial sensor");
    v.number("delay", delay, -1.0, 1.0, "s", "by which its stamps are late");
    v.number("pitch_error_deg", pitch_error_deg, -20.0, 20.0, "deg",
             "constant error of its pitch, its mounting's included; positive: says nose up");
    v.number("roll_error_deg", roll_error_deg, -20.0, 20.0, "deg",
             "constant error of its roll; positive: says right side down");
    v.number("attitude_noise_deg", attitude_noise_deg, 0.0, 20.0, "deg",
             "1 sigma of each message's attitude");
    v.number("gyro_bias_x_deg", gyro_bias_x_deg, -20.0, 20.0, "deg/s",
             "constant error of the angular velocity about its forward axis");
    v.number("gyro_bias_y_deg", gyro_bias_y_deg, -20.0, 20.0, "deg/s", "about its left axis");
    v.number("gyro_bias_z_deg", gyro_bias_z_deg, -20.0, 20.0, "deg/s", "about its up axis");
    v.number("gyro_noise_deg", gyro_noise_deg, 0.0, 20.0, "deg/s",
             "1 sigma of each message's angular velocity");
  }
};

/// Makes runs differ from each other (section random).
struct SimulatedRandomParameters {
  int seed = 1;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("seed", seed, 0, 1000000000, "", "of textures, objects, phases and noise");
  }
};

/// One parameter set for a simulated approach. Each member is a section of config/simulator/*.yaml.
struct SimulatorParameters {
  SimulatedImageParameters image;
  SimulatedCameraParameters left_camera, right_camera;
  SimulatedRigParameters rig;
  SimulatedRunwayParameters runway;
  SimulatedSurfaceParameters surface;
  SimulatedProfileParameters profile;
  SimulatedObjectsParameters objects;
  SimulatedLightsParameters lights;
  SimulatedSceneryParameters scenery;  ///< each of its elements is a section
  SimulatedPathParameters path;
  SimulatedWobbleParameters wobble;
  SimulatedGustParameters gust;
  SimulatedVibrationParameters vibration;
  SimulatedImuParameters imu;
  SimulatedRandomParameters random;

  /// Sets the size of the images and the focal length of both cameras, px, with the principal points in the
  /// middle.
  void setPictures(int width, int height, double f) {
    image.width = width;
    image.height = height;
    for (SimulatedCameraParameters* camera : {&left_camera, &right_camera}) {
      camera->fx = camera->fy = f;
      camera->cx = 0.5 * (width - 1);
      camera->cy = 0.5 * (height - 1);
    }
  }

  /// Calls v(section name, parameter struct) for every section.
  template <class Visitor>
  void visitSections(Visitor&& v) {
    v("image", image);
    v("left_camera", left_camera);
    v("right_camera", right_camera);
    v("rig", rig);
    v("runway", runway);
    v("surface", surface);
    v("profile", profile);
    v("objects", objects);
    v("lights", lights);
    scenery.visitSections(v);
    v("path", path);
    v("wobble", wobble);
    v("gust", gust);
    v("vibration", vibration);
    v("imu", imu);
    v("random", random);
  }
};

}  // namespace uav_landing
