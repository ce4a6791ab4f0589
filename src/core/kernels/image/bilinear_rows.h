#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>

namespace uav_landing {

/// Weights of pixels in bilinear interpolation are in 1 / this.
constexpr int kBilinearOne = 32;

/// Pixels side by side of a row of a picture: where each comes from.
struct PlacedRow {
  const short* places;  ///< x and y of each, the upper left one of four pixels
  const std::uint16_t*
      weights;        ///< of the right pixels in the lower byte, of the lower ones in the upper byte
  const uchar* mask;  ///< 255 or 0 for each: what the result is 0 at
  int count;
};

/// Bilinear interpolation of an image (mono8) at those places, in fixed point, rounded. All four pixels of
/// each place must be in the image.
void blendRow(const cv::Mat& image, const PlacedRow& row, uchar* out);

/// Where sixteen pixels side by side come from, each half of them inside a window of 16 x 3 pixels. Bytes, as
/// reading these takes much of the time.
struct SourceWindows {
  static constexpr int kPixels = 16, kHalf = 8, kColumns = 16, kRows = 3;
  static constexpr uchar kNextRow = 0x80;

  std::array<short, 2> x{}, y{};                         // first pixel of each half's window
  std::array<uchar, kPixels> place{}, right{}, below{};  // column, plus kNextRow; weights
};

/// Whether the processor can do the following.
bool canBlendWindows();

/// The same as blendRow() for count pixels, sixteen or more, by as many windows as cover them; the last one
/// ends with the row.
void blendWindows(const cv::Mat& image, const SourceWindows* windows, int count, const uchar* mask,
                  uchar* out);

}  // namespace uav_landing
