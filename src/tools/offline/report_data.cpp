#include "offline/report_data.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "datasets/decimal_time.h"
#include "uav_landing/overlay/overlay.h"

namespace uav_landing {
namespace {

constexpr std::size_t kPictures = 5;

std::string madeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(folder + ": cannot be made: " + error.message());
  return folder;
}

}  // namespace

ReportData::ReportData(const std::string& folder, std::size_t pairs, const OverlayParameters& overlay)
    : folder_(madeFolder(folder)),
      expected_pairs_(pairs),
      overlay_(overlay),
      rows_(folder + "/timing_rows.csv"),
      table_(folder + "/timing.csv"),
      rows_file_(rows_.temporary()) {
  if (!rows_file_) throw std::runtime_error(folder + ": cannot be written to");
}

std::size_t ReportData::column(const std::string& part) {
  const auto known = std::find(columns_.begin(), columns_.end(), part);
  if (known != columns_.end()) return known - columns_.begin();
  columns_.push_back(part);
  return columns_.size() - 1;
}

void ReportData::take(const ProcessedPair& pair) {
  const std::size_t index = pairs_++;
  if (pair.unusable) return;
  Timings timings = pair.output.parts;
  cv::Mat picture;
  {
    const ScopedTimer timer(timings, "overlay");
    picture = drawOverlay(pair.rig, pair.output.left,
                          {pair.output.stereo, pair.output.approach, pair.output.landing}, overlay_);
  }
  std::vector<double> row;
  for (const auto& [part, ms] : timings.parts()) {
    const std::size_t i = column(part);
    if (row.size() <= i) row.resize(i + 1, kUnknown);
    row[i] = ms;
  }
  rows_file_ << toDecimal(pair.stamp);
  for (const double ms : row) {
    rows_file_ << ',';
    if (ms >= 0) rows_file_ << ms;
  }
  rows_file_ << '\n';

  for (std::size_t i = 0; i < kPictures; ++i)
    if (index == (2 * i + 1) * expected_pairs_ / (2 * kPictures)) return writePictures(pair, picture);
}

void ReportData::writePictures(const ProcessedPair& pair, const cv::Mat& overlay) const {
  char number[32];
  std::snprintf(number, sizeof number, "_%06zu.png", pairs_ - 1);
  const auto write = [&](const std::string& name, const cv::Mat& picture) {
    const std::string path = folder_ + "/" + name + number;
    const std::string temporary = path + ".part.png";
    if (!cv::imwrite(temporary, picture)) throw std::runtime_error(path + ": cannot be written");
    std::filesystem::rename(temporary, path);
  };
  const Pipeline::Output& output = pair.output;
  write("lines_left", drawLines(output.left, output.approach.left, overlay_));
  write("lines_right", drawLines(output.right, output.approach.right, overlay_));
  write("matches", drawMatches(pair.rig, output.left, output.right, output.stereo, overlay_));
  write("overlay", overlay);
}

void ReportData::finish() {
  // The columns are known only now, because rows end with the last column that they knew.
  rows_file_.close();
  std::ifstream rows(rows_.temporary());
  std::ofstream table(table_.temporary());
  table << "stamp_s";
  for (const std::string& name : columns_) table << ',' << name << "_ms";
  table << '\n';
  for (std::string line; std::getline(rows, line);) {
    const auto fields = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
    table << line << std::string(columns_.size() - fields, ',') << '\n';
  }
  table.close();
  if (!rows_file_ || !table) throw std::runtime_error(table_.path() + ": could not be written completely");
  table_.commit();
}

}  // namespace uav_landing
