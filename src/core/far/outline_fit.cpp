#include "far/outline_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/text.h"
#include "estimation/robust.h"
#include "far/outline_model.h"
#include "far/runway_paint.h"

namespace uav_landing {
namespace {

constexpr int kIterations = 5;
constexpr double kAround = OutlineModel::kOutside, kBand = kAround + OutlineModel::kInside;
constexpr double kMostPixels = 900;
constexpr double kLargestStep = 1.0;               // px in one iteration
constexpr double kFarthest = 8;                    // px from the start
constexpr double kSettled = 0.01;                  // px
constexpr double kShortest = 2, kNarrowest = 1.2;  // px
constexpr double kLeastNoise = 1.5;                // grey levels
constexpr double kCauchy = 2.5;                    // standard deviations
constexpr double kTexture = 3.5;  // times: neighbouring pixels of the ground have texture in common
// 1 sigma by which texture beside a side moves all of it, px.
constexpr double kAcross = 0.05, kAlong = 0.03, kEnd = 0.1;  // kEnd: of each end by itself
constexpr double kLeastContrast = 5;                         // of its standard deviation

// Amplitudes of markings: grey levels, times m for lines.
struct Amplitude {
  double mean, stddev;
};
constexpr Amplitude kAnyStripe{60, 50}, kNoStripe{0, 4};
constexpr double kCentre = 25, kCentreStddev = 40;
constexpr double kBars = 30, kBarsStddev = 50;

struct Pixel {
  Eigen::Vector2d place;
  double grey;
};

std::vector<Pixel> pixelsAround(const cv::Mat& image, const cv::Mat& mask, const Corners& corners,
                                const OutlineModel& model) {
  const Eigen::Vector2d low = boxOf(corners).min(), high = boxOf(corners).max();
  double around = 0;
  for (int i = 0; i < kSides; ++i) around += (corners[(i + 1) % kSides] - corners[i]).norm();
  const int stride = static_cast<int>(std::ceil(around * kBand / kMostPixels));
  const int left = std::max(0, static_cast<int>(low.x() - kAround)),
            top = std::max(0, static_cast<int>(low.y() - kAround));
  const int right = std::min(image.cols - 1, static_cast<int>(high.x() + kAround) + 1),
            bottom = std::min(image.rows - 1, static_cast<int>(high.y() + kAround) + 1);
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
  OutlineVector value = OutlineVector::Zero(), information = OutlineVector::Zero();
  void set(int i, double expected, double stddev) {
    value[i] = expected;
    information[i] = 1 / (stddev * stddev);
  }
};

Amplitude stripesOf(EdgePaint paint, double runway_width) {
  if (paint == EdgePaint::kUnknown) return kAnyStripe;
  if (paint == EdgePaint::kNone) return kNoStripe;
  const EdgeStripes usual = usualStripes(runway_width);
  return {usual.amplitude(), usual.spread * usual.amplitude()};
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
  Solver(const OutlineModel& model, const std::vector<Pixel>& pixels, const Prior& prior,
         const Vector8d& inward)
      : model_(model),
        pixels_(pixels),
        prior_(prior),
        p_(prior.value),
        residuals_(pixels.size()),
        slopes_(static_cast<Eigen::Index>(pixels.size()), Eigen::Index{kOutlineParameters}) {
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

  const OutlineVector& parameters() const { return p_; }
  double noise() const { return noise_; }
  OutlineMatrix covariance() const { return information_.inverse(); }
  /// -2 log likelihood of the pixels and of all but the places.
  double cost(double noise) const {
    const double scale = kCauchy * noise;
    OutlineVector slope;
    double cost = 0;
    for (const Pixel& pixel : pixels_) {
      const double r = (pixel.grey - model_.at(pixel.place, p_, slope)) / scale;
      cost += scale * scale * std::log(1 + r * r);
    }
    cost /= kTexture * noise * noise;
    for (int i = kBlur; i < kOutlineParameters; ++i)
      cost += prior_.information[i] * std::pow(p_[i] - prior_.value[i], 2);
    return cost;
  }

 private:
  bool iterate(bool amplitudes_only) {
    OutlineVector gradient = OutlineVector::Zero(), slope;
    for (size_t i = 0; i < pixels_.size(); ++i) {
      const double r = pixels_[i].grey - model_.at(pixels_[i].place, p_, slope);
      residuals_[i] = std::abs(r);
      const double weight = 1 / (1 + std::pow(r / (kCauchy * noise_), 2));
      gradient += weight * r * slope;
      slopes_.row(static_cast<Eigen::Index>(i)) = std::sqrt(weight) * slope.transpose();
    }
    const OutlineMatrix data = slopes_.transpose() * slopes_;
    if (!amplitudes_only) noise_ = std::max(kLeastNoise, robustStddev(residuals_));
    const double variance = kTexture * noise_ * noise_;
    information_ = data / variance;
    information_.diagonal() += prior_.information;
    gradient = gradient / variance + prior_.information.cwiseProduct(prior_.value - p_);
    if (amplitudes_only) {
      const int n = kOutlineParameters - kGround;
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

  const OutlineModel& model_;
  const std::vector<Pixel>& pixels_;
  Prior prior_;
  OutlineVector p_, step_ = OutlineVector::Zero();
  OutlineMatrix information_ = OutlineMatrix::Identity();
  std::vector<double> residuals_;
  Eigen::Matrix<double, Eigen::Dynamic, kOutlineParameters> slopes_;
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
  OutlineModel model;
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
  const OutlineModel& model = pixels_->model;
  if (pixels_->all.size() < 3 * kOutlineParameters)
    return tl::make_unexpected(noOutline("the runway is not in the image"));
  Solver solver(model, pixels_->all, priorOf(look_, paint), inward);
  if (!solver.run()) return tl::make_unexpected(noOutline("no outline where the runway is expected"));
  const OutlineVector& p = solver.parameters();
  const OutlineMatrix covariance = solver.covariance();
  FittedOutline fitted;
  fitted.seen = {reference_, p.head<8>(), covariance.topLeftCorner<8, 8>()};
  for (int i = 0; i < kSides; ++i) {
    const double stddev =
        std::hypot(i == kNearSide || i == kFarSide ? kAcross : kAlong, model.marksAcross(i));
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
