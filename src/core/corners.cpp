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

// Local maxima of the response inside the mask, away from the border of the image.
std::vector<Candidate> localMaxima(const cv::Mat& response, const cv::Mat& mask, float threshold) {
  std::vector<Candidate> maxima;
  for (int y = 1; y + 1 < response.rows; ++y) {
    const float* above = response.ptr<float>(y - 1);
    const float* row = response.ptr<float>(y);
    const float* below = response.ptr<float>(y + 1);
    const uchar* allowed = mask.ptr<uchar>(y);
    for (int x = 1; x + 1 < response.cols; ++x) {
      const float r = row[x];
      if (r < threshold || !allowed[x]) continue;
      if (r > row[x - 1] && r >= row[x + 1] && r > above[x - 1] && r > above[x] && r > above[x + 1] &&
          r >= below[x - 1] && r >= below[x] && r >= below[x + 1]) {
        maxima.push_back({r, {x, y}});
      }
    }
  }
  return maxima;
}

float strongestResponse(const cv::Mat& response, const cv::Mat& mask) {
  double strongest = 0;
  cv::minMaxLoc(response, nullptr, &strongest, nullptr, nullptr, mask);
  return static_cast<float>(strongest);
}

}  // namespace

std::vector<cv::Point> findCorners(const cv::Mat& image, const cv::Mat& mask, int count, double quality,
                                   double min_distance, double harris_k) {
  const cv::Rect area = cv::boundingRect(mask);
  if (area.width < 3 || area.height < 3) return {};
  cv::Mat response;
  cv::cornerHarris(image(area), response, 3, 3, harris_k);
  const cv::Mat allowed = mask(area);
  const float strongest = strongestResponse(response, allowed);
  if (!(strongest > 0)) return {};
  std::vector<Candidate> maxima = localMaxima(response, allowed, static_cast<float>(quality) * strongest);

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
