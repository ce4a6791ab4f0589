#include "simulation/campaign_csv.h"

#include <cmath>
#include <stdexcept>

#include "csv_row.h"

namespace uav_landing {
namespace {

constexpr double kDegrees = 180 / M_PI;

const char* const kHeader =
    "seed,cell_height_m,noise,frame,time_s,valid,height_valid,angle_valid,reason,compute_ms,"
    "height_true_m,height_m,height_stddev_m,raw_height_m,raw_height_stddev_m,"
    "approach_angle_true_deg,approach_angle_deg,approach_angle_stddev_deg,"
    "raw_approach_angle_deg,raw_approach_angle_stddev_deg,"
    "pitch_true_deg,pitch_deg,pitch_stddev_deg,roll_true_deg,roll_deg,roll_stddev_deg,"
    "yaw_true_deg,yaw_deg,yaw_stddev_deg,x_true_m,x_m,x_stddev_m,y_true_m,y_m,y_stddev_m,"
    "stretch,bend_rx_deg,bend_ry_deg,bend_rz_deg,lens_rows_px,lens_tilt_deg,slope_change_deg,"
    "speed_true_m_s,speed_m_s,speed_stddev_m_s,runway_width_m,"
    "readout_time_s,vibration_hz,vibration_deg,chart,runway_length_m,"
    "height_above_runway_true_m,height_above_runway_m,height_above_runway_stddev_m,"
    "height_above_runway_known,height_above_runway_protection_level_m";

/// Truth, estimate and the estimate's standard deviation in one unit.
void quantity(CsvRow& row, double truth, double estimate, double variance, double unit) {
  row.number(truth * unit).number(estimate * unit).number(std::sqrt(variance) * unit);
}

}  // namespace

CampaignCsv::CampaignCsv(const std::string& path) : pending_(path), file_(pending_.temporary()) {
  if (!file_) throw std::runtime_error(path + ": cannot be written");
  file_ << kHeader << '\n';
}

void CampaignCsv::write(const Sample& sample, const SimulatorParameters& drawn, const Truth& truth,
                        const Pipeline::Output& output) {
  const LandingResult& landing = output.landing;
  CsvRow row(file_);
  row.text(std::to_string(sample.seed)).number(sample.cell_height).number(sample.noise);
  row.text(std::to_string(sample.frame)).number(sample.time);
  row.flag(landing.valid()).flag(landing.height_valid).flag(landing.angle_valid);
  row.text(toString(landing.failure.reason)).number(output.stages.total());
  quantity(row, truth.height, landing.height, landing.height_variance, 1);
  row.number(landing.raw_height).number(std::sqrt(landing.raw_height_variance));
  quantity(row, truth.approach_angle, landing.approach_angle, landing.approach_angle_variance, kDegrees);
  row.number(landing.raw_approach_angle * kDegrees);
  row.number(std::sqrt(landing.raw_approach_angle_variance) * kDegrees);
  quantity(row, truth.pitch, landing.pitch, landing.pitch_variance, kDegrees);
  quantity(row, truth.roll, landing.roll, landing.roll_variance, kDegrees);
  quantity(row, truth.yaw, landing.yaw, landing.yaw_variance, kDegrees);
  quantity(row, truth.x, landing.x, landing.x_variance, 1);
  quantity(row, truth.y, landing.y, landing.y_variance, 1);
  row.number(drawn.rig.stretch);
  row.number(drawn.rig.bend_rx_deg).number(drawn.rig.bend_ry_deg).number(drawn.rig.bend_rz_deg);
  row.number(drawn.rig.lens_rows).number(drawn.rig.lens_tilt_deg);
  row.number(drawn.profile.slope_after_deg - drawn.profile.slope_before_deg);
  quantity(row, truth.speed, landing.speed(), landing.speedVariance(), 1);
  row.number(drawn.runway.width);
  const SimulatedVibrationParameters& vibration = drawn.vibration;
  const Eigen::Vector3d amplitude(vibration.roll_deg, vibration.pitch_deg, vibration.yaw_deg);
  row.number(drawn.image.readout_time).number(vibration.frequency).number(amplitude.norm());
  row.flag(sample.chart).number(drawn.runway.length);
  quantity(row, sample.height_above_runway, landing.height_above_runway, landing.height_above_runway_variance,
           1);
  row.flag(landing.height_above_runway_known).number(landing.height_above_runway_protection_level);
  file_ << '\n';
}

void CampaignCsv::finish() {
  file_.close();
  if (!file_) throw std::runtime_error(pending_.path() + ": could not be written completely");
  pending_.commit();
}

}  // namespace uav_landing
