// The calibrations of docs/bad_configurations.md, line by line.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "support/bad_configurations.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {
namespace {

CameraCalibration goodCamera(bool right) {
  CameraCalibration camera;
  camera.width = 320;
  camera.height = 240;
  camera.distortion_model = "plumb_bob";
  camera.D = {0, 0, 0, 0, 0};
  camera.K << 260, 0, 160, 0, 260, 120, 0, 0, 1;
  camera.R.setIdentity();
  camera.P << 260, 0, 160, right ? -260 * 0.3 : 0, 0, 260, 120, 0, 0, 0, 1, 0;
  return camera;
}

void setInt(const YAML::Node& fields, const char* name, int& value) {
  if (fields[name]) value = fields[name].as<int>();
}

template <class Matrix>
void setElements(const YAML::Node& elements, Matrix& matrix) {
  for (const auto& element : elements) {
    const int index = element.first.as<int>(), columns = static_cast<int>(matrix.cols());
    matrix(index / columns, index % columns) = element.second.as<double>();
  }
}

void change(const YAML::Node& fields, CameraCalibration& camera) {
  setInt(fields, "width", camera.width);
  setInt(fields, "height", camera.height);
  setInt(fields, "binning_x", camera.binning_x);
  setInt(fields, "binning_y", camera.binning_y);
  if (fields["distortion_model"]) camera.distortion_model = fields["distortion_model"].as<std::string>();
  if (fields["D"]) camera.D = fields["D"].as<std::vector<double>>();
  if (fields["K"]) setElements(fields["K"], camera.K);
  if (fields["R"]) setElements(fields["R"], camera.R);
  if (fields["P"]) setElements(fields["P"], camera.P);
  if (fields["roi"]) {
    setInt(fields["roi"], "x_offset", camera.roi.x);
    setInt(fields["roi"], "y_offset", camera.roi.y);
    setInt(fields["roi"], "width", camera.roi.width);
    setInt(fields["roi"], "height", camera.roi.height);
  }
}

TEST(BadCalibrations, AreRefusedInTheWordsOfTheDocumentation) {
  ASSERT_TRUE(makeStereoRig(goodCamera(false), goodCamera(true)));
  for (const test::BadConfiguration& row : test::badConfigurations("Calibrations")) {
    CameraCalibration left = goodCamera(false), right = goodCamera(true);
    const YAML::Node given = YAML::Load(row.given);
    if (given["left"]) change(given["left"], left);
    if (given["right"]) change(given["right"], right);
    const auto rig = makeStereoRig(left, right);
    EXPECT_EQ(rig ? "accepted" : rig.error().detail, row.message) << row.given;
  }
}

}  // namespace
}  // namespace uav_landing
