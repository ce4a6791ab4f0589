#include "lines/vanishing_consensus.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "kernels/lanes/multiversion.h"
#include "lines/vanishing_chance.h"

namespace uav_landing {

namespace {

constexpr double kRunwayShare = 0.25;  // of the lines, that are along the runway
// Attempts end when this many pairs of lines that agree with the best direction must have been drawn, most
// likely: not every one of them meets where it should.
constexpr double kPairsOfBest = 20;

/// The lines' numbers that most attempts need, by column.
struct LineColumns {
  std::vector<double> middle_u, middle_v, along_u, along_v, across_u, across_v, top_u, top_v;
  std::vector<double> half2, reach, tolerance2;  // half: length; reach: with the clearance

  void reserve(size_t count) {
    for (std::vector<double>* column : {&middle_u, &middle_v, &along_u, &along_v, &across_u, &across_v,
                                        &top_u, &top_v, &half2, &reach, &tolerance2})
      column->reserve(count);
  }
  void add(const VanishingCandidate& line, double tolerance) {
    middle_u.push_back(line.middle.x());
    middle_v.push_back(line.middle.y());
    along_u.push_back(line.along.x());
    along_v.push_back(line.along.y());
    across_u.push_back(line.line.x());
    across_v.push_back(line.line.y());
    top_u.push_back(line.top.x());
    top_v.push_back(line.top.y());
    half2.push_back(line.half * line.half);
    reach.push_back(line.half + VanishingCandidate::kClearance);
    tolerance2.push_back(tolerance * tolerance);
  }
};

constexpr double kAbove = 2;  // instead of a fit, which is 1 at most

/// How well each line passes through the homogeneous point (x, y, z): 1 when exactly, 0 when its ends miss it
/// by the tolerance, kAbove when part of the line is above the horizon. As VanishingCandidate has it for one.
UAV_LANDING_MULTIVERSION void fitLines(const LineColumns& lines, double x, double y, double z, int count,
                                       double* __restrict fit) {
  const double *mu = lines.middle_u.data(), *mv = lines.middle_v.data(), *au = lines.along_u.data(),
               *av = lines.along_v.data(), *nu = lines.across_u.data(), *nv = lines.across_v.data(),
               *tu = lines.top_u.data(), *tv = lines.top_v.data(), *half2 = lines.half2.data(),
               *reach = lines.reach.data(), *tolerance2 = lines.tolerance2.data();
  for (int i = 0; i < count; ++i) {
    const double eu = x - z * mu[i], ev = y - z * mv[i];
    const double ahead = std::abs(au[i] * eu + av[i] * ev), across = nu[i] * eu + nv[i] * ev;
    const double miss2 = half2[i] * across * across / (across * across + ahead * ahead);
    const double passing = ahead < reach[i] * z ? -1.0 : 1 - miss2 / tolerance2[i];
    const double above = (y - z * tv[i]) - VanishingCandidate::kMaxHorizonSlope * std::abs(x - z * tu[i]);
    fit[i] = above > 0 ? kAbove : passing;
  }
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
      columns_.add(line, lines.toleranceOf(line));
      turns_.push_back(lines.toleranceOf(line) / line.half * lines.perTurn(line));
      impossible_.push_back(std::log1p(line.half / lines.parameters().ransac_tolerance));
    }
    fit_.resize(lines.all().size());
    agreeing_.resize(lines.all().size());
  }

  /// Evidence of the lines that pass through, each weighted by how well, less that of those that do not and
  /// of those that could not be on the ground if this were its horizon. Lines that pass nearly everywhere do
  /// not count, however many they are; of the pieces of one edge only the best does.
  double of(const Eigen::Vector3d& direction) {
    length_ = 0;
    const Eigen::Vector3d V = lines_.K() * direction;
    fitLines(columns_, V.x(), V.y(), V.z(), lines_.count(), fit_.data());
    const double per_pixel = lines_.perPixel(V);
    std::fill(agreeing_.begin(), agreeing_.end(), 0.0);
    double impossible = 0;
    for (size_t i = 0; i < fit_.size(); ++i) {
      if (fit_[i] <= 0) continue;
      if (fit_[i] == kAbove) {
        impossible += impossible_[i];
        continue;
      }
      const double chance = chanceWithin(turns_[i] * lines_.all()[i].towards(V).norm() * per_pixel);
      if (chance >= kLikelyChance) continue;
      length_ += lines_.all()[i].half;
      double& best = agreeing_[edge_[i]];
      best = std::max(best, fit_[i] * evidence(chance));
    }
    return std::accumulate(agreeing_.begin(), agreeing_.end(), -impossible);
  }
  /// Half the length of the lines that spoke for the last direction.
  double halfLength() const { return length_; }

 private:
  /// Log-likelihood ratio of a line that passes, where a share of the lines does because they are the
  /// runway's and the others do by chance.
  static double evidence(double chance) { return std::log(1 - kRunwayShare + kRunwayShare / chance); }

  /// Numbers the edges that the lines are pieces of: lines that continue each other belong to one.
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
  std::vector<size_t> edge_;  // per line, the edge it is a piece of
  LineColumns columns_;
  std::vector<double> turns_;       // angle on the ground by which a line may turn, over its distance from V
  std::vector<double> impossible_;  // evidence against V of a line above its horizon
  std::vector<double> fit_;         // of one attempt
  std::vector<double> agreeing_;    // by edge
  double length_ = 0;
};

/// Draws lines, the longer the likelier.
class LineDraw {
 public:
  explicit LineDraw(const VanishingLines& lines) : cumulative_(lines.all().size()) {
    std::transform(lines.all().begin(), lines.all().end(), cumulative_.begin(),
                   [](const VanishingCandidate& line) { return line.half; });
    std::partial_sum(cumulative_.begin(), cumulative_.end(), cumulative_.begin());
  }

  int next() {
    // The generator is the same everywhere; the standard library's distributions are not.
    const double place = (random_() + 0.5) / 4294967296.0 * cumulative_.back();
    return static_cast<int>(std::lower_bound(cumulative_.begin(), cumulative_.end(), place) -
                            cumulative_.begin());
  }
  /// How many draws make kPairsOfBest pairs of lines that are half as long as this in all.
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
