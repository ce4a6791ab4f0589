#pragma once

namespace uav_landing {

/// The stripes along a runway's edges, from what is known beforehand.
struct EdgeStripes {
  double width;     ///< m: the least that the standard allows
  double contrast;  ///< of paint against the surface, grey levels
  double spread;    ///< 1 sigma of that contrast, as a share of it
  double share;     ///< of the runways of this width that have stripes

  double amplitude() const { return width * contrast; }  ///< m x grey levels
};

/// The standard asks for side stripes on precision approach runways, which are broad ones: at least 0.9 m
/// wide from 30 m on, and 0.45 m on narrower runways (ICAO Annex 14, 5.2.7). Which narrow runways have some,
/// nobody knows. runway_width: m.
inline EdgeStripes usualStripes(double runway_width) {
  return runway_width >= 30 ? EdgeStripes{0.9, 95, 0.44, 0.8} : EdgeStripes{0.45, 95, 0.44, 0.5};
}

/// Grey level in the middle of a blurred stripe. amplitude: its width times its contrast, m x grey levels.
/// scale: px a metre.
inline double shownStripe(double amplitude, double scale) {
  constexpr double kLeft = 0.4;  // by the blur of the image
  return kLeft * (amplitude < 0 ? -amplitude : amplitude) * scale;
}

}  // namespace uav_landing
