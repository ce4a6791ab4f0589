// Compares the errors of the stereo plane with the Cramer-Rao bound, over noise levels and heights, in
// simulated pairs. Writes a CSV: one row per noise level and height.

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
#include "simulator/approach/renderer.h"
#include "simulator/approach/sensor.h"
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

/// A pair of images of the same ground without noise, grey levels as 32-bit floats, and the true plane.
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
                          parameters.image);
  const auto picture = [&](const SimulatedCamera& camera, cv::Mat& image) {
    renderer.render(camera, pose, image);
    const double blur = renderer.blurLeft();
    if (blur > 0) cv::GaussianBlur(image, image, cv::Size(), blur, blur, cv::BORDER_REPLICATE);
  };
  picture(rig->left, scenery.left);
  picture(rig->right, scenery.right);
  return scenery;
}

using Matrix5d = Eigen::Matrix<double, 5, 5>;

/// Information of a patch of the left image on the plane, gain and offset.
struct Patch {
  // Fisher's information, at noise of 1 grey level, if the texture's gradients are known.
  Matrix5d information = Matrix5d::Zero();
  // Its spectrum: power spectral density, and this times the squared frequency along u.
  std::vector<double> power, slope;
};

constexpr int kPatch = 16;  // pixels

/// Periodogram of a patch (Hann window, without its mean). White noise has its variance at all frequencies.
void addSpectrum(const cv::Mat& image, int u, int v, Patch& patch) {
  cv::Mat window, part = image(cv::Rect(u, v, kPatch, kPatch)).clone(), spectrum;
  cv::createHanningWindow(window, cv::Size(kPatch, kPatch), CV_32F);
  part -= cv::mean(part);
  cv::dft(part.mul(window), spectrum, cv::DFT_COMPLEX_OUTPUT);
  const double energy = window.dot(window);
  for (int y = 0; y < kPatch; ++y) {
    for (int x = 1; x < kPatch; ++x) {
      const cv::Vec2f& value = spectrum.at<cv::Vec2f>(y, x);
      const double frequency = 2 * M_PI * std::min(x, kPatch - x) / kPatch;
      patch.power.push_back(value.dot(value) / energy);
      patch.slope.push_back(frequency * frequency * patch.power.back());
    }
  }
}

/// Information of those pixels of a patch that are ground and in both images. Left and right are two noisy
/// views of one unknown texture, so their difference has twice the variance of each. (More exactly, the right
/// one samples it 1 - a times as densely, if the disparity changes by a per column.)
Matrix5d informationOf(const Scenery& scenery, int left, int top) {
  const StereoRig& rig = scenery.rig;
  const cv::Mat& image = scenery.left;
  const double density = 1 - rig.fb() * scenery.truth.g.x() / rig.fx;
  const double variance = 1 + 1 / density;
  Matrix5d information = Matrix5d::Zero();
  for (int v = top; v < top + kPatch; ++v) {
    const float* row = image.ptr<float>(v);
    for (int u = std::max(2, left); u < std::min(left + kPatch, image.cols - 2); ++u) {
      const double disparity = scenery.truth.disparity(rig, u, v);
      const double column = u - disparity - rig.principalOffset();
      if (!(disparity > 0 && column >= 0 && column <= image.cols - 1)) continue;
      const double gradient = (8 * (row[u + 1] - row[u - 1]) - (row[u + 2] - row[u - 2])) / 12;
      Eigen::Matrix<double, 5, 1> derivative;
      derivative << gradient / density * rig.fb() * rig.ray(u, v), row[u] / 100.0, 1.0;
      information += derivative * derivative.transpose() / variance;
    }
  }
  return information;
}

std::vector<Patch> groundPatches(const Scenery& scenery) {
  std::vector<Patch> patches;
  for (int top = 0; top + kPatch <= scenery.left.rows; top += kPatch) {
    for (int left = 0; left + kPatch <= scenery.left.cols; left += kPatch) {
      Patch patch;
      patch.information = informationOf(scenery, left, top);
      if (patch.information.isZero()) continue;
      addSpectrum(scenery.left, left, top, patch);
      patches.push_back(std::move(patch));
    }
  }
  return patches;
}

/// Share of the information that remains when the texture is unknown as well. At a frequency with the power
/// S, two noisy views agree as if each had the share S / (S + N) of the texture. Of S / 2N, S^2 / (N (2 S +
/// N)) remains (the delay between two receivers: Knapp, Carter, 1976).
double shareOfUnknownTexture(const Patch& patch, double noise) {
  double known = 0, unknown = 0;
  for (size_t i = 0; i < patch.power.size(); ++i) {
    known += patch.slope[i];
    unknown += patch.slope[i] * 2 * patch.power[i] / (2 * patch.power[i] + noise * noise);
  }
  return known > 0 ? unknown / known : 0;
}

/// Smallest covariances of g that an unbiased estimator can have. known: when the gradients of the texture
/// are known. unknown: with the two images only. Gain and offset between the images are not known in either
/// case.
struct Bounds {
  Eigen::Matrix3d known, unknown;
};

Bounds boundsAt(const std::vector<Patch>& patches, double noise) {
  Matrix5d known = Matrix5d::Zero(), unknown = Matrix5d::Zero();
  for (const Patch& patch : patches) {
    known += patch.information / (noise * noise);
    unknown += shareOfUnknownTexture(patch, noise) * patch.information / (noise * noise);
  }
  const auto ofPlane = [](const Matrix5d& information) -> Eigen::Matrix3d {
    return information.ldlt().solve(Matrix5d::Identity()).topLeftCorner<3, 3>();
  };
  return {ofPlane(known), ofPlane(unknown)};
}

/// Sums over the pairs of one noise level and height.
struct Sums {
  int pairs = 0, failed = 0;
  Triple bound = Triple::Zero(), unknown = Triple::Zero(), claimed = Triple::Zero();
  Triple direct = Triple::Zero(), corners = Triple::Zero();
};

cv::Mat exposed(const cv::Mat& light, double noise, uint64_t seed) {
  SimulatedImageParameters image;
  image.blur = 0;
  image.noise = noise;
  cv::Mat grey = light.clone(), mono8;
  expose(image, SimulatedCameraParameters(), seed * 0x9E3779B97F4A7C15ULL, grey, mono8);
  return mono8;
}

void measure(const Scenery& scenery, const Bounds& bounds, double noise, uint64_t seed, int pairs,
             Sums& sums) {
  StereoDepthParameters with;
  with.search_at_once = true;
  StereoDepthParameters without = with;
  without.direct_refinement = false;
  with.disparity_bias_stddev = with.row_bias_stddev = 0;
  StereoDepthStage direct(scenery.model, with), corners(scenery.model, without);
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
    sums.bound += variances({scenery.truth.g, bounds.known});
    sums.unknown += variances({scenery.truth.g, bounds.unknown});
    sums.claimed += variances(refined.plane);
    sums.direct += (heightPitchRoll(refined.plane) - heightPitchRoll(scenery.truth)).square();
    sums.corners += (heightPitchRoll(plain.plane) - heightPitchRoll(scenery.truth)).square();
  }
}

void writeRow(std::ostream& out, double noise, double height, const Sums& sums) {
  out << noise << ',' << height << ',' << sums.pairs << ',' << sums.failed;
  const Triple unit(1, 1 / kDegree, 1 / kDegree);
  for (const Triple& squares : {sums.bound, sums.unknown, sums.claimed, sums.direct, sums.corners}) {
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
  for (const char* kind : {"bound", "unknown_texture_bound", "claimed", "rms", "corners_rms"}) {
    out << ',' << kind << "_height_m," << kind << "_pitch_deg," << kind << "_roll_deg";
  }
  out << '\n';
  ProgressBar progress(static_cast<int>(options.heights.size()) * options.scenes);
  for (const double height : options.heights) {
    std::vector<Sums> sums(options.noises.size());
    for (int scene = 1; scene <= options.scenes; ++scene, progress.step()) {
      const Expected<Scenery> scenery = render(parametersOf(height, scene));
      if (!scenery) return scenery.error();
      const std::vector<Patch> patches = groundPatches(*scenery);
      for (size_t i = 0; i < options.noises.size(); ++i) {
        const uint64_t seed =
            2 * static_cast<uint64_t>(options.pairs) * (scene * options.noises.size() + i) + 1;
        const Bounds bounds = boundsAt(patches, options.noises[i]);
        measure(*scenery, bounds, options.noises[i], seed, options.pairs, sums[i]);
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
