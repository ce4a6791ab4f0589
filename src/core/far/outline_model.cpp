#include "far/outline_model.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace uav_landing {
namespace {

// Markings, m: stripe inside of the edge, bars behind the threshold.
constexpr double kStripePlace = 1.0, kBarsBegin = 6, kBarsEnd = 36;
constexpr double kMarksAcross = 15;  // m, 1 sigma by which bars and a line across at an end move the side
constexpr double kShortestRunway = 400, kLongestRunway = 5000;  // m

/// A blurred edge and its slope, by linear interpolation: both of a distance in standard deviations.
class BlurTable {
 public:
  BlurTable() {
    for (int i = 0; i <= kSteps; ++i) {
      const double t = kReach * (2.0 * i / kSteps - 1);
      bell_[i] = std::exp(-0.5 * t * t) / std::sqrt(2 * M_PI);
      share_[i] = 0.5 * std::erfc(-t * M_SQRT1_2);
    }
  }
  double bell(double t) const { return std::abs(t) < kReach ? at(bell_, t) : 0; }
  double share(double t) const { return std::abs(t) < kReach ? at(share_, t) : t > 0 ? 1 : 0; }

 private:
  static constexpr int kSteps = 800;
  static constexpr double kReach = 5;
  using Table = std::array<double, kSteps + 1>;
  static double at(const Table& table, double t) {
    const double place = (t + kReach) * (kSteps / (2 * kReach));
    const int i = std::min(static_cast<int>(place), kSteps - 1);
    return table[i] + (place - i) * (table[i + 1] - table[i]);
  }
  Table bell_, share_;
};

const BlurTable& blurTable() {
  static const BlurTable table;
  return table;
}

/// What a marking adds for an amplitude of 1, and the derivative by the distance from its side.
struct Part {
  double value, slope;
};

/// A line along the runway, this far off: across it a blurred bell.
Part line(double off, double blur, double scale) {
  const double value = blurTable().bell(off / blur) / blur * scale;
  return {value, -off / (blur * blur) * value};
}

Part bars(double inward, const double* from_to, double blur) {
  const double begin = (inward - from_to[0]) / blur, end = (inward - from_to[1]) / blur;
  return {blurTable().share(begin) - blurTable().share(end),
          (blurTable().bell(begin) - blurTable().bell(end)) / blur};
}

}  // namespace

OutlineModel::OutlineModel(const Corners& reference, const OutlineLook& look)
    : sides_{OutlineSide(reference, 0), OutlineSide(reference, 1), OutlineSide(reference, 2),
             OutlineSide(reference, 3)},
      width_(look.size.width) {
  middle_ = 0.25 * (reference[0] + reference[1] + reference[2] + reference[3]);
  near_width_ = sides_[kNearSide].length;
  far_width_ = sides_[kFarSide].length;
  const double taper = far_width_ / near_width_;
  const double by_taper = look.focal_length * width_ / near_width_ * (1 - taper) / taper;
  const double length =
      look.size.length > 0 ? look.size.length : std::clamp(by_taper, kShortestRunway, kLongestRunway);
  const auto place = [&](double metres) { return metres / length / (taper + (1 - taper) * metres / length); };
  const double height = 0.5 * (sides_[kLeftSide].length + sides_[kRightSide].length);
  bars_[0] = place(kBarsBegin) * height;
  bars_[1] = place(kBarsEnd) * height;
  // At the far end all is shorter by the square of the taper.
  far_bars_[0] = kBarsBegin / length * taper * height;
  far_bars_[1] = kBarsEnd / length * taper * height;
  marks_across_[0] = kMarksAcross / length / taper * height;
  marks_across_[1] = kMarksAcross / length * taper * height;
}

bool OutlineModel::mayTell(const Eigen::Vector2d& pixel) const {
  double least = kInside + 1;
  for (const OutlineSide& side : sides_) least = std::min(least, side.inward.dot(pixel - side.from));
  return least >= -kOutside && least <= kInside;
}

OutlineModel::Place OutlineModel::placeOf(const Eigen::Vector2d& pixel, const OutlineVector& p) const {
  Place place;
  double inside[kSides];
  const double blur = p[kBlur];
  const BlurTable& table = blurTable();
  for (int i = 0; i < kSides; ++i) {
    const OutlineSide& side = sides_[i];
    const double share = std::clamp(side.along.dot(pixel - side.from) / side.length, -0.5, 1.5);
    const double inward = side.inward.dot(pixel - side.from) - (1 - share) * p[2 * i] - share * p[2 * i + 1];
    place.share[i] = share;
    place.inward[i] = inward;
    place.rise[i] = table.bell(inward / blur) / blur;
    inside[i] = table.share(inward / blur);
  }
  place.across = std::max(inside[kLeftSide] + inside[kRightSide] - 1, 0.0);
  place.along = std::max(inside[kNearSide] + inside[kFarSide] - 1, 0.0);
  const double near = place.inward[kNearSide];
  place.beyond = std::clamp(near / std::max(near + place.inward[kFarSide], 1.0), 0.0, 1.0);
  place.scale = (near_width_ + (far_width_ - near_width_) * place.beyond) / width_;
  return place;
}

double OutlineModel::at(const Eigen::Vector2d& pixel, const OutlineVector& p, OutlineVector& slope) const {
  const double blur = p[kBlur];
  const Place place = placeOf(pixel, p);
  const double* d = place.inward;
  const double along = place.along, across = place.across;
  const double body = p[kSurface] * (1 - place.beyond) + p[kSurface + 1] * place.beyond;
  const Part left = line(d[kLeftSide] - kStripePlace * place.scale, blur, place.scale);
  const Part right = line(d[kRightSide] - kStripePlace * place.scale, blur, place.scale);
  const Part centre = line(0.5 * (d[kLeftSide] - d[kRightSide]), blur, place.scale);
  const Part near = bars(d[kNearSide], bars_, blur), far = bars(d[kFarSide], far_bars_, blur);
  const Eigen::Vector2d from_middle = (pixel - middle_) / 10;
  slope[kGround] = 1;
  slope[kGround + 1] = from_middle.x();
  slope[kGround + 2] = from_middle.y();
  slope[kGround + 3] = from_middle.y() * from_middle.y();
  slope[kSurface] = across * along * (1 - place.beyond);
  slope[kSurface + 1] = across * along * place.beyond;
  slope[kStripes] = (left.value + right.value) * along;
  slope[kMiddle] = centre.value * along;
  slope[kNearBars] = near.value * across;
  slope[kFarBars] = far.value * across;
  const double ends = p[kNearBars] * near.value + p[kFarBars] * far.value;
  const double lines = p[kStripes] * (left.value + right.value) + p[kMiddle] * centre.value;
  const double by_left = body * place.rise[kLeftSide] + p[kStripes] * left.slope;
  const double by_right = body * place.rise[kRightSide] + p[kStripes] * right.slope;
  const double by_middle = 0.5 * p[kMiddle] * centre.slope, lengthwise = across * body + lines;
  const double by[kSides] = {along * (by_left + by_middle) + ends * place.rise[kLeftSide],
                             lengthwise * place.rise[kFarSide] + p[kFarBars] * across * far.slope,
                             along * (by_right - by_middle) + ends * place.rise[kRightSide],
                             lengthwise * place.rise[kNearSide] + p[kNearBars] * across * near.slope};
  slope[kBlur] = 0;
  for (int i = 0; i < kSides; ++i) {
    slope[2 * i] = -(1 - place.share[i]) * by[i];
    slope[2 * i + 1] = -place.share[i] * by[i];
    slope[kBlur] -= by[i] * d[i] / blur;  // of edges; lines only get lower, which their amplitude takes up
  }
  return slope.tail<kOutlineParameters - kGround>().dot(p.tail<kOutlineParameters - kGround>());
}

}  // namespace uav_landing
