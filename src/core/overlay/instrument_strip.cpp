#include "overlay/instrument_strip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <string>

#include "overlay/overlay_canvas.h"

namespace uav_landing {
namespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;

struct Instrument {
  std::string name, value;
  cv::Scalar colour;
};

std::string formatted(const char* format, double value) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

/// "12.01 +-0.05 deg"; OpenCV's font has neither the sign nor the degree.
std::string withDeviation(const char* format, double value, double variance, const char* unit) {
  if (!std::isfinite(value)) return "-";
  return formatted(format, value) + " +-" + formatted("%.2g", std::sqrt(variance)) + " " + unit;
}

std::array<Instrument, 4> instruments(const LandingResult& landing) {
  const auto usable = [](bool valid) { return valid ? colour::kText : colour::kDim; };
  return {{
      {"HEIGHT", withDeviation("%.3f", landing.height, landing.height_variance, "m"),
       usable(landing.height_valid)},
      {"SINK RATE", formatted("%.2f m/s", -landing.vertical_speed), usable(landing.height_valid)},
      {"APPROACH ANGLE",
       withDeviation("%.2f", landing.approach_angle * kDegrees,
                     landing.approach_angle_variance * kDegrees * kDegrees, "deg"),
       usable(landing.angle_valid)},
      {"PITCH  ROLL  YAW",
       formatted("%.1f", landing.pitch * kDegrees) + "  " + formatted("%.1f", landing.roll * kDegrees) +
           "  " + formatted("%.1f", landing.yaw * kDegrees),
       colour::kText},
  }};
}

const cv::Scalar kGreen(90, 220, 90), kAmber(40, 180, 255), kRed(70, 70, 255);

cv::Scalar statusColour(const LandingResult& landing) {
  if (landing.status == Status::kTracking) return landing.valid() ? kGreen : kAmber;
  return landing.status == Status::kLost ? kRed : kAmber;
}

/// "PROTECTION LEVEL 0.07 of 0.60 m".
std::string protectionLevel(const LandingResult& landing) {
  if (!std::isfinite(landing.height_protection_level)) return "PROTECTION LEVEL -";
  return "PROTECTION LEVEL " + formatted("%.2f", landing.height_protection_level) + " of " +
         formatted("%.2f m", landing.height_alert_limit);
}

}  // namespace

cv::Mat drawInstrumentStrip(const LandingResult& landing, int width) {
  const double unit = width / 640.0;  // everything in proportion to a strip 640 pixels wide
  const auto pixels = [unit](double value) { return static_cast<int>(std::lround(value * unit)); };
  cv::Mat strip(pixels(62), width, CV_8UC3, colour::kPanel);

  const std::array<double, 4> columns = {10, 204, 308, 482};
  const std::array<Instrument, 4> all = instruments(landing);
  for (size_t i = 0; i < all.size(); ++i) {
    drawText(strip, {pixels(columns[i]), pixels(14)}, all[i].name, 0.34 * unit, colour::kLabel);
    drawText(strip, {pixels(columns[i]), pixels(34)}, all[i].value, 0.5 * unit, all[i].colour);
  }

  std::string status = toString(landing.status);
  if (landing.failure) status += ": " + landing.failure.message();
  const std::string level = protectionLevel(landing);
  const int level_width = textWidth(level, 0.34 * unit);
  drawText(strip, {width - pixels(10) - level_width, pixels(54)}, level, 0.34 * unit,
           landing.height_protection_level > landing.height_alert_limit ? kAmber : colour::kLabel);

  const double room = width - pixels(30) - level_width;
  const double font_scale =
      std::min(0.42 * unit, 0.42 * unit * room / std::max(1, textWidth(status, 0.42 * unit)));
  drawText(strip, {pixels(10), pixels(54)}, status, font_scale, statusColour(landing));
  return strip;
}

}  // namespace uav_landing
