#include "stereo/matching/corner_matcher.h"

namespace uav_landing {
namespace {

class RowMatcher : public CornerMatcher {
 public:
  explicit RowMatcher(const StereoDepthParameters& parameters) : parameters_(parameters) {}

  std::vector<cv::Point> detect(const StereoLevel& level, const PlaneVector& g, int count) override {
    return findGroundCorners(level, g, count, parameters_, memory_);
  }
  RowMatches match(const StereoLevel& level, const std::vector<cv::Point>& corners,
                   const PlaneVector& g) override {
    return matchCorners(level, corners, g, parameters_);
  }

 private:
  StereoDepthParameters parameters_;
  GroundCornerMemory memory_;
};

}  // namespace

std::unique_ptr<CornerMatcher> makeRowMatcher(const StereoDepthParameters& parameters) {
  return std::make_unique<RowMatcher>(parameters);
}

}  // namespace uav_landing
