#include "datasets/decimal_time.h"

#include <boost/lexical_cast.hpp>
#include <cstdio>
#include <regex>

namespace uav_landing {

Expected<ros::Time> parseDecimalTime(const std::string& text) {
  static const std::regex pattern(R"((\d{1,10})(?:\.(\d*))?)");
  std::smatch match;
  uint64_t seconds = 0;
  if (!std::regex_match(text, match, pattern) ||
      !boost::conversion::try_lexical_convert(match[1].str(), seconds) || seconds > UINT32_MAX)
    return tl::make_unexpected(
        Failure{Reason::kInputInvalid, "\"" + text + "\" is not a time in seconds (0 to 4294967295)"});
  std::string fraction = match[2].str();
  fraction.resize(9, '0');
  const ros::Time time(static_cast<uint32_t>(seconds), boost::lexical_cast<uint32_t>(fraction));
  if (time.isZero())
    return tl::make_unexpected(Failure{Reason::kInputInvalid, "a stamp of 0 means that there is none"});
  return time;
}

std::string toDecimal(const ros::Time& time) {
  char text[32];
  std::snprintf(text, sizeof text, "%u.%09u", time.sec, time.nsec);
  return text;
}

}  // namespace uav_landing
