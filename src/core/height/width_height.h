#pragma once

#include <optional>

namespace uav_landing {

/// Height from the width of the runway: h = W / w with w the width seen in multiples of the height (between
/// the outermost edges, from the ground's attitude and the picture alone). W is known from a
/// chart, or learned from heights by stereo. A chart has the width of the surface, and stripes lie inside it:
/// its width is as uncertain as that, until stereo tells better. Where the place of the stripes is given
/// closely, the width is exact to 0.2 % and remains. A learned width has the errors of those
/// heights: it carries on where stereo fails, but says nothing new where it does not.
class WidthHeight {
 public:
  struct Estimate {
    double height = 0, variance = 0;  ///< m, m^2
    double common = 0;  ///< the part of the variance that is the width's own: the same on all pairs
  };

  /// known_width: m, 0: learned. largest_inset: by which the edges that show may lie inside it, m.
  explicit WidthHeight(double known_width, double largest_inset = 0);

  /// Of one pair. ratio, variance: width over height as seen. Nothing before a width is known.
  std::optional<Estimate> height(double ratio, double variance) const;
  /// Whether the edges seen are those that the width was learned from or is known of, rather than, for
  /// instance, the other sides of the lines along the runway: by the height (m, m^2) that is expected without
  /// this pair. Once they were others they remain so until they differ by no more than what is uncertain
  /// besides the height, of which less and less is known while stereo is out. ratio and variance as height()
  /// takes them.
  bool isSame(double ratio, double variance, double height, double height_variance);
  /// A pair with a height by stereo (m, m^2) that is believed. It says nothing of a width that is known
  /// better. Other edges take the place of those before
  /// when some pairs in a row saw them.
  void learn(double ratio, double variance, double height, double height_variance);
  /// Whether the width does not depend on stereo.
  bool independent() const { return known_; }

 private:
  struct Width {
    double mean = 0, variance = 0;  // m, m^2
    int pairs = 0;                  // in a row that agree
  };
  static Width seen(double ratio, double variance, double height, double height_variance);
  static bool agree(const Width& a, const Width& b);
  static void merge(const Width& seen, Width& width);

  bool known_;                          // the width is the chart's alone
  bool learns_;                         // the place of the edges that show is not known
  std::optional<Width> width_, other_;  // other_: seen by the last pairs in the place of the edges of width_
  bool changed_ = false;                // the edges: were not those of width_, nor have they been since
};

}  // namespace uav_landing
