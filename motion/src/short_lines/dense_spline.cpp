#include "short_lines/dense_spline.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "curves/vector.hpp"

namespace rmac {
namespace {

using curves::along;
using curves::difference;
using curves::dot;
using curves::unit;

constexpr double kKnotSpacing_mm = 0.1;
/// Widths: at most this part of the overlap, so that what comes behind it hardly shapes what goes before it; at a free
/// end, where a spline would rather not bend, this much, and more by this slope behind it; growing by this slope on new
/// lines.
constexpr double kWidest = 0.15;
constexpr double kFreeEnd_mm = 0.4;
constexpr double kFreeEndSlope = 0.3;
constexpr double kGrowth = 0.4;
/// Knots' distance in widths, and in lines: closer ones shape nothing that the smoothing leaves.
constexpr double kKnotsAWidth = 2;
constexpr double kLeastStepOfALine = 0.3;
constexpr double kLongestStep_mm = 2;
/// The part of the tolerance that widths aim at; with every trial a little less, until one is within.
constexpr double kAim = 0.9, kLessATrial = 0.015, kLeastAim = 0.6;
constexpr int kMostTrials = 30;
/// A trial that is smoother by less than this ends the search.
constexpr double kWorthATrial = 0.98;
constexpr double kFarWithin = 0.5;
/// Beside a corner with another move, where lines themselves used up what is left to a spline.
constexpr double kLeastAtCorner = 0.1;

/// How far along the first line the spline before is ahead of its parameter, as one in a tube may be; behind: negative.
double lead_of(const LineSpline& before, const Polyline& polyline) {
  if (before.empty()) return 0;
  const double begin = before.begin();
  const auto after = std::upper_bound(polyline.places.begin(), polyline.places.end(), begin);
  const auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - polyline.places.begin(), 1) - 1);
  const Vector ahead = unit(difference(polyline.vertices[k + 1], polyline.vertices[k]));
  const Vector here = along(polyline.vertices[k], begin - polyline.places[k], ahead);
  const Vector spline = quintic::value(quintic::basis(before.knots, before.points.size(), begin), before.points);
  return dot(difference(spline, here), ahead);
}

/// The polyline's vertices from where the spline begins, and places between them, each with the length it stands for.
/// What the spline before is ahead of the polyline is made good little by little.
std::vector<SplineSample> samples_of(const Polyline& polyline, const LineSpline& before) {
  constexpr double kMadeGoodIn_mm = 2;
  const double begin = before.begin(), lead = lead_of(before, polyline);
  const auto place_of = [&](double q) { return q - lead * std::max(1 - (q - begin) / kMadeGoodIn_mm, 0.0); };
  std::vector<SplineSample> samples;
  for (std::size_t k = 0; k < polyline.lines(); ++k) {
    const double line = polyline.places[k], end = polyline.places[k + 1];
    const double from = std::max(begin + std::max(lead, 0.0), line);
    if (!(from < end)) continue;
    const Vector chord = difference(polyline.vertices[k + 1], polyline.vertices[k]);
    const auto parts = std::max(1, static_cast<int>(std::round((end - from) / kKnotSpacing_mm)));
    for (int i = 0; i < parts; ++i) {
      const double q = from + (end - from) * i / parts;
      const double place = std::max(place_of(q), begin);
      samples.push_back({place, along(polyline.vertices[k], (q - line) / (end - line), chord), k});
      samples.back().used = polyline.off_mm[k];
    }
  }
  samples.push_back({polyline.places.back(), polyline.vertices.back(), polyline.lines() - 1});
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const double half = (samples[i + 1].place - samples[i].place) / 2;
    samples[i].share += half;
    samples[i + 1].share += half;
  }
  return samples;
}

void set_bounds(const DenseLines& lines, const LineSpline& before, std::vector<SplineSample>& samples) {
  const double end = lines.polyline.places.back();
  for (SplineSample& sample : samples) {
    const double to_end = end - sample.place, to_free_end = before.empty() ? std::min(to_end, sample.place) : to_end;
    sample.most_mm = std::min({sample.most_mm, kWidest * lines.overlap_mm, kFreeEnd_mm + kFreeEndSlope * to_free_end});
    const bool at_corner = sample.place < lines.start_corner_mm || to_end < lines.end_corner_mm;
    sample.limit = at_corner ? std::max(0.5 * lines.tolerance - sample.used, kLeastAtCorner * lines.tolerance)
                             : (sample.place < before.free_from() ? lines.most : lines.tolerance) - sample.used;
  }
}

/// Widths as the window before found them, but for those near its free end; and then as they may be.
void set_widths(const DenseLines& lines, const std::vector<SplineSample>& before, std::vector<SplineSample>& samples) {
  const double known_to = before.empty() ? 0 : before.back().place - lines.overlap_mm / 2;
  auto known = before.begin();
  double width = before.empty() ? samples.front().most_mm : 0, place = samples.front().place;
  if (before.empty()) width = kWidest * lines.overlap_mm;
  for (SplineSample& sample : samples) {
    while (known != before.end() && known->place < sample.place - 1e-9) ++known;
    width += kGrowth * (sample.place - place);
    place = sample.place;
    if (known != before.end() && place < known_to) width = known->width_mm;
    sample.width_mm = std::min(width, sample.most_mm);
  }
}

/// Makes widths smaller where the spline is out of what it may miss, and around there, and wider where it is far
/// within.
void adapt(double aim, std::vector<SplineSample>& samples) {
  // What a spline of width w misses by grows with w⁶, but narrower ones have knots of their own: the fourth root ends
  // in fewer trials.
  constexpr double kNarrower = 1.0 / 4, kWider = 1.0 / 6, kLeast = 0.5, kMost = 1.2;
  std::vector<double> off;
  for (const SplineSample& sample : samples) off.push_back(sample.off / sample.limit);
  const auto far = [&](std::size_t k) {
    return std::exp(-(samples[k + 1].place - samples[k].place) / samples[k].width_mm);
  };
  for (std::size_t k = 1; k < off.size(); ++k) off[k] = std::max(off[k], off[k - 1] * far(k - 1));
  for (std::size_t k = off.size() - 1; k-- > 0;) off[k] = std::max(off[k], off[k + 1] * far(k));
  for (std::size_t k = 0; k < off.size(); ++k) {
    SplineSample& sample = samples[k];
    const double reserve = aim / std::max(off[k], 1e-9);
    const double change = std::clamp(std::pow(reserve, reserve < 1 ? kNarrower : kWider), kLeast, kMost);
    sample.width_mm = std::min(sample.width_mm * change, sample.most_mm);
  }
}

/// Moves the knot that is nearest to a place there.
void snap(double place, double from, std::vector<double>& knots) {
  if (knots.empty() || place <= from) return;
  *std::min_element(knots.begin(), knots.end(),
                    [place](double a, double b) { return std::abs(a - place) < std::abs(b - place); }) = place;
}

/// Knots behind `from`, as far apart as the samples' widths ask for; empty where there is no room.
std::vector<double> knots_for(const DenseLines& lines, const std::vector<SplineSample>& samples, double from) {
  // The overlap holds the knots that the next window keeps, and more.
  const double longest = std::min(kLongestStep_mm, lines.overlap_mm / 8);
  const auto& places = lines.polyline.places;
  const auto step = [&](const SplineSample& sample) {
    const double line = places[sample.line + 1] - places[sample.line];
    const double least = lines.least_step_mm.value_or(kLeastStepOfALine * line);
    return std::min(longest, std::max(sample.width_mm / kKnotsAWidth, least));
  };
  const auto steps_from = [&](std::size_t k) {
    return std::max(samples[k + 1].place - std::max(samples[k].place, from), 0.0) / step(samples[k]);
  };
  double steps = 0;
  for (std::size_t k = 0; k + 1 < samples.size(); ++k) steps += steps_from(k);
  const double even = steps / std::ceil(steps);
  std::vector<double> knots;
  double done = 0, next = even;
  for (std::size_t k = 0; k + 1 < samples.size(); ++k) {
    const double here = steps_from(k);
    for (; next < std::min(done + here, steps - even / 2); next += even)
      knots.push_back(std::max(samples[k].place, from) + (next - done) * step(samples[k]));
    done += here;
  }
  if (lines.knot_at) snap(*lines.knot_at, from, knots);
  return knots;
}

/// Notes for each line by how much the spline may miss it; the most of what it may.
double judge(const std::vector<SplineSample>& samples, std::size_t lines, std::vector<double>& deviations) {
  deviations.assign(lines, 0);
  double worst = 0;
  for (const SplineSample& sample : samples) {
    deviations[sample.line] = std::max(deviations[sample.line], sample.off);
    worst = std::max(worst, sample.off / sample.limit);
  }
  return worst;
}

/// The place of the first sample that is missed by more than it may.
double kept_to(const std::vector<SplineSample>& samples) {
  const auto out = std::find_if(samples.begin(), samples.end(),
                                [](const SplineSample& sample) { return sample.off > sample.limit; });
  return out == samples.end() ? samples.back().place : out->place;
}

}  // namespace

tl::expected<LineSpline, double> smoothest_along(const DenseLines& lines, const LineSpline& before) {
  return smoothest_within(lines, before, samples_of(lines.polyline, before),
                          [&](LineSpline& trial) -> std::optional<double> {
                            SmoothingSpline spline(trial.knots, trial.samples);
                            if (!spline.solve(before.kept_points(), trial.points)) return std::nullopt;
                            return spline.roughness(trial.points);
                          });
}

tl::expected<LineSpline, double> smoothest_within(const DenseLines& lines, const LineSpline& before,
                                                  std::vector<SplineSample> samples, const SmoothFit& fit) {
  LineSpline trial;
  trial.samples = std::move(samples);
  set_bounds(lines, before, trial.samples);
  set_widths(lines, before.samples, trial.samples);
  std::optional<LineSpline> best;
  double least = 0, kept_mm = 0;
  for (int k = 0; k < kMostTrials; ++k) {
    if (!trial.go_on(before, knots_for(lines, trial.samples, before.free_from()), lines.polyline)) break;
    const auto roughness = fit(trial);
    if (!roughness) break;
    const double worst = judge(trial.samples, lines.polyline.lines(), trial.deviations);
    if (worst <= 1) {
      const bool first = !best, worth_it = first || *roughness < kWorthATrial * least;
      if (first || *roughness < least) {
        best = trial;
        least = *roughness;
      }
      if ((k > 0 && !worth_it) || worst < kFarWithin) break;
    }
    kept_mm = std::max(kept_mm, kept_to(trial.samples));
    adapt(std::max(kAim - kLessATrial * k, kLeastAim), trial.samples);
  }
  if (!best) return tl::unexpected(kept_mm);
  return *std::move(best);
}

}  // namespace rmac
