#pragma once

#include <initializer_list>
#include <ostream>
#include <string>

namespace uav_landing {

/// Writes the parameters of a section (see parameters.h) as a Markdown table below a heading, one row each.
class TableWriter {
 public:
  TableWriter(std::ostream& out, const std::string& section) : out_(out) {
    out_ << "\n## " << section << "\n\n| name | default | range | unit | meaning |\n|---|---|---|---|---|\n";
  }

  template <class Number>
  void number(const char* name, Number value, double min, double max, const char* unit, const char* meaning) {
    begin(name);
    if (!(value != value))
      out_ << value;
    else
      out_ << "(not given)";
    out_ << " | " << min << " to " << max;
    end(unit, meaning);
  }
  void flag(const char* name, bool value, const char* meaning) {
    begin(name) << (value ? "true" : "false") << " | true, false";
    end("", meaning);
  }
  template <class Enum>
  void choice(const char* name, Enum value, std::initializer_list<const char*> choices, const char* meaning) {
    begin(name) << choices.begin()[static_cast<int>(value)] << " | ";
    for (const char* const& candidate : choices)
      out_ << (&candidate == choices.begin() ? "" : ", ") << candidate;
    end("", meaning);
  }
  void text(const char* name, const std::string& value, const char* meaning) {
    begin(name) << (value.empty() ? "(empty)" : value) << " | ";
    end("", meaning);
  }

 private:
  std::ostream& begin(const char* name) { return out_ << "| `" << name << "` | "; }
  void end(const char* unit, const char* meaning) { out_ << " | " << unit << " | " << meaning << " |\n"; }

  std::ostream& out_;
};

}  // namespace uav_landing
