#include "lines/vanishing/vanishing_consensus.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "kernels/samples/line_passes.h"
#include "lines/vanishing/vanishing_chance.h"

namespace uav_landing {

namespace {

// Attempts end when most likely so many pairs have been drawn that agree with the best direction. One is not
// enough, as not every such pair meets where it should.
constexpr double kPairsOfBest = 20;

/// Stores the line as most attempts need it.
void add(const VanishingCandidate& line, double tolerance, LineColumns& columns) {
  columns.middle_u.push_back(line.middle.x());
  columns.middle_v.push_back(line.middle.y());
  columns.along_u.push_back(line.along.x());
  columns.along_v.push_back(line.along.y());
  columns.across_u.push_back(line.line.x());
  columns.across_v.push_back(line.line.y());
  columns.top_u.push_back(line.top.x());
  columns.top_v.push_back(line.top.y());
  columns.half2.push_back(line.half * line.half);
  columns.reach.push_back(line.half + VanishingCandidate::kClearance);
  columns.tolerance2.push_back(tolerance * tolerance);
}

/// How much the lines speak for a direction.
class Score {
 public:
  explicit Score(const VanishingLines& lines) : lines_(lines) {
    groupPieces();
    columns_.reserve(lines.all().size());
    turns_.reserve(lines.all().size());
    impossible_.reserve(lines.all().size());
    for (const VanishingCandidate& line : lines.all()) {
      add(line, lines.toleranceOf(line), columns_);
      turns_.push_back(lines.toleranceOf(line) / line.half * lines.perTurn(line));
      impossible_.push_back(std::log1p(line.half / lines.parameters().ransac_tolerance));
    }
    fit_.resize(lines.all().size());
    agreeing_.resize(lines.all().size());
  }

  /// Evidence for a direction. Lines that pass through it count for it, by how well they pass. Lines that do
  /// not pass, or that could not be on the ground if this were its horizon, count against it. Lines that pass
  /// nearly everywhere do not count, however many they are. Of the pieces of one edge only the best counts.
  double of(const Eigen::Vector3d& direction) {
    length_ = 0;
    const Eigen::Vector3d V = lines_.K() * direction;
    // The formulas are those of VanishingCandidate.
    fitLines(columns_, V.x(), V.y(), V.z(), VanishingCandidate::kMaxHorizonSlope, lines_.count(),
             fit_.data());
    const double per_pixel = lines_.perPixel(V);
    std::fill(agreeing_.begin(), agreeing_.end(), 0.0);
    double impossible = 0;
    for (size_t i = 0; i < fit_.size(); ++i) {
      if (fit_[i] <= 0) continue;
      if (fit_[i] == kTopAbove) {
        impossible += impossible_[i];
        continue;
      }
      const double chance = chanceWithin(turns_[i] * lines_.all()[i].towards(V).norm() * per_pixel);
      if (chance >= kLikelyChance) continue;
      length_ += lines_.all()[i].half;
      double& best = agreeing_[edge_[i]];
      best = std::max(best, fit_[i] * evidenceOf(chance));
    }
    return std::accumulate(agreeing_.begin(), agreeing_.end(), -impossible);
  }
  /// Half the length of the lines that spoke for the last direction.
  double halfLength() const { return length_; }

 private:
  /// Numbers the edges. Lines that continue each other are pieces of one edge.
  void groupPieces() {
    constexpr double kSameEdge = 1.5;  // px
    const std::vector<VanishingCandidate>& lines = lines_.all();
    edge_.resize(lines.size());
    std::iota(edge_.begin(), edge_.end(), size_t(0));
    for (size_t i = 0; i < lines.size(); ++i) {
      for (size_t j = 0; j < i; ++j) {
        const double miss = std::max(std::abs(lines[i].line.dot(lines[j].middle.homogeneous())),
                                     std::abs(lines[j].line.dot(lines[i].middle.homogeneous())));
        if (miss >= kSameEdge) continue;
        edge_[i] = edge_[j];
        break;
      }
    }
  }

  const VanishingLines& lines_;
  std::vector<size_t> edge_;  // per line: the edge that it is a piece of
  LineColumns columns_;
  std::vector<double> turns_;       // angle on the ground by which a line may turn, over its distance from V
  std::vector<double> impossible_;  // evidence against V of a line above its horizon
  std::vector<double> fit_;         // of one attempt
  std::vector<double> agreeing_;    // by edge
  double length_ = 0;
};

/// Draws lines; longer ones are more likely.
class LineDraw {
 public:
  explicit LineDraw(const VanishingLines& lines) : cumulative_(lines.all().size()) {
    std::transform(lines.all().begin(), lines.all().end(), cumulative_.begin(),
                   [](const VanishingCandidate& line) { return line.half; });
    std::partial_sum(cumulative_.begin(), cumulative_.end(), cumulative_.begin());
  }

  int next() {
    // The generator gives the same numbers everywhere; the standard library's distributions do not.
    const double place = (random_() + 0.5) / 4294967296.0 * cumulative_.back();
    return static_cast<int>(std::lower_bound(cumulative_.begin(), cumulative_.end(), place) -
                            cumulative_.begin());
  }
  /// Number of draws that give kPairsOfBest pairs among lines that are together twice as long as half_length.
  double enough(double half_length) const {
    return kPairsOfBest * std::pow(cumulative_.back() / half_length, 2);
  }

 private:
  std::vector<double> cumulative_;
  std::mt19937 random_{1};
};

}  // namespace

std::optional<VanishingConsensus> findConsensus(const VanishingLines& lines) {
  Score score(lines);
  VanishingConsensus best{};
  double best_score = std::numeric_limits<double>::lowest(), best_length = 0;
  int tried = 0, meetings = 0;
  const auto attempt = [&](int i, int j) {
    if (i == j) return;
    ++tried;
    Eigen::Vector3d direction;
    if (!lines.meeting(i, j, direction)) return;
    ++meetings;
    const double s = score.of(direction);
    if (s <= best_score) return;
    best_score = s;
    best_length = score.halfLength();
    best.direction = direction;
  };
  const int count = lines.count(), pairs = count * (count - 1) / 2;
  const int iterations = lines.parameters().ransac_iterations;
  if (pairs <= iterations) {
    for (int i = 0; i < count; ++i)
      for (int j = i + 1; j < count; ++j) attempt(i, j);
    best.meetings = meetings;
  } else {
    LineDraw draw(lines);
    for (int k = 0; k < iterations && k < draw.enough(best_length); ++k) {
      const int i = draw.next(), j = draw.next();
      attempt(i, j);
    }
    best.meetings = static_cast<double>(meetings) / std::max(tried, 1) * pairs;
  }
  if (meetings == 0) return std::nullopt;
  return best;
}

}  // namespace uav_landing
