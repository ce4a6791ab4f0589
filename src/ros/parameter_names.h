#pragma once

#include <initializer_list>
#include <string>
#include <vector>

namespace uav_landing {

/// The visitor (see uav_landing/parameters/parameters.h) that collects the names of a struct's parameters.
class NameCollector {
 public:
  template <class... Rest>
  void number(const char* name, Rest&&...) {
    names_.emplace_back(name);
  }
  template <class... Rest>
  void flag(const char* name, Rest&&...) {
    names_.emplace_back(name);
  }
  template <class... Rest>
  void text(const char* name, Rest&&...) {
    names_.emplace_back(name);
  }
  template <class Enum>
  void choice(const char* name, Enum&, std::initializer_list<const char*>, const char*) {
    names_.emplace_back(name);
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;
};

/// Names of all parameters of these structs, one struct after the other.
template <class... Sections>
std::vector<std::string> parameterNames() {
  NameCollector collector;
  (Sections().visit(collector), ...);
  return collector.names();
}

}  // namespace uav_landing
