#pragma once

#include <optional>

namespace uav_landing {

/// Height from the width of the runway: h = W / w. w is the seen width in multiples of the height. It is
/// measured between the outermost edges, and needs only the ground's attitude and the image. W is known from
/// a chart, or learned from heights by stereo. A chart has the width of the surface, and stripes lie inside
/// it: its width is as uncertain as that, until stereo tells better. Where the place of the stripes is given
/// closely, the width is exact to 0.2 % and remains. A learned width has the errors of those heights. It
/// carries on when stereo fails, but adds nothing while stereo works.
class WidthHeight {
 public:
  struct Estimate {
    double height = 0, variance = 0;  ///< m, m^2
    double common = 0;  ///< the part of the variance from the width itself, the same on all pairs
  };

  /// known_width: m, 0: learned. largest_inset: by which the edges that show may lie inside it, m.
  explicit WidthHeight(double known_width, double largest_inset = 0);

  /// The height by one pair. ratio, variance: width over height as seen. Nothing while no width is known.
  std::optional<Estimate> height(double ratio, double variance) const;
  /// Whether the edges seen are those whose width is known or was learned. They may be others, such as the
  /// other sides of the lines along the runway. The test uses the height (m, m^2) that is expected without
  /// this pair. Once other edges were seen, they remain others until the difference is within its uncertainty
  /// without that of the height. The latter does not count, because it grows while stereo is out. ratio and
  /// variance: as for height().
  bool isSame(double ratio, double variance, double height, double height_variance);
  /// Learns from a pair with a believed height by stereo (m, m^2). It says nothing of a width that is known
  /// better. Other edges replace the former ones when some pairs in a row have seen them.
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
  std::optional<Width> width_, other_;  // other_: seen by the last pairs in place of the edges of width_
  bool changed_ = false;                // other edges than those of width_ were seen, and those of width_
                                        // have not been seen since
};

}  // namespace uav_landing
