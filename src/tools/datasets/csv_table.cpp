#include "datasets/csv_table.h"

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/lexical_cast.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace uav_landing {
namespace {

std::vector<std::string> splitFields(const std::string& line) {
  std::vector<std::string> fields;
  boost::split(fields, line, boost::is_any_of(","));
  for (std::string& field : fields) boost::trim(field);
  return fields;
}

Failure invalid(const std::string& detail) { return {Reason::kInputInvalid, detail}; }

}  // namespace

Expected<CsvTable> CsvTable::read(const std::string& path) {
  std::ifstream file(path);
  if (!file)
    return tl::make_unexpected(
        invalid(path + (std::filesystem::exists(path) ? ": cannot be opened" : ": no such file")));
  CsvTable table;
  table.path_ = path;
  std::string line;
  for (size_t line_number = 1; std::getline(file, line); ++line_number) {
    boost::trim(line);
    if (line.empty()) continue;
    std::vector<std::string> fields = splitFields(line);
    if (table.header_.empty()) {
      table.header_ = std::move(fields);
      continue;
    }
    if (fields.size() != table.header_.size())
      return tl::make_unexpected(invalid(path + ", line " + std::to_string(line_number) + ": " +
                                         std::to_string(fields.size()) + " fields, the header has " +
                                         std::to_string(table.header_.size())));
    table.rows_.push_back(std::move(fields));
    table.lines_.push_back(line_number);
  }
  if (table.header_.empty()) return tl::make_unexpected(invalid(path + ": empty, expected a header line"));
  for (const std::string& name : table.header_)
    if (std::count(table.header_.begin(), table.header_.end(), name) > 1)
      return tl::make_unexpected(invalid(path + ": column " + name + " is there twice"));
  return table;
}

std::optional<size_t> CsvTable::index(const std::string& column) const {
  const auto it = std::find(header_.begin(), header_.end(), column);
  if (it == header_.end()) return std::nullopt;
  return static_cast<size_t>(it - header_.begin());
}

Failure CsvTable::require(const std::string& column) const {
  if (has(column)) return {};
  return invalid(path_ + ": no column " + column + " (there are: " + boost::join(header_, ", ") + ")");
}

const std::string& CsvTable::text(size_t row, const std::string& column) const {
  static const std::string blank;
  const auto i = index(column);
  return i ? rows_.at(row)[*i] : blank;
}

Expected<double> CsvTable::number(size_t row, const std::string& column) const {
  const std::string& field = text(row, column);
  if (field.empty()) return std::nan("");
  double value = 0;
  if (!boost::conversion::try_lexical_convert(field, value) || !std::isfinite(value))
    return tl::make_unexpected(failure(row, column, "\"" + field + "\" is not a finite number"));
  return value;
}

Failure CsvTable::failure(size_t row, const std::string& column, const std::string& what) const {
  return invalid(path_ + ", line " + std::to_string(lines_.at(row)) + ", column " + column + ": " + what);
}

}  // namespace uav_landing
