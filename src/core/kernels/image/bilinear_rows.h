#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>

namespace uav_landing {

/// Weights of pixels in bilinear interpolation are multiples of 1 / kBilinearOne.
constexpr int kBilinearOne = 32;

/// Adjacent pixels of a row of a result, with the source of each.
struct PlacedRow {
  const short* places;  ///< x and y of each: the upper left of four pixels
  const std::uint16_t*
      weights;        ///< of the right pixels in the lower byte, of the lower pixels in the upper byte
  const uchar* mask;  ///< 255 or 0 for each; the result is 0 where it is 0
  int count;
};

/// Bilinear interpolation of an image (mono8) at those places, in fixed point, rounded. All four pixels of
/// each place must be inside the image.
void blendRow(const cv::Mat& image, const PlacedRow& row, uchar* out);

/// Sources of sixteen adjacent pixels. Each half of them lies inside a window of 16 x 3 pixels. They are
/// bytes, because reading them takes much of the time.
struct SourceWindows {
  static constexpr int kPixels = 16, kHalf = 8, kColumns = 16, kRows = 3;
  static constexpr uchar kNextRow = 0x80;

  std::array<short, 2> x{}, y{};                         // first pixel of each half's window
  std::array<uchar, kPixels> place{}, right{}, below{};  // column, plus kNextRow; weights
};

/// Whether the processor can run blendWindows().
bool canBlendWindows();

/// The same as blendRow() for count pixels, at least sixteen, by as many windows as cover them. The last
/// window ends with the row.
void blendWindows(const cv::Mat& image, const SourceWindows* windows, int count, const uchar* mask,
                  uchar* out);

}  // namespace uav_landing
