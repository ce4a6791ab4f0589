#include "kernels/edges/falls.h"

#include <opencv2/core/hal/intrin.hpp>

namespace uav_landing {

unsigned markFalls(const uchar* middle, int sign, int least) {
  constexpr int kAtOnce = cv::v_uint8x16::nlanes;
  // Unsigned bytes are enough: where pixels get brighter the result is 0.
  const auto fall = [&](int k) { return cv::v_load(middle + k - sign) - cv::v_load(middle + k + sign); };
  const cv::v_uint8x16 lowest = cv::v_setall_u8(static_cast<uchar>(least));
  unsigned found = 0;
  for (const int first : {-kFallReach, kFallReach + 1 - kAtOnce}) {
    const cv::v_uint8x16 is_maximum =
        fall(first) >= cv::v_max(lowest, cv::v_max(fall(first - 1), fall(first + 1)));
    found |= static_cast<unsigned>(cv::v_signmask(is_maximum)) << (first + kFallReach);
  }
  return found;
}

}  // namespace uav_landing
