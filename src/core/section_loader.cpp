#include "uav_landing/section_loader.h"

#include <algorithm>
#include <numeric>

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

}  // namespace

std::string suggestName(const std::string& word, const std::vector<std::string>& names) {
  const auto nearest = std::min_element(names.begin(), names.end(), [&](const auto& a, const auto& b) {
    return editDistance(word, a) < editDistance(word, b);
  });
  if (nearest == names.end() || 2 * editDistance(word, *nearest) > word.size()) return "";
  return "; did you mean " + *nearest + "?";
}

Failure SectionLoader::finish() const {
  if (failure_ || !node_.IsMap()) return failure_;
  for (const auto& entry : node_) {
    const std::string key = entry.first.Scalar();
    if (std::find(names_.begin(), names_.end(), key) == names_.end())
      return {Reason::kInputInvalid, section_ + "/" + key + ": no such parameter" + suggestName(key, names_)};
  }
  return {};
}

}  // namespace uav_landing
