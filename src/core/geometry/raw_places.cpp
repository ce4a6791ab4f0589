#include "geometry/raw_places.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "geometry/lens.h"

namespace uav_landing {

RawPlaces rawPlaces(const CameraCalibration& c, const Eigen::Matrix3d& projection, cv::Size size) {
  cv::Mat K, R, P;
  cv::eigen2cv(c.K, K);
  cv::eigen2cv(c.R, R);
  cv::eigen2cv(projection, P);
  // A lens without distortion needs no model, whatever its name. R and P still count.
  const cv::Mat D = isDistorted(c.D) ? cv::Mat(c.D, true) : cv::Mat();
  RawPlaces places;
  if (isFisheye(c.distortion_model, c.D))
    cv::fisheye::initUndistortRectifyMap(K, D, R, P, size, CV_32FC1, places.x, places.y);
  else
    cv::initUndistortRectifyMap(K, D, R, P, size, CV_32FC1, places.x, places.y);
  return places;
}

}  // namespace uav_landing
