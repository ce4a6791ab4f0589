#include "parameters/section_loader.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "base/text.h"
#include "parameters/moved_parameters.h"
#include "uav_landing/parameters/shared_parameters.h"

namespace uav_landing {
namespace {

/// Levenshtein distance of two words.
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}

template <class... Parts>
Failure invalid(const Parts&... parts) {
  return {Reason::kInputInvalid, text(parts...)};
}

}  // namespace

std::string suggestName(const std::string& word, const std::vector<std::string>& names) {
  constexpr std::size_t kLongestName = 100;  // a longer word is no misspelt name, and comparing it takes long
  if (word.size() > kLongestName) return "";
  const auto nearest = std::min_element(names.begin(), names.end(), [&](const auto& a, const auto& b) {
    return editDistance(word, a) < editDistance(word, b);
  });
  if (nearest == names.end() || 2 * editDistance(word, *nearest) > word.size()) return "";
  return "; did you mean " + *nearest + "?";
}

std::string whereItBelongs(const std::string& section, const std::string& key) {
  for (const MovedParameter& moved : kMovedParameters)
    if (section + "/" + key == moved.was) return text("has moved to ", moved.now);
  bool shared = false;
  SharedParameters().visitSections([&](const char* name, auto&) { shared = shared || key == name; });
  return shared ? "is a section of its own, expected beside " + section : "";
}

Failure checkMap(const YAML::Node& node, const std::string& section) {
  if (node.IsNull()) return {};
  if (!node.IsMap())
    return invalid(section, section.empty() ? "" : ": ", "expected a map of names and values");
  std::set<std::string> seen;
  for (const auto& entry : node) {
    if (!entry.first.IsScalar())
      return invalid(section, section.empty() ? "" : ": ", "a name is not a plain word");
    if (!seen.insert(entry.first.Scalar()).second)
      return invalid(section, section.empty() ? "" : "/", entry.first.Scalar(), ": is given twice");
  }
  return {};
}

Failure SectionLoader::finish() const {
  if (failure_ || !node_.IsMap()) return failure_;
  for (const auto& entry : node_) {
    const std::string key = entry.first.Scalar();
    if (std::find(names_.begin(), names_.end(), key) != names_.end()) continue;
    const std::string elsewhere = whereItBelongs(section_, key);
    return invalid(section_, "/", key, ": ",
                   elsewhere.empty() ? "no such parameter" + suggestName(key, names_) : elsewhere);
  }
  return {};
}

}  // namespace uav_landing
