#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

namespace uav_landing {

/// Learns where the aircraft's own frame, such as its nose or a strut, is in one camera's image. Corners of
/// its edges are strong and never match, so they would take the place of corners on the ground.
/// The image is cut into cells, and each is compared with itself a moment ago. Cells with all of these
/// properties belong to the frame, after several looks in a row:
/// - They have edges, and these have stayed in place to half a pixel.
/// - Corners in them were looked for, and none was found on the ground; or they adjoin such cells.
/// - The ground beside and above them, which moves less, has moved.
/// So nothing is masked while the camera stands still. Ground is not masked, as its corners are found on it.
/// Objects near the horizon are not masked, as the ground above them stays, too. A cell comes back when its
/// content moves. Flickering things, such as a propeller, have no edges that stay and are not learned; nor is
/// a surface without edges.
class LearnedFrame {
 public:
  explicit LearnedFrame(const cv::Size& size);

  /// image: rectified mono8. tried: corners that were looked for in the other image. on_ground: those of them
  /// that were found on the ground plane. stamp: s. A stamp that is not after the last one, or long after it,
  /// starts anew.
  void observe(double stamp, const cv::Mat& image, const std::vector<cv::Point>& tried,
               const std::vector<cv::Point>& on_ground);
  void reset();

  bool empty() const { return left_out_ == 0; }
  /// Share of the image that is frame.
  double share() const;
  /// The mask with 0 on the frame and within margin pixels of it. Valid until the next call.
  cv::Mat leftOut(const cv::Mat& mask, int margin);

 private:
  static constexpr int kSize = 8;  // px, side of a cell
  enum class Change { kUnknown, kFlat, kStays, kMoves };
  struct Cell {
    std::array<uchar, kSize * kSize> grey{};  // at the last look
    Change change = Change::kUnknown;         // since then
    bool tried = false, on_ground = false;    // such a corner was in it since then
    int stays = 0, fails = 0;                 // looks in a row
    bool own = false;
  };

  void look(const cv::Mat& image);
  void compare(const cv::Mat& image);
  void count(int row);
  bool groundMoves(int row) const;
  void findFrame();
  void keep(const cv::Mat& image);
  Cell* at(const cv::Point& pixel);

  cv::Size size_, cells_;
  std::vector<Cell> all_;          // row by row
  double stamp_ = 0, looked_ = 0;  // of the last pair, and of the last look, s
  bool known_ = false;             // cells were kept at the last look
  int left_out_ = 0;
  cv::Mat mask_;  // without the frame
};

}  // namespace uav_landing
