#include "uav_landing/corners.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace uav_landing {
namespace {

struct Candidate {
  float response;
  cv::Point point;
};

// Harris response of an image row by row, in single precision: sums over 3x3 of the products of 3x3 Sobel
// gradients. Keeps the last rows only, so that all of it stays in the cache.
class HarrisRows {
 public:
  HarrisRows(const cv::Mat& image, double k)
      : image_(image), k_(static_cast<float>(k)), columns_(image.cols), products_(9 * image.cols) {}

  // Response of row v (2 <= v < rows - 2), 0 in the two outermost columns; rows must be asked for in turn.
  void compute(int v, float* response) {
    for (next_ = std::max(next_, v - 1); next_ <= v + 1; ++next_)
      image_.depth() == CV_8U ? gradients<uchar>(next_) : gradients<float>(next_);
    const float* rows[3];
    for (int k = 0; k < 3; ++k) rows[k] = row(v - 1 + k);
    for (int plane = 0; plane < 3; ++plane) {
      const int offset = plane * columns_;
      const float *a = rows[0] + offset, *b = rows[1] + offset, *c = rows[2] + offset;
      float* sum = sums_.data() + offset;
      for (int u = 0; u < columns_; ++u) sum[u] = a[u] + b[u] + c[u];
    }
    const float *xx = sums_.data(), *xy = xx + columns_, *yy = xy + columns_;
    response[0] = response[1] = response[columns_ - 2] = response[columns_ - 1] = 0;
    for (int u = 2; u < columns_ - 2; ++u) {
      const float a = xx[u - 1] + xx[u] + xx[u + 1], b = xy[u - 1] + xy[u] + xy[u + 1],
                  c = yy[u - 1] + yy[u] + yy[u + 1];
      response[u] = a * c - b * b - k_ * (a + c) * (a + c);
    }
  }

 private:
  float* row(int v) { return products_.data() + static_cast<size_t>(v % 3) * 3 * columns_; }

  template <class Pixel>
  void gradients(int v) {
    const Pixel *a = image_.ptr<Pixel>(v - 1), *b = image_.ptr<Pixel>(v), *c = image_.ptr<Pixel>(v + 1);
    float *xx = row(v), *xy = xx + columns_, *yy = xy + columns_;
    for (int u = 1; u < columns_ - 1; ++u) {
      const auto gx = a[u + 1] + 2 * b[u + 1] + c[u + 1] - a[u - 1] - 2 * b[u - 1] - c[u - 1];
      const auto gy = c[u - 1] + 2 * c[u] + c[u + 1] - a[u - 1] - 2 * a[u] - a[u + 1];
      const float x = static_cast<float>(gx), y = static_cast<float>(gy);
      xx[u] = x * x;
      xy[u] = x * y;
      yy[u] = y * y;
    }
  }

  const cv::Mat& image_;
  float k_;
  int columns_, next_ = 0;
  std::vector<float> products_;  // three rows of the three products
  std::vector<float> sums_ = std::vector<float>(3 * columns_);
};

// Local maxima of a row of the response between its neighbours, inside the mask.
void addMaxima(const float* above, const float* row, const float* below, const uchar* allowed, int columns,
               int y, std::vector<Candidate>& maxima) {
  for (int x = 2; x + 2 < columns; ++x) {
    const float r = row[x];
    if (!(r > 0) || r <= row[x - 1] || r < row[x + 1] || !allowed[x]) continue;
    if (r > above[x - 1] && r > above[x] && r > above[x + 1] && r >= below[x - 1] && r >= below[x] &&
        r >= below[x + 1])
      maxima.push_back({r, {x, y}});
  }
}

// Local maxima of the Harris response with a response of at least quality times the strongest one.
std::vector<Candidate> localMaxima(const cv::Mat& image, const cv::Mat& mask, double quality,
                                   double harris_k) {
  HarrisRows harris(image, harris_k);
  std::vector<float> responses(static_cast<size_t>(3) * image.cols, 0.f);
  const auto row = [&](int v) { return responses.data() + static_cast<size_t>(v % 3) * image.cols; };
  std::vector<Candidate> maxima;
  for (int v = 2; v + 2 < image.rows; ++v) {
    harris.compute(v, row(v));
    if (v >= 4) addMaxima(row(v - 2), row(v - 1), row(v), mask.ptr<uchar>(v - 1), image.cols, v - 1, maxima);
  }
  float strongest = 0;
  for (const Candidate& candidate : maxima) strongest = std::max(strongest, candidate.response);
  const float threshold = static_cast<float>(quality) * strongest;
  maxima.erase(std::remove_if(maxima.begin(), maxima.end(),
                              [threshold](const Candidate& c) { return c.response < threshold; }),
               maxima.end());
  return maxima;
}

}  // namespace

std::vector<cv::Point> findCorners(const cv::Mat& image, const cv::Mat& mask, int count, double quality,
                                   double min_distance, double harris_k) {
  const cv::Rect area = cv::boundingRect(mask);
  if (area.width < 7 || area.height < 7) return {};
  std::vector<Candidate> maxima = localMaxima(image(area), mask(area), quality, harris_k);

  // Rank within cells first, so that strong markings do not take all corners, then by strength.
  const double cell = std::max(min_distance, std::sqrt(double(area.area()) / count));
  const int columns = static_cast<int>(area.width / cell) + 1;
  const int rows = static_cast<int>(area.height / cell) + 1;
  std::sort(maxima.begin(), maxima.end(), [](const Candidate& a, const Candidate& b) {
    if (a.response != b.response) return a.response > b.response;
    return a.point.y != b.point.y ? a.point.y < b.point.y : a.point.x < b.point.x;
  });
  std::vector<std::vector<cv::Point>> cells(static_cast<size_t>(columns) * rows);
  std::vector<std::pair<size_t, cv::Point>> ranked;
  const double min_squared = min_distance * min_distance;
  for (const Candidate& candidate : maxima) {
    const int cx = static_cast<int>(candidate.point.x / cell),
              cy = static_cast<int>(candidate.point.y / cell);
    bool free = true;
    for (int y = std::max(0, cy - 1); free && y <= std::min(rows - 1, cy + 1); ++y) {
      for (int x = std::max(0, cx - 1); free && x <= std::min(columns - 1, cx + 1); ++x) {
        for (const cv::Point& other : cells[static_cast<size_t>(y) * columns + x]) {
          const cv::Point step = other - candidate.point;
          if (double(step.dot(step)) < min_squared) {
            free = false;
            break;
          }
        }
      }
    }
    if (!free) continue;
    std::vector<cv::Point>& own = cells[static_cast<size_t>(cy) * columns + cx];
    if (own.size() >= 4) continue;
    ranked.emplace_back(own.size(), candidate.point);
    own.push_back(candidate.point);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  if (ranked.size() > static_cast<size_t>(count)) ranked.resize(count);
  std::vector<cv::Point> corners;
  corners.reserve(ranked.size());
  for (const auto& entry : ranked) corners.push_back(entry.second + area.tl());
  std::sort(corners.begin(), corners.end(),
            [](const cv::Point& a, const cv::Point& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  return corners;
}

}  // namespace uav_landing
