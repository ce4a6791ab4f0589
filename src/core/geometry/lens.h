#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace uav_landing {

/// Whether a lens with these coefficients distorts. With all coefficients 0 it does not, whatever the model's
/// name.
inline bool isDistorted(const std::vector<double>& D) {
  return std::any_of(D.begin(), D.end(), [](double coefficient) { return coefficient != 0; });
}

/// Whether the distortion is that of a fisheye lens: an odd polynomial of the angle off the axis, with four
/// coefficients (Kannala, Brandt 2006; cv::fisheye).
inline bool isFisheye(const std::string& distortion_model, const std::vector<double>& D) {
  return (distortion_model == "equidistant" || distortion_model == "fisheye") && isDistorted(D);
}

}  // namespace uav_landing
