// Looks for the runway in single photographs whose vanishing point is known. It counts how often the runway
// is found, and how often the result is wrong.

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <random>
#include <string>

#include "command_line.h"
#include "datasets/csv_table.h"
#include "geometry/half_plane.h"
#include "image/input/image_check.h"
#include "lines/segments/line_segments.h"
#include "lines/segments/stripe_line.h"
#include "runway/direction/runway_direction.h"
#include "runway/direction/runway_hypothesis.h"

namespace {

using namespace uav_landing;

constexpr double kDegree = M_PI / 180;
constexpr double kWrong = 1 * kDegree;
const double kClear = -std::log(kLargestDoubt);  // smallest margin of a direction that is claimed

struct Options {
  std::string folder;
  double normal_stddev_deg = 0.3;
  int draws = 20;
  bool normal_unknown = false;
};

struct Photograph {
  std::string name;
  cv::Mat image;
  StereoRig rig;
  Eigen::Vector3d direction;  // of the runway
};

struct Count {
  int draws = 0, found = 0, wrong = 0;
  double share(int part, int whole) const { return whole > 0 ? 100.0 * part / whole : 0; }
  void add(const Count& other) {
    draws += other.draws;
    found += other.found;
    wrong += other.wrong;
  }
};

Expected<Photograph> read(const std::string& folder, const CsvTable& table, size_t row) {
  Photograph photo;
  photo.name = table.text(row, "image");
  photo.image = cv::imread(folder + "/" + photo.name, cv::IMREAD_GRAYSCALE);
  if (photo.image.empty())
    return tl::make_unexpected(table.failure(row, "image", folder + "/" + photo.name + " is no image"));
  photo.rig.size = photo.image.size();
  double u = 0, v = 0;
  for (const auto& [column, value] : {std::pair<const char*, double*>{"focal_px", &photo.rig.fx},
                                      {"cx_px", &photo.rig.cx},
                                      {"cy_px", &photo.rig.cy},
                                      {"vp_u_px", &u},
                                      {"vp_v_px", &v}}) {
    const Expected<double> number = table.number(row, column);
    if (!number) return tl::make_unexpected(number.error());
    if (!std::isfinite(*number)) return tl::make_unexpected(table.failure(row, column, "a number is needed"));
    *value = *number;
  }
  if (!(photo.rig.fx > 0)) return tl::make_unexpected(table.failure(row, "focal_px", "expected above 0"));
  photo.rig.fy = photo.rig.fx;
  photo.rig.cx_right = photo.rig.cx;
  photo.direction = photo.rig.ray(u, v).normalized();
  return photo;
}

/// Normal of a camera without roll.
Eigen::Vector3d levelNormal(const Eigen::Vector3d& direction) {
  return direction.cross(Eigen::Vector3d::UnitX()).normalized();
}

/// Direction of the runway on ground with this normal, if one is claimed.
std::optional<Eigen::Vector3d> onGround(const Photograph& photo, const Eigen::Vector3d& normal,
                                        double stddev) {
  const ApproachAngleParameters parameters;
  const Eigen::Matrix3d K = photo.rig.K();
  const cv::Mat everywhere =
      erodeMask(cv::Mat(photo.image.size(), CV_8UC1, cv::Scalar(255)), parameters.window_radius + 2);
  cv::Mat ground(photo.image.size(), CV_8UC1);
  keepBelowHorizon(everywhere, K, normal, ground);
  const HeadingGate gate(K, normal, parameters.max_yaw_deg * kDegree);
  const std::vector<LineSegment> lines =
      withoutStripeBias(photo.image, ground, findLines({photo.image, ground}, parameters, &gate));
  const double variance = stddev * stddev + std::pow(parameters.runway_slope_stddev_deg * kDegree, 2);
  const RunwayPrior prior{normal, variance * Eigen::Matrix3d::Identity(), {}, {}, {}};
  const Expected<RunwayChoice> choice = findRunwayHypothesis(lines, K, parameters, prior);
  if (!choice || choice->margin < kClear) return std::nullopt;
  return choice->best.direction;
}

std::optional<Eigen::Vector3d> onUnknownGround(const Photograph& photo) {
  const cv::Mat everywhere = erodeMask(cv::Mat(photo.image.size(), CV_8UC1, cv::Scalar(255)),
                                       ApproachAngleParameters().window_radius + 2);
  RunwayDirectionMemory memory;
  Timings timings;
  const RunwayDirection found =
      findRunwayDirection({photo.rig, {photo.image, everywhere}, {photo.image, everywhere}}, nullptr,
                          ApproachAngleParameters(), memory, timings);
  if (!found.combined || found.combined->runway_margin < kClear) return std::nullopt;
  return found.combined->direction;
}

Count measure(const Photograph& photo, const Options& options, std::mt19937& random) {
  const double stddev = options.normal_stddev_deg * kDegree;
  std::normal_distribution<double> error;
  Count count;
  for (int i = 0; i < (options.normal_unknown ? 1 : options.draws); ++i) {
    Eigen::Vector3d normal = levelNormal(photo.direction);
    normal += stddev * error(random) * Eigen::Vector3d::UnitX();
    normal += stddev * error(random) * Eigen::Vector3d::UnitZ();
    const std::optional<Eigen::Vector3d> found =
        options.normal_unknown ? onUnknownGround(photo)
                               : onGround(photo, normal.normalized(), options.normal_stddev_deg * kDegree);
    ++count.draws;
    if (!found) continue;
    ++count.found;
    const auto azimuth = [](const Eigen::Vector3d& d) { return std::atan2(d.x(), d.z()); };
    if (std::abs(azimuth(*found) - azimuth(photo.direction)) > kWrong) ++count.wrong;
  }
  return count;
}

void print(const std::string& name, const Count& count) {
  std::cout << name << "  found " << std::fixed << std::setprecision(1)
            << count.share(count.found, count.draws) << " % of " << count.draws
            << ", of those more than 1 deg off " << count.share(count.wrong, count.found) << " %\n";
}

Failure run(const Options& options) {
  const Expected<CsvTable> table = CsvTable::read(options.folder + "/vanishing_points.csv");
  if (!table) return table.error();
  if (Failure failure = table->require("image")) return failure;
  std::mt19937 random(1);
  Count all;
  for (size_t row = 0; row < table->rows(); ++row) {
    const Expected<Photograph> photo = read(options.folder, *table, row);
    if (!photo) return photo.error();
    const Count count = measure(*photo, options, random);
    print(photo->name, count);
    all.add(count);
  }
  print("all", all);
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Looks for the runway in single photographs. Each has a row in FOLDER/vanishing_points.csv with image, "
      "focal_px, cx_px, cy_px, vp_u_px and vp_v_px, where its runway vanishes. The ground's normal is that "
      "of "
      "a camera without roll, turned at random.",
      "measure_runways");
  Options options;
  app.add_option("--photos", options.folder, "FOLDER")->required();
  app.add_option("--normal-stddev", options.normal_stddev_deg, "1 sigma of the normal, deg")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 5.0));
  app.add_option("--draws", options.draws, "normals for each photograph")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app.add_flag("--normal-unknown", options.normal_unknown, "nothing is known of the ground");
  if (const auto status = parseCommandLine(app, argc, argv)) return *status;
  return exitStatusOf(app, options.folder, [&] { return run(options); });
}
