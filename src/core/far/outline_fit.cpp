#include "far/outline_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/text.h"
#include "estimation/robust.h"

namespace uav_landing {
namespace {

constexpr int kIterations = 5;
constexpr double kOutside = 7, kInside = 8;  // px: band of pixels that tell of a side
constexpr double kMostPixels = 900;
constexpr double kLargestStep = 1.0;               // px in one iteration
constexpr double kFarthest = 8;                    // px from the start
constexpr double kSettled = 0.01;                  // px
constexpr double kShortest = 2, kNarrowest = 1.2;  // px
constexpr double kLeastNoise = 1.5;                // grey levels
constexpr double kCauchy = 2.5;                    // standard deviations
constexpr double kTexture = 2;  // times: neighbouring pixels of the ground have texture in common
// 1 sigma by which texture beside a side moves all of it, px.
constexpr double kAcross = 0.05, kAlong = 0.03, kEnd = 0.1;  // kEnd: of each end by itself
constexpr double kLeastContrast = 5;                         // of its standard deviation

// Markings, m: stripe inside of the edge, bars behind the threshold. Amplitudes: grey levels times m for
// lines.
constexpr double kStripePlace = 1.0, kBarsBegin = 6, kBarsEnd = 36;
struct Amplitude {
  double mean, stddev;
};
constexpr Amplitude kAnyStripe{60, 50}, kNoStripe{0, 4};
constexpr Amplitude kStripeContrast{95, 42};  // grey levels between paint and surface
constexpr double kCentre = 25, kCentreStddev = 40;
constexpr double kBars = 30, kBarsStddev = 50;
constexpr double kShortestRunway = 400, kLongestRunway = 5000;  // m
constexpr double kMarksAcross = 15;  // m, 1 sigma by which bars and a line across at an end move the side

// Parameters: places of the sides, blur, and amplitudes.
constexpr int kBlur = 8, kGround = 9, kSurface = 13, kStripes = 15, kMiddle = 16, kNearBars = 17,
              kFarBars = 18;
constexpr int kCount = 19;
using Vector = Eigen::Matrix<double, kCount, 1>;
using Matrix = Eigen::Matrix<double, kCount, kCount>;

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

/// The model of the picture with its derivatives.
class Model {
 public:
  Model(const Corners& reference, const OutlineLook& look)
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
    const auto place = [&](double metres) {
      return metres / length / (taper + (1 - taper) * metres / length);
    };
    const double height = 0.5 * (sides_[kLeftSide].length + sides_[kRightSide].length);
    bars_[0] = place(kBarsBegin) * height;
    bars_[1] = place(kBarsEnd) * height;
    // At the far end all is shorter by the square of the taper.
    far_bars_[0] = kBarsBegin / length * taper * height;
    far_bars_[1] = kBarsEnd / length * taper * height;
    line_[0] = kMarksAcross / length / taper * height;
    line_[1] = kMarksAcross / length * taper * height;
  }

  /// 1 sigma by which what is painted across at an end moves the side, px.
  double lineAcross(int side) const { return side == kNearSide ? line_[0] : side == kFarSide ? line_[1] : 0; }

  /// Distances from the reference's sides, inside is positive. False for a pixel that tells nothing.
  bool mayTell(const Eigen::Vector2d& pixel) const {
    double least = kInside + 1;
    for (const OutlineSide& side : sides_) least = std::min(least, side.inward.dot(pixel - side.from));
    return least >= -kOutside && least <= kInside;
  }

  /// Value at a pixel, and its derivatives.
  double at(const Eigen::Vector2d& pixel, const Vector& p, Vector& slope) const {
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
    return slope.tail<kCount - kGround>().dot(p.tail<kCount - kGround>());
  }

 private:
  /// Where a pixel is. share: along each side. inward: distance inward of it, px. rise: derivative of the
  /// share of the pixel that is inside. beyond: from the near side (0) to the far one (1). scale: px a metre.
  struct Place {
    double share[kSides], inward[kSides], rise[kSides];
    double across, along, beyond, scale;
  };
  Place placeOf(const Eigen::Vector2d& pixel, const Vector& p) const {
    Place place;
    double inside[kSides];
    const double blur = p[kBlur];
    for (int i = 0; i < kSides; ++i) {
      const OutlineSide& side = sides_[i];
      const double share = std::clamp(side.along.dot(pixel - side.from) / side.length, -0.5, 1.5);
      const double inward =
          side.inward.dot(pixel - side.from) - (1 - share) * p[2 * i] - share * p[2 * i + 1];
      place.share[i] = share;
      place.inward[i] = inward;
      place.rise[i] = table_.bell(inward / blur) / blur;
      inside[i] = table_.share(inward / blur);
    }
    place.across = std::max(inside[kLeftSide] + inside[kRightSide] - 1, 0.0);
    place.along = std::max(inside[kNearSide] + inside[kFarSide] - 1, 0.0);
    const double near = place.inward[kNearSide];
    place.beyond = std::clamp(near / std::max(near + place.inward[kFarSide], 1.0), 0.0, 1.0);
    place.scale = (near_width_ + (far_width_ - near_width_) * place.beyond) / width_;
    return place;
  }

  /// What a marking adds for an amplitude of 1, and the derivative by the distance from its side.
  struct Part {
    double value, slope;
  };
  /// A line along the runway, this far off: across it a blurred bell.
  Part line(double off, double blur, double scale) const {
    const double value = table_.bell(off / blur) / blur * scale;
    return {value, -off / (blur * blur) * value};
  }
  Part bars(double inward, const double* from_to, double blur) const {
    const double begin = (inward - from_to[0]) / blur, end = (inward - from_to[1]) / blur;
    return {table_.share(begin) - table_.share(end), (table_.bell(begin) - table_.bell(end)) / blur};
  }

  const BlurTable& table_ = blurTable();
  std::array<OutlineSide, kSides> sides_;
  double width_, near_width_, far_width_;
  double bars_[2], far_bars_[2];  // px from the sides
  double line_[2];                // of the near and the far side
  Eigen::Vector2d middle_;
};

struct Pixel {
  Eigen::Vector2d place;
  double grey;
};

std::vector<Pixel> pixelsAround(const cv::Mat& image, const cv::Mat& mask, const Corners& corners,
                                const Model& model) {
  Eigen::Vector2d low = corners[0], high = corners[0];
  double around = 0;
  for (int i = 0; i < kSides; ++i) {
    low = low.cwiseMin(corners[i]);
    high = high.cwiseMax(corners[i]);
    around += (corners[(i + 1) % kSides] - corners[i]).norm();
  }
  const int stride = static_cast<int>(std::ceil(around * (kInside + kOutside) / kMostPixels));
  const int left = std::max(0, static_cast<int>(low.x() - kOutside)),
            top = std::max(0, static_cast<int>(low.y() - kOutside));
  const int right = std::min(image.cols - 1, static_cast<int>(high.x() + kOutside) + 1),
            bottom = std::min(image.rows - 1, static_cast<int>(high.y() + kOutside) + 1);
  std::vector<Pixel> pixels;
  for (int v = top; v <= bottom; ++v) {
    const uchar *grey = image.ptr<uchar>(v), *valid = mask.ptr<uchar>(v);
    for (int u = left; u <= right; ++u) {
      if ((u + 3 * v) % stride != 0 || valid[u] == 0) continue;
      const Eigen::Vector2d place(u, v);
      if (model.mayTell(place)) pixels.push_back({place, static_cast<double>(grey[u])});
    }
  }
  return pixels;
}

/// What is known of the parameters beforehand: value and information.
struct Prior {
  Vector value = Vector::Zero(), information = Vector::Zero();
  void set(int i, double expected, double stddev) {
    value[i] = expected;
    information[i] = 1 / (stddev * stddev);
  }
};

/// Side stripes are at least 0.9 m wide on runways of 30 m and more, and 0.45 m on narrower ones (ICAO Annex
/// 14, 5.2.7).
Amplitude stripesOf(EdgePaint paint, double runway_width) {
  if (paint == EdgePaint::kUnknown) return kAnyStripe;
  if (paint == EdgePaint::kNone) return kNoStripe;
  const double width = runway_width >= 30 ? 0.9 : 0.45;
  return {width * kStripeContrast.mean, width * kStripeContrast.stddev};
}

Prior priorOf(const OutlineLook& look, EdgePaint paint) {
  Prior prior;
  for (int i = 0; i < 8; ++i) prior.set(i, 0, kFarthest);
  prior.set(kBlur, look.blur, look.blur_stddev);
  for (int i = kGround; i < kStripes; ++i) prior.set(i, 0, 500);
  const Amplitude stripes = stripesOf(paint, look.size.width);
  prior.set(kStripes, stripes.mean, stripes.stddev);
  prior.set(kMiddle, kCentre, kCentreStddev);
  prior.set(kNearBars, kBars, kBarsStddev);
  prior.set(kFarBars, kBars, kBarsStddev);
  return prior;
}

Failure noOutline(const std::string& why) { return {Reason::kNoRunway, why}; }

/// Gauss-Newton with Cauchy's weights, over the pixels.
class Solver {
 public:
  Solver(const Model& model, const std::vector<Pixel>& pixels, const Prior& prior, const Vector8d& inward)
      : model_(model),
        pixels_(pixels),
        prior_(prior),
        p_(prior.value),
        residuals_(pixels.size()),
        slopes_(pixels.size(), kCount) {
    p_.head<8>() = inward;
  }

  bool run() {
    // The amplitudes first: the places are as good as the start.
    if (!iterate(true)) return false;
    for (int i = 0; i < kIterations; ++i) {
      if (!iterate(false)) return false;
      if (step_.head<8>().cwiseAbs().maxCoeff() < kSettled) break;
    }
    return iterate(false) && p_.head<8>().cwiseAbs().maxCoeff() < kFarthest;
  }

  const Vector& parameters() const { return p_; }
  double noise() const { return noise_; }
  Matrix covariance() const { return information_.inverse(); }
  /// -2 log likelihood of the pixels and of all but the places.
  double cost(double noise) const {
    const double scale = kCauchy * noise;
    Vector slope;
    double cost = 0;
    for (const Pixel& pixel : pixels_) {
      const double r = (pixel.grey - model_.at(pixel.place, p_, slope)) / scale;
      cost += scale * scale * std::log(1 + r * r);
    }
    cost /= kTexture * noise * noise;
    for (int i = kBlur; i < kCount; ++i) cost += prior_.information[i] * std::pow(p_[i] - prior_.value[i], 2);
    return cost;
  }

 private:
  bool iterate(bool amplitudes_only) {
    Vector gradient = Vector::Zero(), slope;
    for (size_t i = 0; i < pixels_.size(); ++i) {
      const double r = pixels_[i].grey - model_.at(pixels_[i].place, p_, slope);
      residuals_[i] = std::abs(r);
      const double weight = 1 / (1 + std::pow(r / (kCauchy * noise_), 2));
      gradient += weight * r * slope;
      slopes_.row(static_cast<Eigen::Index>(i)) = std::sqrt(weight) * slope.transpose();
    }
    const Matrix data = slopes_.transpose() * slopes_;
    if (!amplitudes_only) noise_ = std::max(kLeastNoise, robustStddev(residuals_));
    const double variance = kTexture * noise_ * noise_;
    information_ = data / variance;
    information_.diagonal() += prior_.information;
    gradient = gradient / variance + prior_.information.cwiseProduct(prior_.value - p_);
    if (amplitudes_only) {
      const int n = kCount - kGround;
      step_.setZero();
      step_.tail(n) = information_.bottomRightCorner(n, n).ldlt().solve(gradient.tail(n));
    } else {
      step_ = information_.ldlt().solve(gradient);
      step_ /= std::max(1.0, step_.head<8>().cwiseAbs().maxCoeff() / kLargestStep);
    }
    p_ += step_;
    p_[kBlur] = std::clamp(p_[kBlur], 0.35, 1.5);
    return p_.allFinite();
  }

  const Model& model_;
  const std::vector<Pixel>& pixels_;
  Prior prior_;
  Vector p_, step_ = Vector::Zero();
  Matrix information_ = Matrix::Identity();
  std::vector<double> residuals_;
  Eigen::Matrix<double, Eigen::Dynamic, kCount> slopes_;
  double noise_ = 20;
};

bool isUsable(const Corners& corners) {
  const double height =
      0.5 * (OutlineSide(corners, kLeftSide).length + OutlineSide(corners, kRightSide).length);
  return height >= kShortest && OutlineSide(corners, kNearSide).length >= kNarrowest &&
         OutlineSide(corners, kFarSide).length >= 0.3 * kNarrowest &&
         std::all_of(corners.begin(), corners.end(), [](const auto& corner) { return corner.allFinite(); });
}

}  // namespace

struct OutlineFitter::Pixels {
  Model model;
  std::vector<Pixel> all;
  Pixels(const cv::Mat& image, const cv::Mat& mask, const Corners& reference, const OutlineLook& look)
      : model(reference, look), all(pixelsAround(image, mask, reference, model)) {}
};

OutlineFitter::OutlineFitter(const cv::Mat& image, const cv::Mat& mask, const Corners& reference,
                             const OutlineLook& look)
    : reference_(reference), look_(look) {
  if (isUsable(reference)) pixels_ = std::make_unique<const Pixels>(image, mask, reference, look);
}

OutlineFitter::~OutlineFitter() = default;

Expected<FittedOutline> OutlineFitter::fit(const Vector8d& inward, EdgePaint paint) {
  if (!pixels_) return tl::make_unexpected(noOutline("the runway is too small in the image"));
  const Model& model = pixels_->model;
  if (pixels_->all.size() < 3 * kCount)
    return tl::make_unexpected(noOutline("the runway is not in the image"));
  Solver solver(model, pixels_->all, priorOf(look_, paint), inward);
  if (!solver.run()) return tl::make_unexpected(noOutline("no outline where the runway is expected"));
  const Vector& p = solver.parameters();
  const Matrix covariance = solver.covariance();
  FittedOutline fitted;
  fitted.seen = {reference_, p.head<8>(), covariance.topLeftCorner<8, 8>()};
  for (int i = 0; i < kSides; ++i) {
    const double stddev = std::hypot(i == kNearSide || i == kFarSide ? kAcross : kAlong, model.lineAcross(i));
    fitted.seen.covariance.block<2, 2>(2 * i, 2 * i).array() += stddev * stddev;
    fitted.seen.covariance.block<2, 2>(2 * i, 2 * i).diagonal().array() += kEnd * kEnd;
  }
  if (!isUsable(movedBy(reference_, fitted.seen.inward)))
    return tl::make_unexpected(noOutline("no outline where the runway is expected"));
  fitted.blur = p[kBlur];
  fitted.contrast = 0.5 * (p[kSurface] + p[kSurface + 1]);
  const Eigen::Matrix2d ends = covariance.block<2, 2>(kSurface, kSurface);
  fitted.contrast_stddev = 0.5 * std::sqrt(ends.sum());
  fitted.residual = solver.noise();
  fitted.stripes = p[kStripes];
  if (noise_ == 0) noise_ = solver.noise();
  fitted.cost = solver.cost(noise_);
  if (!(std::abs(fitted.contrast) > kLeastContrast * fitted.contrast_stddev))
    return tl::make_unexpected(noOutline(text("a contrast of ", rounded(fitted.contrast), " +- ",
                                              rounded(fitted.contrast_stddev), " grey levels only")));
  return fitted;
}

Expected<FittedOutline> fitOutline(const cv::Mat& image, const cv::Mat& mask, const Corners& start,
                                   const OutlineLook& look) {
  return OutlineFitter(image, mask, start, look).fit(Vector8d::Zero(), EdgePaint::kUnknown);
}

}  // namespace uav_landing
