#pragma once

#include "uav_landing/parameters/rig_parameters.h"
#include "uav_landing/parameters/runway_parameters.h"

namespace uav_landing {

/// Parameters that several stages read. Each member is a section of its own in config/*.yaml, beside those of
/// the stages.
struct SharedParameters {
  RigParameters rig;
  RunwayParameters runway;

  /// Calls v(section name, parameter struct) for every section.
  template <class Visitor>
  void visitSections(Visitor&& v) {
    v("rig", rig);
    v("runway", runway);
  }
};

}  // namespace uav_landing
