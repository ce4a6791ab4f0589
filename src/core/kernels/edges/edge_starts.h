#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// Responses of Sobel's 3 x 3 kernels in the middle one of three rows of an image (mono8) with so many
/// columns: of the change along the row and of the change down the columns. The first and the last column are
/// not written.
void sobelRow(const uchar* above, const uchar* row, const uchar* below, int columns, short* along_row,
              short* down);

/// Sets 1 where a line may start, else 0. There, the size of the response along the row is larger than that
/// of the pixel before, not smaller than that of the pixel behind, and not smaller than that down the column.
/// Both sizes together are at least least. The two outermost columns at each end are not written.
void markEdgeStarts(const short* along_row, const short* down, int columns, short least, uchar* starts);

}  // namespace uav_landing
