#pragma once

#include <unistd.h>

#include <boost/version.hpp>
#if BOOST_VERSION >= 107200
#include <boost/timer/progress_display.hpp>
#else
#include <boost/progress.hpp>
#endif
#include <iostream>
#include <optional>

namespace uav_landing {

/// A progress bar on stderr if this is a terminal, else nothing.
class ProgressBar {
 public:
  explicit ProgressBar(unsigned long steps) {
    if (isatty(STDERR_FILENO) != 0 && steps > 0) display_.emplace(steps, std::cerr);
  }
  void step() {
    if (display_) ++*display_;
  }

 private:
#if BOOST_VERSION >= 107200
  std::optional<boost::timer::progress_display> display_;
#else
  std::optional<boost::progress_display> display_;
#endif
};

}  // namespace uav_landing
