#pragma once

#include <cmath>

namespace uav_landing {
namespace test {

constexpr double kDegree = M_PI / 180;

}  // namespace test
}  // namespace uav_landing
