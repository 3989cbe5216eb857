#include "time_law/law_grid.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace rmac {
namespace {

constexpr double kGrading = 0.35;  ///< steps grow by this part of the distance from where they must be fine
constexpr std::size_t kLeastNodes = 6;

double rounding(double s) {
  return 1e-12 * (1 + std::abs(s));
}

/// Whether s lies behind `before` by more than rounding.
bool apart(double before, double s) {
  return s > before + rounding(s);
}

/// Places that the grid must hold: its ends, and between them segment ends and breaks, and those that are to be kept.
std::vector<double> fixed_places(const PathView& path, double begin, double end, std::span<const double> kept) {
  std::vector<double> fixed{begin};
  auto next = kept.begin();
  const auto keep = [&](double s) {
    if (apart(fixed.back(), s) && s < end) fixed.push_back(s);
  };
  const auto keep_path = [&](double s) {
    for (; next != kept.end() && apart(*next, s); ++next) keep(*next);
    keep(s);
  };
  for (std::size_t i = path.find(begin, 1); i <= path.find(end, -1); ++i) {
    keep_path(path.start(i));
    for (const double s : path.segment(i).curve().breaks()) keep_path(path.start(i) + s);
  }
  keep_path(end);
  fixed.push_back(end);
  return fixed;
}

/// How long a step may be for the geometry's sake. A step into an interval between the geometry's nodes is no longer
/// than that interval, and steps grow with the distance from it: a sharp bend is never stepped over, and next to one
/// the speed changes as fast as next to a rest.
class GeometrySteps {
 public:
  GeometrySteps(const PathView& path, double begin, double end, double coarsest) {
    for (std::size_t i = path.find(begin, 1); i <= path.find(end, -1); ++i)
      for (const double s : path.segment(i).nodes()) nodes_.push_back(path.start(i) + s);
    longest_.assign(nodes_.size(), coarsest);
    for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) {
      // Where segments meet, the last node of one and the first of the next differ by rounding.
      if (!apart(nodes_[i], nodes_[i + 1])) continue;
      const double width = nodes_[i + 1] - nodes_[i];
      longest_[i] = std::min(longest_[i], width);
      longest_[i + 1] = std::min(longest_[i + 1], width);
    }
    for (std::size_t i = 1; i < nodes_.size(); ++i)
      longest_[i] = std::min(longest_[i], longest_[i - 1] + kGrading * (nodes_[i] - nodes_[i - 1]));
    for (std::size_t i = nodes_.size() - 1; i-- > 0;)
      longest_[i] = std::min(longest_[i], longest_[i + 1] + kGrading * (nodes_[i + 1] - nodes_[i]));
  }

  /// The longest step from s, which grows from call to call.
  [[nodiscard]] double at(double s) {
    while (before_ + 1 < nodes_.size() && nodes_[before_ + 1] <= s) ++before_;
    const double step = longest_[before_] + kGrading * std::abs(s - nodes_[before_]);
    if (before_ + 1 == nodes_.size()) return step;
    return std::min(step, longest_[before_ + 1] + kGrading * (nodes_[before_ + 1] - s));
  }

 private:
  std::vector<double> nodes_;
  std::vector<double> longest_;  ///< a node
  std::size_t before_ = 0;       ///< the last node at or before the place
};

/// Cuts the last of the steps from `from` short at `to`; were it much shorter than the one before, the two share their
/// length.
void end_steps(std::vector<double>& places, double from, double to) {
  places.back() = to;
  const std::size_t n = places.size();
  if (n < 2) return;
  const double before = n >= 3 ? places[n - 3] : from;
  if (to - places[n - 2] < 0.5 * (places[n - 2] - before)) places[n - 2] = before + 0.5 * (to - before);
}

std::vector<double> with_middles(std::span<const double> nodes) {
  std::vector<double> finer{nodes.front()};
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    finer.push_back(0.5 * (nodes[i] + nodes[i + 1]));
    finer.push_back(nodes[i + 1]);
  }
  return finer;
}

}  // namespace

std::vector<double> law_grid(const PathView& path, const GridEnd& begin, const GridEnd& end, double coarsest,
                             std::span<const double> kept) {
  const std::vector<double> fixed = fixed_places(path, begin.s, end.s, kept);
  GeometrySteps geometry(path, begin.s, end.s, coarsest);
  const auto step_from = [&](double s) {
    return std::min({coarsest, begin.step + kGrading * (s - begin.graded_from),
                     end.step + kGrading * (end.graded_from - s), geometry.at(s)});
  };
  std::vector<double> nodes{begin.s};
  std::vector<double> places;
  for (std::size_t i = 0; i + 1 < fixed.size(); ++i) {
    places.clear();
    for (double s = fixed[i]; s < fixed[i + 1];) {
      s += std::max(step_from(s), rounding(s));  // a shorter step would not get on
      places.push_back(s);
    }
    end_steps(places, fixed[i], fixed[i + 1]);
    nodes.insert(nodes.end(), places.begin(), places.end());
  }
  // The spline's end coefficients are fixed by the end states; a law needs some that are free.
  while (nodes.size() < kLeastNodes) nodes = with_middles(nodes);
  return nodes;
}

}  // namespace rmac
