// Compares the errors of the stereo plane with the Cramer-Rao bound, over noise levels and heights, in
// simulated pairs. Writes a CSV: one row for each noise and height.

#include <Eigen/Cholesky>
#include <cmath>
#include <fstream>
#include <iostream>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "command_line.h"
#include "pending_file.h"
#include "progress_bar.h"
#include "uav_landing/simulator/renderer.h"
#include "uav_landing/simulator/sensor.h"
#include "uav_landing/stages/stereo_depth_stage.h"

namespace {

using namespace uav_landing;

constexpr double kDegree = M_PI / 180.0;

struct Options {
  std::string output;
  std::vector<double> noises = {1, 2, 4, 8}, heights = {2, 5, 10, 20, 40};
  int scenes = 12, pairs = 4;
};

/// Height (m), pitch and roll (rad): errors, or variances.
using Triple = Eigen::Array3d;

Triple heightPitchRoll(const GroundPlane& plane) {
  return {plane.height(), pitchOf(plane.normal()), rollOf(plane.normal())};
}

Triple variances(const GroundPlane& plane) {
  const Eigen::Vector3d n = plane.normal();
  const Eigen::Matrix3d covariance = plane.normalCovariance();
  return {plane.heightVariance(), pitchVariance(n, covariance), rollVariance(n, covariance)};
}

/// A pair of pictures of the same ground without noise, grey levels as 32-bit floats, and the true plane.
struct Scenery {
  StereoRig rig;
  RigModel model;
  GroundPlane truth;
  cv::Mat left, right;
};

/// Default approach at some height: path and attitude as drawn from the seed.
SimulatorParameters parametersOf(double height, int seed) {
  SimulatorParameters parameters;
  std::mt19937 random(static_cast<unsigned>(1000 * height) + static_cast<unsigned>(seed));
  const double along = static_cast<double>(random() % 1000) / 1000;
  parameters.path.start_height = height;
  parameters.path.start_x = 280 + 100 * (along - 0.5) - height / std::tan(3.5 * kDegree);
  parameters.random.seed = seed;
  return parameters;
}

Expected<Scenery> render(const SimulatorParameters& parameters) {
  const Expected<CameraRig> rig = makeCameraRig(parameters);
  if (!rig) return tl::make_unexpected(rig.error());
  const Expected<RigModel> model = makeRigModel(rig->left.calibration, rig->right.calibration);
  if (!model) return tl::make_unexpected(model.error());
  Scenery scenery;
  scenery.model = *model;
  scenery.rig = model->rig;
  const Trajectory trajectory(parameters.path, parameters.wobble, parameters.gust, parameters.random.seed);
  const CameraPose pose = trajectory.pose(0);
  const Eigen::Matrix3d rotation = runwayFromOptical(pose.attitude);
  scenery.truth.g = rotation.transpose() * -Eigen::Vector3d::UnitZ() / pose.position.z();
  const Renderer renderer(Scene(parameters.runway, parameters.surface, parameters.random.seed), {},
                          parameters.image.supersampling);
  const auto picture = [&](const SimulatedCamera& camera, cv::Mat& image) {
    renderer.render(camera, pose, image);
    const double blur = parameters.image.blur;
    cv::GaussianBlur(image, image, cv::Size(), blur, blur, cv::BORDER_REPLICATE);
  };
  picture(rig->left, scenery.left);
  picture(rig->right, scenery.right);
  return scenery;
}

/// Covariance of g at noise of 1 grey level, by the Fisher information of the left image's gradients over the
/// ground that both see, with gain and offset between the images unknown. Left and right are two noisy views
/// of one unknown texture: their difference has twice the variance of each (more exactly, the right one
/// samples it 1 - a times as densely, with the disparity changing by a for each column).
Eigen::Matrix3d boundAtUnitNoise(const Scenery& scenery) {
  using Matrix5d = Eigen::Matrix<double, 5, 5>;
  using Vector5d = Eigen::Matrix<double, 5, 1>;
  const StereoRig& rig = scenery.rig;
  const double density = 1 - rig.fb() * scenery.truth.g.x() / rig.fx;
  const double variance = 1 + 1 / density;
  Matrix5d information = Matrix5d::Zero();
  for (int v = 0; v < scenery.left.rows; ++v) {
    const float* row = scenery.left.ptr<float>(v);
    for (int u = 2; u + 2 < scenery.left.cols; ++u) {
      const double disparity = scenery.truth.disparity(rig, u, v);
      const double column = u - disparity - rig.principalOffset();
      if (!(disparity > 0 && column >= 0 && column <= scenery.left.cols - 1)) continue;
      const double gradient = (8 * (row[u + 1] - row[u - 1]) - (row[u + 2] - row[u - 2])) / 12;
      Vector5d derivative;
      derivative << gradient / density * rig.fb() * rig.ray(u, v), row[u] / 100.0, 1.0;
      information += derivative * derivative.transpose() / variance;
    }
  }
  return information.ldlt().solve(Matrix5d::Identity()).topLeftCorner<3, 3>();
}

/// Sums over the pairs of one noise and height.
struct Sums {
  int pairs = 0, failed = 0;
  Triple bound = Triple::Zero(), claimed = Triple::Zero(), direct = Triple::Zero(), corners = Triple::Zero();
};

cv::Mat exposed(const cv::Mat& light, double noise, uint64_t seed) {
  SimulatedImageParameters image;
  image.blur = 0;
  image.noise = noise;
  cv::Mat grey = light.clone(), mono8;
  expose(image, SimulatedCameraParameters(), seed * 0x9E3779B97F4A7C15ULL, grey, mono8);
  return mono8;
}

void measure(const Scenery& scenery, const Eigen::Matrix3d& unit_bound, double noise, uint64_t seed,
             int pairs, Sums& sums) {
  StereoDepthParameters with, without;
  without.direct_refinement = false;
  with.disparity_bias_stddev = 0;
  StereoDepthStage direct(scenery.model, with), corners(scenery.model, without);
  GroundPlane bound = scenery.truth;
  bound.covariance = noise * noise * unit_bound;
  for (int i = 0; i < pairs; ++i) {
    const cv::Mat left = exposed(scenery.left, noise, seed + 2 * i);
    const cv::Mat right = exposed(scenery.right, noise, seed + 2 * i + 1);
    const StereoDepthResult refined = direct.process(i + 1, left, right);
    const StereoDepthResult plain = corners.process(i + 1, left, right);
    if (refined.failure || plain.failure) {
      ++sums.failed;
      continue;
    }
    ++sums.pairs;
    sums.bound += variances(bound);
    sums.claimed += variances(refined.plane);
    sums.direct += (heightPitchRoll(refined.plane) - heightPitchRoll(scenery.truth)).square();
    sums.corners += (heightPitchRoll(plain.plane) - heightPitchRoll(scenery.truth)).square();
  }
}

void writeRow(std::ostream& out, double noise, double height, const Sums& sums) {
  out << noise << ',' << height << ',' << sums.pairs << ',' << sums.failed;
  const Triple unit(1, 1 / kDegree, 1 / kDegree);
  for (const Triple& squares : {sums.bound, sums.claimed, sums.direct, sums.corners}) {
    const Triple root = (squares / sums.pairs).sqrt() * unit;
    out << ',' << root[0] << ',' << root[1] << ',' << root[2];
  }
  out << '\n';
}

Failure run(const Options& options) {
  PendingFile pending(options.output);
  std::ofstream out(pending.temporary());
  if (!out) return {Reason::kInputInvalid, options.output + ": cannot be written"};
  out << "noise,height_m,pairs,failed";
  for (const char* kind : {"bound", "claimed", "rms", "corners_rms"}) {
    out << ',' << kind << "_height_m," << kind << "_pitch_deg," << kind << "_roll_deg";
  }
  out << '\n';
  ProgressBar progress(static_cast<int>(options.heights.size()) * options.scenes);
  for (const double height : options.heights) {
    std::vector<Sums> sums(options.noises.size());
    for (int scene = 1; scene <= options.scenes; ++scene, progress.step()) {
      const Expected<Scenery> scenery = render(parametersOf(height, scene));
      if (!scenery) return scenery.error();
      const Eigen::Matrix3d unit_bound = boundAtUnitNoise(*scenery);
      for (size_t i = 0; i < options.noises.size(); ++i) {
        const uint64_t seed =
            2 * static_cast<uint64_t>(options.pairs) * (scene * options.noises.size() + i) + 1;
        measure(*scenery, unit_bound, options.noises[i], seed, options.pairs, sums[i]);
      }
    }
    for (size_t i = 0; i < options.noises.size(); ++i) writeRow(out, options.noises[i], height, sums[i]);
  }
  out.close();
  if (!out) return {Reason::kInputInvalid, options.output + ": could not be written completely"};
  pending.commit();
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Compares the stereo plane's errors with the Cramer-Rao bound in simulated pairs.",
               "measure_noise_bound");
  Options options;
  app.add_option("--output", options.output, "CSV to write")->required();
  app.add_option("--noise", options.noises, "1 sigma of the sensors' noise, grey levels")
      ->check(CLI::Range(0.1, 50.0));
  app.add_option("--heights", options.heights, "m")->check(CLI::Range(0.5, 200.0));
  app.add_option("--scenes", options.scenes, "places and textures for each height")
      ->capture_default_str()
      ->check(CLI::Range(1, 10000));
  app.add_option("--pairs", options.pairs, "pairs with new noise for each of them")
      ->capture_default_str()
      ->check(CLI::Range(1, 10000));
  if (const auto status = parseCommandLine(app, argc, argv)) return *status;
  return exitStatusOf(app, options.output, [&] { return run(options); });
}
