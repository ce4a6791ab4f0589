#pragma once

#include <ros/node_handle.h>

#include <string>

#include "uav_landing/parameters/parameter_file.h"

namespace uav_landing {

/// Parameters that concern only ROS and are therefore not in config/*.yaml. Every nodelet accepts all of
/// them, so that one set serves all; each reads those that it needs. No section has a key of the same name.
/// visit(): as in uav_landing/parameters/parameters.h, with text() for strings.
struct NodeParameters {
  std::string camera = "/stereo";
  std::string left_image, left_info, right_image, right_info;
  std::string image_transport = "raw";
  std::string imu = "/imu/data";
  bool drop_frames = true;
  int backlog = 1000;
  std::string config_file;
  std::string base_frame;
  std::string runway_frame = "runway";
  bool publish_tf = true;
  double drawn_runway_width = 30.0;
  double drawn_runway_length = 600.0;
  double ellipsoid_scale = 10.0;
  double complaint_period = 5.0;
  double diagnostic_period = 1.0;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.text("camera", camera,
           "namespace of the cameras: left/image_raw, left/camera_info, right/... (rectify)");
    v.text("left_image", left_image,
           "topic of the left raw image; empty: left/image_raw of camera (rectify)");
    v.text("left_info", left_info, "topic of its camera_info; empty: left/camera_info of camera (rectify)");
    v.text("right_image", right_image,
           "topic of the right raw image; empty: right/image_raw of camera (rectify)");
    v.text("right_info", right_info,
           "topic of its camera_info; empty: right/camera_info of camera (rectify)");
    v.text("image_transport", image_transport, "transport of the raw images: raw, compressed ... (rectify)");
    v.text("imu", imu,
           "topic of an inertial sensor (sensor_msgs/Imu), used when somebody publishes it; empty: none "
           "(approach_angle)");
    v.flag("drop_frames", drop_frames,
           "when behind, serve the newest pair and count the ones left out; else process all in order "
           "(rectify; approach_angle then waits longer for the imu)");
    v.number("backlog", backlog, 1, 100000, "pairs", "most that wait when drop_frames is false (rectify)");
    v.text(
        "config_file", config_file,
        "file that the launch file loaded the parameters from; it is checked as a whole, because a section "
        "that no nodelet has would go unnoticed. Files that rig/left_mask and rig/right_mask name are "
        "relative to "
        "its folder");
    v.text("base_frame", base_frame,
           "frame of the aircraft (x forward, y left, z up) that is estimated; empty: base_link if static tf "
           "knows it, else the rectified left camera (kalman_height)");
    v.text("runway_frame", runway_frame, "frame of the estimate (kalman_height)");
    v.flag("publish_tf", publish_tf,
           "broadcast runway_frame to the estimated frame; if not, the chain rests while nobody subscribes "
           "its output (kalman_height)");
    v.number("drawn_runway_width", drawn_runway_width, 0.1, 200.0, "m",
             "width of the runway as drawn until it has been measured; where runway/width is given, that is "
             "the default (kalman_height markers)");
    v.number(
        "drawn_runway_length", drawn_runway_length, 0.1, 10000.0, "m",
        "length of the runway as drawn; where runway/length is given, that is the default (kalman_height "
        "markers)");
    v.number(
        "ellipsoid_scale", ellipsoid_scale, 1.0, 1000.0, "",
        "the ellipsoid of three sigma is drawn larger by this factor: centimetres are too small to be seen "
        "over a runway (kalman_height markers)");
    v.number("complaint_period", complaint_period, 0.1, 3600.0, "s",
             "without a pair for this long the nodelet says which input is missing");
    v.number("diagnostic_period", diagnostic_period, 0.1, 3600.0, "s", "between two diagnostics messages");
  }
};

/// Reads a nodelet's private parameters: the keys of NodeParameters, and those of the section (see
/// uav_landing/parameters/parameters.h). Parameters that are not given keep their defaults. A failure names
/// the parameter, or says what is wrong with the config_file.
template <class Section>
Failure loadParameters(const ros::NodeHandle& private_handle, const std::string& section, Section& parameters,
                       NodeParameters& node_parameters);

/// Makes the paths of files in the shared parameters absolute: a relative one begins at the folder of the
/// config_file. Without a config_file a relative path is refused, because it would begin at the manager's
/// folder.
Failure resolveFiles(const NodeParameters& node_parameters, RigParameters& parameters);

/// Reads the parameters rig/* and runway/* that all nodelets of a namespace share. Defaults and failure as
/// for loadParameters().
Failure loadSharedParameters(const ros::NodeHandle& handle, SharedParameters& parameters);

}  // namespace uav_landing
