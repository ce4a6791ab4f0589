#pragma once

#include "uav_landing/parameters/approach_angle_parameters.h"
#include "uav_landing/parameters/kalman_height_parameters.h"
#include "uav_landing/parameters/overlay_parameters.h"
#include "uav_landing/parameters/rectify_parameters.h"
#include "uav_landing/parameters/shared_parameters.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"

namespace uav_landing {

// Every parameter of the project is defined once, in the headers above, with its name, default, range, unit
// and meaning. The code reads the struct. YAML loading, the ROS parameter server, the range check and
// docs/parameters.md are made from visit(). A visitor has these functions:
//   number(name, value, min, max, unit, meaning) for int and double,
//   flag(name, value, meaning) for bool,
//   text(name, value, meaning) for strings,
//   choice(name, enum value, {names in enum order}, meaning).

/// One parameter set for the whole chain: what the stages share, and what each one has of its own. Each
/// member is a section of config/*.yaml.
struct Parameters : SharedParameters {
  RectifyParameters rectify;
  StereoDepthParameters stereo_depth;
  ApproachAngleParameters approach_angle;
  KalmanHeightParameters kalman_height;
  OverlayParameters overlay;

  /// Calls v(section name, parameter struct) for every section.
  template <class Visitor>
  void visitSections(Visitor&& v) {
    SharedParameters::visitSections(v);
    v("rectify", rectify);
    v("stereo_depth", stereo_depth);
    v("approach_angle", approach_angle);
    v("kalman_height", kalman_height);
    v("overlay", overlay);
  }
};

}  // namespace uav_landing
