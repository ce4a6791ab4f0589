#pragma once

#include <optional>
#include <string>
#include <vector>

#include "uav_landing/base/failure.h"

namespace uav_landing {

/// A comma-separated file with a header line, read by column name. No quoting. Failures name the file, the
/// row (as a line number of the file) and the column.
class CsvTable {
 public:
  static Expected<CsvTable> read(const std::string& path);

  size_t rows() const { return rows_.size(); }
  bool has(const std::string& column) const { return index(column).has_value(); }
  /// Fails when the header has no such column.
  Failure require(const std::string& column) const;

  /// Text of a field; "" when it is blank or the column is missing.
  const std::string& text(size_t row, const std::string& column) const;
  /// A finite number; NaN when the field is blank or the column is missing.
  Expected<double> number(size_t row, const std::string& column) const;
  /// A failure that begins with the place: "frames.csv, line 7, column height_m: what".
  Failure failure(size_t row, const std::string& column, const std::string& what) const;

 private:
  std::optional<size_t> index(const std::string& column) const;

  std::string path_;
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
  std::vector<size_t> lines_;  ///< line number in the file of each row
};

}  // namespace uav_landing
