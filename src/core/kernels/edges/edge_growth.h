#pragma once

#include <cstddef>
#include <opencv2/core.hpp>

namespace uav_landing {

/// u = offset + slope v.
struct Straight {
  double offset, slope;

  double at(double v) const { return offset + slope * v; }
};

/// Straight line u = u0 + slope v through the stations seen so far, by least squares; v is counted from the
/// start.
class GrowingLine {
 public:
  explicit GrowingLine(double slope) : first_slope_(slope), straight_{0, slope} {}

  void add(double v, double u) {
    n_ += 1;
    sv_ += v;
    su_ += u;
    svv_ += v * v;
    svu_ += v * u;
    suu_ += u * u;
  }
  /// Fits the line to the stations added.
  void fit() {
    constexpr double kSlopePrior = 10;  // number of stations that the expected slope is worth
    const double svv = svv_ + kSlopePrior, svu = svu_ + kSlopePrior * first_slope_;
    // One division for both, because the next stations wait for it.
    const double determinant = n_ * svv - sv_ * sv_, inverse = 1 / (n_ * determinant);
    straight_.slope = (n_ * svu - sv_ * su_) * (n_ * inverse);
    straight_.offset = (su_ - straight_.slope * sv_) * (determinant * inverse);
  }
  const Straight& straight() const { return straight_; }
  double at(double v) const { return straight_.at(v); }
  double slope() const { return straight_.slope; }
  double count() const { return n_; }
  double meanSquare() const {
    const double offset = straight_.offset, slope = straight_.slope;
    const double squares = suu_ - 2 * (offset * su_ + slope * svu_) + n_ * offset * offset +
                           2 * offset * slope * sv_ + slope * slope * svv_;
    return squares / n_;
  }

 private:
  double n_ = 0, sv_ = 0, su_ = 0, svv_ = 0, svu_ = 0, suu_ = 0;
  double first_slope_;
  Straight straight_;
};

/// Pixels where edges may be, in an image or in a transposed one.
class EdgeMask {
 public:
  EdgeMask(const cv::Mat& mask, bool transposed)
      : mask_(mask.ptr<uchar>()),
        along_row_(transposed ? static_cast<std::ptrdiff_t>(mask.step) : 1),
        to_next_row_(transposed ? 1 : static_cast<std::ptrdiff_t>(mask.step)) {}

  bool has(int u, int v) const { return mask_[u * along_row_ + v * to_next_row_] != 0; }

 private:
  const uchar* mask_;
  std::ptrdiff_t along_row_, to_next_row_;
};

/// Pixels of a mono8 image.
struct PixelRows {
  const uchar* first;
  std::ptrdiff_t step;
  int columns, rows;
};

/// Pixel that a line grows from, the sign of the gradient along its row, and the expected slope, columns per
/// row.
struct Seed {
  int u, v, sign;
  double slope;
};

struct GrowthLimits {
  int least;       ///< Sobel response across an edge
  double max_gap;  ///< px, within a line
};

/// A line, its ends and its stations; these are rows counted from the seed's.
struct GrownEdge {
  GrowingLine line;
  int from, to;
  int looked;  ///< stations looked at, without those beyond the ends

  /// Whether enough of the stations show the edge.
  bool isShown() const {
    constexpr double kLeastShare = 0.8;
    return line.count() >= kLeastShare * looked;
  }
};

/// Follows an edge to both sides from a seed, until it ends or turns out to be texture.
GrownEdge growEdge(const PixelRows& image, const EdgeMask& mask, const Seed& seed,
                   const GrowthLimits& limits);

}  // namespace uav_landing
