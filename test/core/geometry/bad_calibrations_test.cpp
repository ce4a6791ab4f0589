// The calibrations of docs/bad_configurations.md, line by line.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "support/bad_configurations.h"
#include "uav_landing/geometry/rig_check.h"

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

struct Pair {
  CameraCalibration left = goodCamera(false), right = goodCamera(true);
};

Pair changedBy(const std::string& yaml) {
  Pair pair;
  const YAML::Node given = YAML::Load(yaml);
  if (given["left"]) change(given["left"], pair.left);
  if (given["right"]) change(given["right"], pair.right);
  return pair;
}

std::string refusalOf(const Pair& pair) {
  const auto rig = makeStereoRig(pair.left, pair.right, RigParameters());
  return rig ? "accepted" : rig.error().detail;
}

TEST(BadCalibrations, AreRefusedInTheWordsOfTheDocumentation) {
  ASSERT_EQ(refusalOf(Pair()), "accepted");
  for (const test::BadConfiguration& row : test::badConfigurations("Calibrations"))
    EXPECT_EQ(refusalOf(changedBy(row.given)), row.message) << row.given;
}

TEST(UnlikelyCalibrations, AreWarnedAboutInTheWordsOfTheDocumentation) {
  for (const test::BadConfiguration& row : test::badConfigurations("Unlikely calibrations")) {
    const Pair pair = changedBy(row.given);
    EXPECT_EQ(refusalOf(pair), "accepted") << row.given;
    EXPECT_EQ(rigWarnings(pair.left, pair.right, RigParameters()), std::vector<std::string>{row.message})
        << row.given;
  }
}

}  // namespace
}  // namespace uav_landing
