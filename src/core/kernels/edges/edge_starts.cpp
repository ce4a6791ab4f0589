#include "kernels/edges/edge_starts.h"

#include "kernels/lanes/multiversion.h"

namespace uav_landing {

UAV_LANDING_MULTIVERSION void sobelRow(const uchar* __restrict a, const uchar* __restrict b,
                                       const uchar* __restrict c, int columns, short* __restrict along_row,
                                       short* __restrict down) {
  for (int u = 1; u < columns - 1; ++u) {
    const int left = a[u - 1] + 2 * b[u - 1] + c[u - 1], right = a[u + 1] + 2 * b[u + 1] + c[u + 1];
    const int above = a[u - 1] + 2 * a[u] + a[u + 1], below = c[u - 1] + 2 * c[u] + c[u + 1];
    along_row[u] = static_cast<short>(right - left);
    down[u] = static_cast<short>(below - above);
  }
}

UAV_LANDING_MULTIVERSION void markEdgeStarts(const short* __restrict along_row, const short* __restrict down,
                                             int columns, short least, uchar* __restrict starts) {
  const auto size = [](short s) { return static_cast<short>(s < 0 ? -s : s); };
  for (int u = 2; u < columns - 2; ++u) {
    const short here = size(along_row[u]), side = size(down[u]);
    const short before = size(along_row[u - 1]), after = size(along_row[u + 1]);
    const bool strong = static_cast<short>(here + side) >= least && here >= side;
    starts[u] = static_cast<uchar>(strong && before < here && after <= here);
  }
}

}  // namespace uav_landing
