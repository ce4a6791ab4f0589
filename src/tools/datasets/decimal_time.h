#pragma once

#include <ros/time.h>

#include <string>

#include "uav_landing/base/failure.h"

namespace uav_landing {

/// Seconds as a decimal number ("100.1"), to the nanosecond; further digits are cut off. A double would be
/// wrong by up to 120 ns for today's stamps. It refuses text that is no such number, or that does not fit
/// into ros::Time. It also refuses zero, which means "no stamp".
Expected<ros::Time> parseDecimalTime(const std::string& text);

/// Seconds with 9 decimals.
std::string toDecimal(const ros::Time& time);

}  // namespace uav_landing
