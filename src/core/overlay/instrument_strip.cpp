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
constexpr int kWidth = 640, kHeight = 80, kMargin = 10;  // the strip in its own units
constexpr double kLabelFont = 0.34, kValueFont = 0.5, kStatusFont = 0.42;
constexpr int kLabelRow = 14, kValueRow = 34, kStatusRow = 54, kReasonRow = 72;

const cv::Scalar kGreen(90, 220, 90), kAmber(40, 180, 255), kRed(105, 105, 255);

std::string formatted(const char* format, double value) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

/// With a fixed number of decimals, so that a changing number keeps its width; zero has no sign.
std::string withDecimals(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  const double unit = std::pow(10, -decimals);
  const std::string format = "%." + std::to_string(decimals) + "f";
  return formatted(format.c_str(), std::round(value / unit) == 0 ? 0 : value);
}

/// "12.01 +-0.05 deg", as OpenCV's font has neither the sign nor the degree. A deviation is never shown as
/// zero.
std::string withDeviation(double value, double variance, int decimals, const char* unit) {
  if (!std::isfinite(value)) return "-";
  const double deviation = std::max(std::sqrt(variance), std::pow(10, -decimals));
  return withDecimals(value, decimals) + " +-" + withDecimals(deviation, decimals) + " " + unit;
}

/// Four digits, at most millimetres.
int heightDecimals(double height) { return std::abs(height) < 10 ? 3 : std::abs(height) < 100 ? 2 : 1; }

struct Instrument {
  int column;  ///< units
  std::string name, value;
  bool valid = true;
  bool marked = false;  ///< its own text says that it is not valid
};

std::array<Instrument, 6> instruments(const LandingResult& landing) {
  const std::string sink_rate = withDecimals(-landing.vertical_speed, 2);
  return {{
      {kMargin, "HEIGHT",
       withDeviation(landing.height, landing.height_variance, heightDecimals(landing.height), "m"),
       landing.height_valid, true},
      {174, "SINK RATE", sink_rate == "-" ? sink_rate : sink_rate + " m/s", landing.height_valid},
      {274, "APPROACH ANGLE",
       withDeviation(landing.approach_angle * kDegrees, landing.approach_angle_variance * kDegrees * kDegrees,
                     2, "deg"),
       landing.angle_valid, true},
      {448, "PITCH", withDecimals(landing.pitch * kDegrees, 1)},
      {508, "ROLL", withDecimals(landing.roll * kDegrees, 1)},
      {570, "YAW", withDecimals(landing.yaw * kDegrees, 1)},
  }};
}

cv::Scalar statusColour(const LandingResult& landing) {
  if (!landing.valid()) return kRed;
  return landing.status == Status::kTracking ? kGreen : kAmber;
}

/// "tracking", "HEIGHT NOT VALID, tracking: uncertain: height 18.96 m has ...".
std::string statusAndReason(const LandingResult& landing) {
  std::string line;
  if (!landing.valid()) {
    if (landing.angle_valid) line += "HEIGHT ";
    if (landing.height_valid) line += "ANGLE ";
    line += "NOT VALID, ";
  }
  line += toString(landing.status);
  if (landing.failure) line += ": " + landing.failure.message();
  return line;
}

/// "PROTECTION LEVEL 0.07 of 0.60 m".
std::string protectionLevel(const LandingResult& landing) {
  if (!std::isfinite(landing.height_protection_level)) return "PROTECTION LEVEL -";
  return "PROTECTION LEVEL " + formatted("%.2f", landing.height_protection_level) + " of " +
         formatted("%.2f m", landing.height_alert_limit);
}

/// Number of characters that fit into so many units, in whole words if there are any.
size_t fitting(const std::string& text, int room) {
  size_t count = text.size();
  while (count > 0 && textWidth(text.substr(0, count), kStatusFont) > room) --count;
  if (count == text.size()) return count;
  const size_t space = text.rfind(' ', count);
  return space == std::string::npos || space == 0 ? count : space;
}

/// Breaks the text at a word, and cuts it at a word if it is still longer. Smaller letters could not be read.
std::array<std::string, 2> twoLines(const std::string& text, int first_room, int second_room) {
  const size_t first = fitting(text, first_room);
  std::string rest = text.substr(first);
  rest.erase(0, rest.find_first_not_of(' '));
  const std::string more = " ...";
  if (fitting(rest, second_room) < rest.size())
    rest = rest.substr(0, fitting(rest, second_room - textWidth(more, kStatusFont))) + more;
  return {text.substr(0, first), rest};
}

/// Draws in units, whatever the size of the strip.
class Strip {
 public:
  explicit Strip(int width) : unit_(static_cast<double>(width) / kWidth) {
    picture_.create(pixels(kHeight), width, CV_8UC3);
    picture_ = colour::kPanel;
  }

  void text(int column, int row, const std::string& what, double font_scale, const cv::Scalar& colour) {
    drawText(picture_, {pixels(column), pixels(row)}, what, font_scale * unit_, colour);
  }

  void draw(const Instrument& instrument) {
    text(instrument.column, kLabelRow, instrument.name, kLabelFont, colour::kLabel);
    text(instrument.column, kValueRow, instrument.value, kValueFont, instrument.valid ? colour::kText : kRed);
    if (instrument.marked && !instrument.valid)
      notValid(instrument.column + textWidth(instrument.name, kLabelFont) + 6);
  }

  const cv::Mat& picture() const { return picture_; }

 private:
  int pixels(double units) const { return static_cast<int>(std::lround(units * unit_)); }

  void notValid(int column) {
    const std::string words = "NOT VALID";
    constexpr int kPadding = 4;
    const cv::Point corner(pixels(column), pixels(kLabelRow - 11));
    const cv::Point opposite(pixels(column + textWidth(words, kLabelFont) + 2 * kPadding),
                             pixels(kLabelRow + 3));
    cv::rectangle(picture_, corner, opposite, kRed, cv::FILLED);
    text(column + kPadding, kLabelRow, words, kLabelFont, colour::kPanel);
  }

  cv::Mat picture_;
  double unit_;  // pixels
};

}  // namespace

cv::Mat drawInstrumentStrip(const LandingResult& landing, int width) {
  Strip strip(width);
  for (const Instrument& instrument : instruments(landing)) strip.draw(instrument);

  const std::string level = protectionLevel(landing);
  const int level_width = textWidth(level, kLabelFont);
  strip.text(kWidth - kMargin - level_width, kStatusRow, level, kLabelFont,
             landing.height_protection_level > landing.height_alert_limit ? kAmber : colour::kLabel);

  const std::string line = statusAndReason(landing);
  const int room = kWidth - 2 * kMargin;
  const std::array<std::string, 2> lines = twoLines(line, room - kMargin - level_width, room);
  strip.text(kMargin, kStatusRow, lines[0], kStatusFont, statusColour(landing));
  strip.text(kMargin, kReasonRow, lines[1], kStatusFont, statusColour(landing));
  return strip.picture();
}

}  // namespace uav_landing
