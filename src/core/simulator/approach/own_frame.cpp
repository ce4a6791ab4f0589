#include "simulator/approach/own_frame.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {

OwnFrame::OwnFrame(const SimulatedOwnFrameParameters& frame, const SimulatedImageParameters& image,
                   Side camera) {
  if (frame.nose_height == 0 && frame.post_width == 0) return;
  light_ = cv::Mat::zeros(image.height, image.width, CV_32F);
  clear_ = cv::Mat::ones(image.height, image.width, CV_32F);
  if (frame.nose_height > 0) addNose(frame, camera);
  if (frame.post_width > 0) addPost(frame, camera);
}

void OwnFrame::cover(int row, int column, float share, float brightness) {
  light_.at<float>(row, column) += share * (brightness - light_.at<float>(row, column));
  clear_.at<float>(row, column) *= 1 - share;
}

void OwnFrame::addNose(const SimulatedOwnFrameParameters& frame, Side camera) {
  const double middle = (camera == Side::kLeft ? frame.nose_left : frame.nose_right) * clear_.cols - 0.5;
  const double half = 0.5 * frame.nose_width * clear_.cols, top = frame.nose_height * clear_.rows;
  for (int column = 0; column < clear_.cols; ++column) {
    // The outline is a parabola. Its distance in pixels is that along the column, shortened by the outline's
    // slope.
    const double at = (column - middle) / half;
    const double edge = clear_.rows - 0.5 - top * (1 - at * at);
    const double shorten = 1 / std::hypot(1.0, 2 * top * at / half);
    const double shine = 0.7 + 0.8 * std::exp(-30 * at * at);
    for (int row = std::max(0, static_cast<int>(edge - 2 / shorten)); row < clear_.rows; ++row)
      cover(row, column, static_cast<float>(std::clamp(0.5 + (row - edge) * shorten, 0.0, 1.0)),
            static_cast<float>(std::min(frame.nose_brightness * shine, 255.0)));
  }
}

void OwnFrame::addPost(const SimulatedOwnFrameParameters& frame, Side camera) {
  const bool left = camera == Side::kLeft;
  const double middle = (left ? frame.post_left : frame.post_right) * clear_.cols - 0.5;
  const double tilt = (left ? 1 : -1) * frame.post_tilt_deg * M_PI / 180;
  const double half = 0.5 * frame.post_width * clear_.cols;
  for (int row = 0; row < clear_.rows; ++row) {
    const double centre = middle - std::tan(tilt) * (row - 0.5 * (clear_.rows - 1));
    for (int column = 0; column < clear_.cols; ++column) {
      const double distance = std::abs(column - centre) * std::cos(tilt);
      const double share = std::clamp(0.5 + half - distance, 0.0, 1.0);
      if (share > 0) cover(row, column, static_cast<float>(share), static_cast<float>(frame.post_brightness));
    }
  }
}

void OwnFrame::draw(cv::Mat& grey) const {
  if (clear_.empty()) return;
  grey = grey.mul(clear_) + light_;
}

}  // namespace uav_landing
