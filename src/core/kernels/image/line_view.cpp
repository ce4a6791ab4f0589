#include "kernels/image/line_view.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Places of a line's points in an image; columns are -infinity behind the camera.
UAV_LANDING_MULTIVERSION void project(const LineView& line, const LinePlaces& y, LinePlaces& u,
                                      LinePlaces& v) {
  const double x0 = line.origin.x(), y0 = line.origin.y(), z0 = line.origin.z();
  const double dx = line.direction.x(), dy = line.direction.y(), dz = line.direction.z();
  const double fx = line.fx, fy = line.fy, cx = line.cx, cy = line.cy;
  for (int c = 0; c < kLineSamples; ++c) {
    const double z = z0 + y[c] * dz, inverse = 1 / z;
    const double left_out = z > 0 ? 0 : -kInfinity;
    v[c] = fy * (y0 + y[c] * dy) * inverse + cy;
    u[c] = fx * (x0 + y[c] * dx) * inverse + cx + left_out;
  }
}

// The pixels from which the greys at some places are interpolated.
struct Pixels {
  std::array<int, kLineSamples> in_image, in_mask;       // index of the upper left pixel; any outside
  std::array<float, kLineSamples> right, below;          // distance of the place from this pixel, px
  std::array<int, kLineSamples> inside;                  // 1 when all of its pixels are inside the image
  std::array<std::uint16_t, kLineSamples> upper, lower;  // the left one in the lower byte
};

// Limits places first, as beside the camera they are too large for an int.
UAV_LANDING_MULTIVERSION void findPixels(const LinePlaces& u, const LinePlaces& v, const cv::Mat& image,
                                         const cv::Mat& mask, Pixels& pixels) {
  const double right_end = image.cols - 1, lower_end = image.rows - 1;
  const int image_step = static_cast<int>(image.step), mask_step = static_cast<int>(mask.step);
  const double last_column = std::nextafter(right_end, 0), last_row = std::nextafter(lower_end, 0);
  for (int c = 0; c < kLineSamples; ++c) {
    const double x = u[c] > 0 ? u[c] : 0, y = v[c] > 0 ? v[c] : 0;
    const double in_x = x < right_end ? x : last_column, in_y = y < lower_end ? y : last_row;
    const int column = static_cast<int>(in_x), row = static_cast<int>(in_y);
    pixels.in_image[c] = row * image_step + column;
    pixels.in_mask[c] = row * mask_step + column;
    pixels.right[c] = static_cast<float>(in_x - column);
    pixels.below[c] = static_cast<float>(in_y - row);
    pixels.inside[c] = (in_x == u[c] ? 1 : 0) & (in_y == v[c] ? 1 : 0);
  }
}

void loadPixels(const cv::Mat& image, const cv::Mat& mask, Pixels& pixels) {
  const uchar *above = image.data, *below = above + image.step, *kept = mask.data;
  for (int c = 0; c < kLineSamples; ++c) {
    const int place = pixels.in_image[c];
    std::memcpy(&pixels.upper[c], above + place, sizeof(std::uint16_t));
    std::memcpy(&pixels.lower[c], below + place, sizeof(std::uint16_t));
    pixels.inside[c] &= kept[pixels.in_mask[c]];
  }
}

// Returns the number of known greys.
UAV_LANDING_MULTIVERSION int interpolate(const Pixels& pixels, LineGreys& greys) {
  int count = 0;
  for (int c = 0; c < kLineSamples; ++c) {
    const int upper_left = pixels.upper[c] & 255, upper_right = pixels.upper[c] >> 8;
    const int lower_left = pixels.lower[c] & 255, lower_right = pixels.lower[c] >> 8;
    const float s = pixels.right[c], t = pixels.below[c];
    const float upper = static_cast<float>(upper_left) + s * static_cast<float>(upper_right - upper_left);
    const float lower = static_cast<float>(lower_left) + s * static_cast<float>(lower_right - lower_left);
    const float grey = upper + t * (lower - upper);
    const float left_out = pixels.inside[c] != 0 ? 0 : std::numeric_limits<float>::quiet_NaN();
    greys[c] = grey + left_out;
    count += pixels.inside[c];
  }
  return count;
}

}  // namespace

int sampleLine(const LineView& line, const LinePlaces& y, const cv::Mat& image, const cv::Mat& mask,
               LineGreys& greys) {
  LinePlaces u, v;
  project(line, y, u, v);
  Pixels pixels;
  findPixels(u, v, image, mask, pixels);
  loadPixels(image, mask, pixels);
  return interpolate(pixels, greys);
}

UAV_LANDING_MULTIVERSION void averageLines(const LineGreys* lines, int count, LineGreys& mean) {
  for (int c = 0; c < kLineSamples; c += kLanes) {
    Lanes sum, more;
    load(&lines[0][c], sum);
    for (int i = 1; i < count; ++i) {
      load(&lines[i][c], more);
      sum += more;
    }
    store(sum / static_cast<float>(count), &mean[c]);
  }
}

}  // namespace uav_landing
