#pragma once

#include <initializer_list>
#include <ostream>
#include <sstream>
#include <string>

namespace uav_landing {

/// Writes a section's parameters (see parameters.h) as a table of Markdown below a heading, a row for each.
class TableWriter {
 public:
  TableWriter(std::ostream& out, const std::string& section) : out_(out) {
    out_ << "\n## " << section << "\n\n| name | default | range | unit | meaning |\n|---|---|---|---|---|\n";
  }

  template <class Number>
  void number(const char* name, Number value, double min, double max, const char* unit, const char* meaning) {
    std::ostringstream given, range;
    given << value;
    range << min << " to " << max;
    row(name, given.str(), range.str(), unit, meaning);
  }
  void flag(const char* name, bool value, const char* meaning) {
    row(name, value ? "true" : "false", "true, false", "", meaning);
  }
  template <class Enum>
  void choice(const char* name, Enum value, std::initializer_list<const char*> choices, const char* meaning) {
    std::string all;
    for (const char* candidate : choices) all += (all.empty() ? "" : ", ") + std::string(candidate);
    row(name, choices.begin()[static_cast<int>(value)], all, "", meaning);
  }
  void text(const char* name, const std::string& value, const char* meaning) {
    row(name, value.empty() ? "(empty)" : value, "", "", meaning);
  }

 private:
  void row(const char* name, const std::string& value, const std::string& range, const char* unit,
           const char* meaning) {
    out_ << "| `" << name << "` | " << value << " | " << range << " | " << unit << " | " << meaning << " |\n";
  }

  std::ostream& out_;
};

}  // namespace uav_landing
