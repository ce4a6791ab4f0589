#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// Responses of Sobel's 3 x 3 kernels in the middle one of three rows of an image (mono8), of so many
/// columns: of the change along the row and of that down the columns. The first and the last column are left
/// as they are.
void sobelRow(const uchar* above, const uchar* row, const uchar* below, int columns, short* along_row,
              short* down);

/// Sets 1 where the response along the row is, by its size, larger than that before and not smaller than that
/// behind, not smaller than the one down the column, and both together are at least least; 0 elsewhere. The
/// two outermost columns at each end are left as they are.
void markEdgeStarts(const short* along_row, const short* down, int columns, short least, uchar* starts);

}  // namespace uav_landing
