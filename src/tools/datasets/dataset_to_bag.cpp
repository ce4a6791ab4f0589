// Turns a dataset folder into a bag: images, calibration and truth.

#include "bags/stereo_bag_writer.h"
#include "command_line.h"
#include "datasets/dataset.h"

namespace {

using namespace uav_landing;

Failure convert(const std::string& folder, const std::string& output, const std::string& camera) {
  const Expected<Dataset> dataset = readDataset(folder);
  if (!dataset) return dataset.error();
  const cv::Size left_size(dataset->left.width, dataset->left.height);
  const cv::Size right_size(dataset->right.width, dataset->right.height);
  StereoBagWriter writer(output, camera, dataset->left, dataset->right);
  for (const DatasetFrame& frame : dataset->frames) {
    const Expected<cv::Mat> left = readImage(frame.left, left_size);
    if (!left) return left.error();
    const Expected<cv::Mat> right = readImage(frame.right, right_size);
    if (!right) return right.error();
    writer.write(frame.stamp, *left, *right, frame.truth);
  }
  writer.finish();
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Turns a dataset folder into a bag of images, calibration and truth.", "dataset_to_bag");
  std::string folder, output, camera = "stereo";
  app.add_option("--dataset", folder, "folder with left/, right/, left.yaml, right.yaml and frames.csv")
      ->required();
  app.add_option("--output", output, "bag to write")->required();
  app.add_option("--camera", camera, "namespace of the camera topics")
      ->capture_default_str()
      ->check(isCameraName());
  if (const auto status = parseCommandLine(app, argc, argv)) return *status;
  return exitStatusOf(app, output, [&] { return convert(folder, output, camera); });
}
