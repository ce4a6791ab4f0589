#pragma once

#include <cmath>
#include <iomanip>
#include <ostream>
#include <string>

namespace uav_landing {

/// Writes the fields of one row of a CSV file: numbers with 12 significant digits, blank when not finite.
class CsvRow {
 public:
  explicit CsvRow(std::ostream& out) : out_(out) { out_ << std::setprecision(12); }
  CsvRow& text(const std::string& value) {
    out_ << (first_ ? "" : ",") << value;
    first_ = false;
    return *this;
  }
  CsvRow& number(double value) {
    text("");
    if (std::isfinite(value)) out_ << value;
    return *this;
  }
  CsvRow& flag(bool value) { return text(value ? "1" : "0"); }
  CsvRow& blank() { return text(""); }

 private:
  std::ostream& out_;
  bool first_ = true;
};

}  // namespace uav_landing
