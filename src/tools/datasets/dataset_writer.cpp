#include "datasets/dataset_writer.h"

#include <camera_calibration_parsers/parse.h>

#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>

#include "datasets/decimal_time.h"

namespace uav_landing {
namespace {

namespace fs = std::filesystem;
constexpr double kDegreesPerRadian = boost::math::constants::radian<double>();

Failure cannotWrite(const fs::path& path, const std::string& why = "") {
  return {Reason::kInputInvalid, path.string() + ": cannot be written" + (why.empty() ? "" : ": " + why)};
}

/// ",value" with 12 significant digits; "," when it is unknown.
std::string field(double value) {
  if (std::isnan(value)) return ",";
  char text[40];
  std::snprintf(text, sizeof text, ",%.12g", value);
  return text;
}

}  // namespace

DatasetWriter::DatasetWriter(const std::string& folder) {
  // The name has no slash at the end, so that the temporary folder is beside it.
  folder_ = fs::path(folder).has_filename() ? fs::path(folder) : fs::path(folder).parent_path();
  temporary_ = folder_.string() + ".active";
}

DatasetWriter::~DatasetWriter() {
  if (!open_) return;
  frames_.close();
  std::error_code ignored;
  fs::remove_all(temporary_, ignored);
}

Failure DatasetWriter::open(const sensor_msgs::CameraInfo& left, const sensor_msgs::CameraInfo& right) {
  std::error_code error;
  if (fs::exists(folder_, error) && !(fs::is_directory(folder_, error) && fs::is_empty(folder_, error)))
    return cannotWrite(folder_, "there is something already");
  if (!fs::create_directory(temporary_, error))
    return cannotWrite(temporary_, error ? error.message() : "there is something already");
  open_ = true;
  for (const char* side : {"left", "right"})
    if (!fs::create_directory(temporary_ / side, error))
      return cannotWrite(temporary_ / side, error.message());
  for (auto [name, info] : {std::pair("left", &left), std::pair("right", &right)}) {
    const fs::path path = temporary_ / (std::string(name) + ".yaml");
    if (!camera_calibration_parsers::writeCalibration(path.string(), name, *info)) return cannotWrite(path);
  }
  frames_.open(temporary_ / "frames.csv");
  frames_ << "stamp_s,left,right,height_m,approach_angle_deg,foe_u_px,foe_v_px,speed_m_s,pitch_deg,roll_deg,"
             "yaw_deg,"
             "x_m,y_m\n";
  return {};
}

Failure DatasetWriter::write(const ros::Time& stamp, const cv::Mat& left, const cv::Mat& right,
                             const Truth& truth) {
  char name[32];
  std::snprintf(name, sizeof name, "%06d.png", count_++);
  for (auto [side, image] : {std::pair("left", &left), std::pair("right", &right)})
    if (!cv::imwrite((temporary_ / side / name).string(), *image))
      return cannotWrite(temporary_ / side / name);
  frames_ << toDecimal(stamp) << ',' << name << ',' << name << field(truth.height)
          << field(truth.approach_angle * kDegreesPerRadian) << field(truth.foe.x()) << field(truth.foe.y())
          << field(truth.speed) << field(truth.pitch * kDegreesPerRadian)
          << field(truth.roll * kDegreesPerRadian) << field(truth.yaw * kDegreesPerRadian) << field(truth.x)
          << field(truth.y) << '\n';
  return frames_ ? Failure{} : cannotWrite(temporary_ / "frames.csv");
}

Failure DatasetWriter::finish() {
  frames_.close();
  if (!frames_) return cannotWrite(temporary_ / "frames.csv");
  std::error_code error;
  fs::rename(temporary_, folder_, error);
  if (error) return cannotWrite(folder_, error.message());
  open_ = false;
  return {};
}

}  // namespace uav_landing
