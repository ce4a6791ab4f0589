#include "far/outline_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "estimation/robust.h"

namespace uav_landing {
namespace {

constexpr int kBand = 6, kStep = 3;                       // rows
constexpr double kLeastEdge = 2.5, kClearEdge = 4;        // grey levels for two columns; standard deviations
constexpr size_t kMostEdges = 24;                         // of a band
constexpr double kNarrowest = 2, kWidest = 90;            // px
constexpr double kLeastLikeness = 0.35;                   // between both edges of a strip
constexpr double kDrift = 3;                              // px that an edge moves by from band to band
constexpr double kWidening = 0.7, kLeastNarrowing = 0.5;  // px; share
constexpr double kSmooth = 0.5;                           // strength that a pixel of drift costs, share
constexpr size_t kMostCandidates = 4;
constexpr double kEnd = 0.4;     // of the contrast: beyond, the strip has ended
constexpr double kGap = 0.08;    // of the width: rows of markings across, one at least
constexpr double kShortest = 4;  // px

struct Edge {
  double u, slope;
};

/// Both edges of a strip in one band.
struct Piece {
  int band;
  double left, right, strength;
  bool dark;
  double score;
  int before = -1;  // piece of the band below

  double width() const { return right - left; }
};

class Search {
 public:
  Search(const cv::Mat& image, const cv::Mat& mask, const cv::Rect& region)
      : image_(image), mask_(mask), region_(region) {
    bands_ = (region.height - kBand) / kStep + 1;
    for (int band = 0; band < bands_; ++band) addPieces(band);
  }

  std::vector<OutlineCandidate> candidates() {
    std::vector<OutlineCandidate> found;
    std::vector<size_t> order(pieces_.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(),
              [this](size_t a, size_t b) { return pieces_[a].score > pieces_[b].score; });
    for (const size_t last : order) {
      if (found.size() == kMostCandidates) break;
      const std::vector<const Piece*> chain = chainTo(last);
      if (chain.size() < 2) continue;
      OutlineCandidate candidate;
      candidate.strength = pieces_[last].score;
      if (!outline(chain, candidate.corners)) continue;
      const bool is_part = std::any_of(found.begin(), found.end(), [&](const OutlineCandidate& other) {
        return isWithin(other.corners, candidate.corners) || isWithin(candidate.corners, other.corners);
      });
      if (!is_part) found.push_back(candidate);
    }
    return found;
  }

 private:
  // Bands are counted from the bottom.
  int topOf(int band) const { return region_.y + region_.height - kBand - band * kStep; }
  double middleOf(int band) const { return topOf(band) + 0.5 * (kBand - 1); }

  std::vector<Edge> edgesOf(int band) {
    const int top = topOf(band), n = region_.width;
    sums_.assign(n, 0);
    for (int v = top; v < top + kBand; ++v) {
      const uchar* row = image_.ptr<uchar>(v) + region_.x;
      for (int u = 0; u < n; ++u) sums_[u] = static_cast<uint16_t>(sums_[u] + row[u]);
    }
    slopes_.assign(n, 0);
    sizes_.assign(n, 0);
    const uchar *first = mask_.ptr<uchar>(top) + region_.x,
                *last = mask_.ptr<uchar>(top + kBand - 1) + region_.x;
    for (int u = 1; u + 1 < n; ++u) {
      if (first[u - 1] == 0 || first[u + 1] == 0 || last[u - 1] == 0 || last[u + 1] == 0) continue;
      slopes_[u] = static_cast<float>(sums_[u + 1] - sums_[u - 1]) / kBand;
      sizes_[u] = std::abs(slopes_[u]);
    }
    const double least = std::max(kLeastEdge, kClearEdge * robustStddev({sizes_.begin(), sizes_.end()}));
    std::vector<Edge> edges;
    for (int u = 1; u + 1 < n; ++u) {
      const double here = sizes_[u], before = sizes_[u - 1], after = sizes_[u + 1];
      if (here < least || before >= here || after > here) continue;
      const double curve = before - 2 * here + after;
      edges.push_back({region_.x + u + (curve < 0 ? 0.5 * (before - after) / curve : 0), slopes_[u]});
    }
    if (edges.size() > kMostEdges) {
      std::nth_element(edges.begin(), edges.begin() + kMostEdges, edges.end(),
                       [](const Edge& a, const Edge& b) { return std::abs(a.slope) > std::abs(b.slope); });
      edges.resize(kMostEdges);
    }
    return edges;
  }

  void addPieces(int band) {
    const size_t below = last_begin_, below_end = pieces_.size();
    last_begin_ = below_end;
    const std::vector<Edge> edges = edgesOf(band);
    for (const Edge& l : edges)
      for (const Edge& r : edges) {
        const double width = r.u - l.u;
        if (width < kNarrowest || width > kWidest || (l.slope > 0) == (r.slope > 0)) continue;
        const double weak = std::min(std::abs(l.slope), std::abs(r.slope)),
                     strong = std::max(std::abs(l.slope), std::abs(r.slope));
        if (weak < kLeastLikeness * strong) continue;
        Piece piece{band, l.u, r.u, weak, l.slope < 0, weak};
        for (size_t i = below; i < below_end; ++i) follow(static_cast<int>(i), piece);
        pieces_.push_back(piece);
      }
  }

  void follow(int i, Piece& piece) const {
    const Piece& below = pieces_[i];
    const double left = std::abs(piece.left - below.left), right = std::abs(piece.right - below.right);
    if (below.dark != piece.dark || left > kDrift || right > kDrift ||
        piece.width() > below.width() + kWidening || piece.width() < kLeastNarrowing * below.width())
      return;
    const double score = below.score + piece.strength * (1 - kSmooth * (left + right) / (2 * kDrift));
    if (score <= piece.score) return;
    piece.score = score;
    piece.before = i;
  }

  std::vector<const Piece*> chainTo(size_t last) const {
    std::vector<const Piece*> chain;
    for (int i = static_cast<int>(last); i >= 0; i = pieces_[i].before) chain.push_back(&pieces_[i]);
    return chain;
  }

  /// A straight line through u of some rows.
  struct Slant {
    double at = 0, slope = 0, v = 0;
    double u(double row) const { return at + slope * (row - v); }
  };
  template <class Place>
  Slant slantOf(const std::vector<const Piece*>& chain, const Place& place) const {
    double mean_u = 0, mean_v = 0, uv = 0, vv = 0;
    const auto n = static_cast<double>(chain.size());
    for (const Piece* piece : chain) {
      mean_u += place(*piece) / n;
      mean_v += middleOf(piece->band) / n;
    }
    for (const Piece* piece : chain) {
      const double v = middleOf(piece->band) - mean_v;
      uv += v * (place(*piece) - mean_u);
      vv += v * v;
    }
    return {mean_u, uv / vv, mean_v};
  }

  /// Mean grey level of a row between two columns; NaN where it is not in the image.
  double mean(int v, double from, double to) const {
    const int first = static_cast<int>(std::ceil(from)), last = std::max(first, static_cast<int>(to));
    if (v < 0 || v >= image_.rows || first < 0 || last >= image_.cols) return std::nan("");
    const uchar* row = image_.ptr<uchar>(v);
    return static_cast<double>(std::accumulate(row + first, row + last + 1, 0)) / (last - first + 1);
  }

  /// Ends of the strip: where it is no longer darker, or brighter, than what is beside it.
  bool outline(const std::vector<const Piece*>& chain, Corners& corners) const {
    const Slant left = slantOf(chain, [](const Piece& piece) { return piece.left; });
    const Slant right = slantOf(chain, [](const Piece& piece) { return piece.right; });
    const auto contrast = [&](int v) {
      const double l = left.u(v), r = right.u(v), width = r - l;
      if (width < 1) return 0.0;
      const double beside = std::max(3.0, 0.5 * width);
      const double outside = 0.5 * (mean(v, l - 2 - beside, l - 2) + mean(v, r + 2, r + 2 + beside));
      const double difference = outside - mean(v, l + 0.25 * width, r - 0.25 * width);
      return std::isfinite(difference) ? (chain.front()->dark ? difference : -difference) : 0.0;
    };
    const int top = static_cast<int>(middleOf(chain.front()->band)),
              bottom = static_cast<int>(middleOf(chain.back()->band));
    std::vector<double> contrasts;
    for (int v = top; v <= bottom; ++v) contrasts.push_back(contrast(v));
    const double usual = medianOf(contrasts);
    if (!(usual > 0)) return false;
    const auto end = [&](int v, int step, int longest_gap) {
      int last = v, gap = 0;
      for (; v >= 0 && v < image_.rows && gap <= longest_gap; v += step) {
        gap = contrast(v) >= kEnd * usual ? 0 : gap + 1;
        if (gap == 0) last = v;
      }
      return last + 0.5 * step;
    };
    const double width = chain.back()->width();
    const double near = end(bottom, 1, std::max(1, static_cast<int>(kGap * width))), far = end(top, -1, 0);
    if (near - far < kShortest || right.u(far) - left.u(far) < 0.5) return false;
    corners = {
        Eigen::Vector2d(left.u(near), near), {left.u(far), far}, {right.u(far), far}, {right.u(near), near}};
    return true;
  }

  /// Whether the middle of one lies in the other's rows and columns.
  static bool isWithin(const Corners& a, const Corners& b) {
    const Eigen::Vector2d middle = 0.25 * (a[0] + a[1] + a[2] + a[3]);
    const double left = std::min(b[0].x(), b[1].x()), right = std::max(b[2].x(), b[3].x());
    return middle.x() > left - 1 && middle.x() < right + 1 && middle.y() > b[1].y() && middle.y() < b[0].y();
  }

  const cv::Mat &image_, &mask_;
  cv::Rect region_;
  int bands_;
  std::vector<Piece> pieces_;
  size_t last_begin_ = 0;
  std::vector<uint16_t> sums_;
  std::vector<float> slopes_, sizes_;
};

}  // namespace

std::vector<OutlineCandidate> searchOutlines(const cv::Mat& image, const cv::Mat& mask,
                                             const cv::Rect& region) {
  const cv::Rect inside = region & cv::Rect(0, 0, image.cols, image.rows);
  if (inside.width < 8 || inside.height < kBand) return {};
  return Search(image, mask, inside).candidates();
}

}  // namespace uav_landing
