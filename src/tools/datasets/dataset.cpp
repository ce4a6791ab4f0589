#include "datasets/dataset.h"

#include <camera_calibration_parsers/parse.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <tuple>

#include "datasets/csv_table.h"
#include "datasets/decimal_time.h"

namespace uav_landing {
namespace {

namespace fs = std::filesystem;
constexpr double kRadiansPerDegree = boost::math::constants::degree<double>();

Failure invalid(const std::string& detail) { return {Reason::kInputInvalid, detail}; }

/// Checks the sizes of the matrices in a YAML file. camera_calibration_parsers ends the program when they
/// differ, and takes memory for any number of coefficients.
Failure checkMatrices(const std::string& path) {
  constexpr int kMostCoefficients = 100;
  if (fs::path(path).extension() == ".ini") return {};
  YAML::Node file;
  try {
    file = YAML::LoadFile(path);
  } catch (const YAML::Exception&) {
    return {};  // the parser reports what it cannot read
  }
  if (!file.IsMap()) return {};
  const auto possible = [](int count) { return count >= 0 && count < kMostCoefficients; };
  for (const auto& [name, rows, columns] : {std::tuple("camera_matrix", 3, 3),
                                            {"rectification_matrix", 3, 3},
                                            {"projection_matrix", 3, 4},
                                            {"distortion_coefficients", 0, 0}}) {
    const YAML::Node matrix = file[name];
    if (!matrix.IsDefined() || !matrix.IsMap()) continue;
    const YAML::Node data = matrix["data"];
    const size_t size = data.IsDefined() && data.IsSequence() ? data.size() : 0;
    const int numbers = static_cast<int>(std::min<size_t>(size, kMostCoefficients));
    const int given_rows = matrix["rows"].as<int>(-1), given_columns = matrix["cols"].as<int>(-1);
    const bool sizes = columns > 0 ? given_rows == rows && given_columns == columns
                                   : possible(given_rows) && possible(given_columns);
    if (!sizes || numbers != given_rows * given_columns)
      return invalid(path + ": " + name + ": " + std::to_string(given_rows) + " rows, " +
                     std::to_string(given_columns) + " cols and " + std::to_string(numbers) +
                     " numbers do not fit together");
  }
  return {};
}

/// Fills one truth field from its column, scaled; returns the failure of a field that is not a number.
Failure readTruthField(const CsvTable& table, size_t row, const std::string& column, double scale,
                       double& value) {
  const Expected<double> number = table.number(row, column);
  if (!number) return number.error();
  value = *number * scale;
  return {};
}

Failure readTruth(const CsvTable& table, size_t row, Truth& truth) {
  struct Field {
    const char* column;
    double scale;
    double* value;
  };
  const Field fields[] = {{"height_m", 1, &truth.height},
                          {"approach_angle_deg", kRadiansPerDegree, &truth.approach_angle},
                          {"foe_u_px", 1, &truth.foe.x()},
                          {"foe_v_px", 1, &truth.foe.y()},
                          {"speed_m_s", 1, &truth.speed},
                          {"pitch_deg", kRadiansPerDegree, &truth.pitch},
                          {"roll_deg", kRadiansPerDegree, &truth.roll},
                          {"yaw_deg", kRadiansPerDegree, &truth.yaw},
                          {"x_m", 1, &truth.x},
                          {"y_m", 1, &truth.y}};
  for (const Field& field : fields)
    if (Failure failure = readTruthField(table, row, field.column, field.scale, *field.value)) return failure;
  return {};
}

Failure readImagePath(const CsvTable& table, size_t row, const std::string& column, const fs::path& folder,
                      std::string& path) {
  const std::string& name = table.text(row, column);
  if (name.empty()) return table.failure(row, column, "blank, expected the name of an image");
  path = (folder / column / name).string();
  if (!fs::is_regular_file(path)) return table.failure(row, column, path + ": no such file");
  return {};
}

Failure readFrame(const CsvTable& table, size_t row, const fs::path& folder, DatasetFrame& frame) {
  const Expected<ros::Time> stamp = parseDecimalTime(table.text(row, "stamp_s"));
  if (!stamp) return table.failure(row, "stamp_s", stamp.error().detail);
  frame.stamp = *stamp;
  for (auto [column, path] : {std::pair("left", &frame.left), std::pair("right", &frame.right)})
    if (Failure failure = readImagePath(table, row, column, folder, *path)) return failure;
  return readTruth(table, row, frame.truth);
}

Expected<std::vector<DatasetFrame>> readFrames(const fs::path& folder) {
  const Expected<CsvTable> table = CsvTable::read((folder / "frames.csv").string());
  if (!table) return tl::make_unexpected(table.error());
  for (const char* column : {"stamp_s", "left", "right"})
    if (Failure failure = table->require(column)) return tl::make_unexpected(failure);
  if (table->rows() == 0)
    return tl::make_unexpected(invalid((folder / "frames.csv").string() + ": no frames"));
  std::vector<DatasetFrame> frames(table->rows());
  for (size_t row = 0; row < frames.size(); ++row) {
    if (Failure failure = readFrame(*table, row, folder, frames[row])) return tl::make_unexpected(failure);
    if (row > 0 && frames[row].stamp <= frames[row - 1].stamp)
      return tl::make_unexpected(table->failure(
          row, "stamp_s",
          "not after the stamp of the frame before (" + toDecimal(frames[row - 1].stamp) + ")"));
  }
  return frames;
}

/// NAME.yaml, .yml or .ini; ROS's parsers choose by the extension.
std::string calibrationIn(const fs::path& folder, const std::string& name) {
  for (const char* extension : {".yml", ".ini"})
    if (fs::is_regular_file(folder / (name + extension)) && !fs::exists(folder / (name + ".yaml")))
      return (folder / (name + extension)).string();
  return (folder / (name + ".yaml")).string();
}

bool hasPngSignature(const std::vector<unsigned char>& bytes) {
  static const unsigned char signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  return bytes.size() >= sizeof signature &&
         std::equal(std::begin(signature), std::end(signature), bytes.begin());
}

}  // namespace

Expected<sensor_msgs::CameraInfo> readCalibrationFile(const std::string& path) {
  if (!fs::is_regular_file(path)) return tl::make_unexpected(invalid(path + ": no such file"));
  if (const Failure failure = checkMatrices(path)) return tl::make_unexpected(failure);
  sensor_msgs::CameraInfo info;
  std::string name;
  if (!camera_calibration_parsers::readCalibration(path, name, info))
    return tl::make_unexpected(invalid(path + ": not a ROS camera calibration file"));
  if (info.width == 0 || info.height == 0)
    return tl::make_unexpected(invalid(path + ": image_width and image_height must be positive"));
  return info;
}

Expected<Dataset> readDataset(const std::string& folder) {
  if (!fs::is_directory(folder)) return tl::make_unexpected(invalid(folder + ": no such folder"));
  Dataset dataset;
  for (auto [name, info] : {std::pair("left", &dataset.left), std::pair("right", &dataset.right)}) {
    Expected<sensor_msgs::CameraInfo> read = readCalibrationFile(calibrationIn(folder, name));
    if (!read) return tl::make_unexpected(read.error());
    *info = *read;
  }
  Expected<std::vector<DatasetFrame>> frames = readFrames(folder);
  if (!frames) return tl::make_unexpected(frames.error());
  dataset.frames = std::move(*frames);
  return dataset;
}

Expected<cv::Mat> readImage(const std::string& path, cv::Size size) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return tl::make_unexpected(invalid(path + ": cannot be opened"));
  const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(file), {}};
  if (!hasPngSignature(bytes)) return tl::make_unexpected(invalid(path + ": not a PNG image"));
  const cv::Mat image = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  if (image.empty()) return tl::make_unexpected(invalid(path + ": damaged PNG image"));
  if (image.type() != CV_8UC1)
    return tl::make_unexpected(invalid(path + ": expected 8-bit grey (mono8), found " +
                                       std::to_string(image.channels()) + " channel(s) of " +
                                       std::to_string(8 * image.elemSize1()) + " bits"));
  if (image.size() != size)
    return tl::make_unexpected(invalid(path + ": " + std::to_string(image.cols) + "x" +
                                       std::to_string(image.rows) + ", the calibration says " +
                                       std::to_string(size.width) + "x" + std::to_string(size.height)));
  return image;
}

}  // namespace uav_landing
