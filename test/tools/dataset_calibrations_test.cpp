// Recorded rigs, of flights, cars and hands: none is unlikely.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "camera_info.h"
#include "datasets/dataset.h"
#include "support/test_data.h"
#include "uav_landing/geometry/rig_check.h"

namespace uav_landing {
namespace {

class DatasetCalibrations : public testing::TestWithParam<std::string> {};

TEST_P(DatasetCalibrations, AreNeitherRefusedNorWarnedAbout) {
  UAV_LANDING_DATASET(folder, GetParam());
  const auto left = readCalibrationFile((folder / "left.yaml").string()),
             right = readCalibrationFile((folder / "right.yaml").string());
  ASSERT_TRUE(left && right);
  const CameraCalibration l = toCalibration(*left), r = toCalibration(*right);
  const Expected<StereoRig> rig = makeStereoRig(l, r, RigParameters());
  EXPECT_TRUE(rig) << rig.error().detail;
  EXPECT_EQ(rigWarnings(l, r, RigParameters()), std::vector<std::string>());
}

INSTANTIATE_TEST_SUITE_P(, DatasetCalibrations,
                         testing::Values("lab", "fg_noon", "kitti_road", "kitti_raw", "highway", "indoor",
                                         "hand_held", "photo_valley", "photo_town", "photo_sea",
                                         "photo_cockpit"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace uav_landing
