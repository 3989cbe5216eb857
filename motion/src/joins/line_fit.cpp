#include "joins/line_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "curves/nurbs_curve.hpp"
#include "curves/vector.hpp"
#include "joins/banded.hpp"
#include "joins/quintic.hpp"
#include "path/part_of.hpp"
#include "path/travel.hpp"

namespace rmac {
namespace {

using curves::along;
using curves::difference;
using curves::distance;
using quintic::Basis;
using quintic::kDegree;

/// The part of the tolerance that is used: something is left for the blend where the spline meets another move at a
/// corner.
constexpr double kPart = 0.95;
/// Lines that turn by more meet in a corner that was meant.
constexpr double kMostTurn = 0.35;
/// Lines longer than this, in tolerances, may turn by more, up to here: their corners are passed in the tube.
constexpr double kCoarse = 4;
constexpr double kMostCoarseTurn = 0.8;
constexpr double kMostSagitta = 8;
constexpr double kLongest_mm = 5;
constexpr double kLongestStep_mm = 2;
/// Weight of the spline's evenness against the squared distances: decides only what the vertices leave open.
constexpr double kEvenness = 1e-6;
/// A quintic's span depends on five knots on either side: these stay when the next window takes over.
constexpr std::ptrdiff_t kKeptKnots = 10;
/// Where knots further apart were too far, they are for the next windows too: a fit in vain costs as much as one that
/// serves.
constexpr int kWindowsAsFine = 4;
constexpr double kSpansALine = 3;
/// The part of the tolerance that is used at the samples: between them the spline goes out further. Where that leaves
/// the tolerance, the tube is made narrower.
constexpr double kTubePart = 0.97;
constexpr int kTubeTrials = 3;
/// Lines from which on a law with open ends says how fast a spline is: fewer are mostly ramps.
constexpr std::size_t kWorthALaw = 20;

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

Vector point_of(const PathSegment& line, double s) {
  CurvePoint point;
  line.curve().evaluate(s, 0, 1, point);
  return {point.d[0][0], point.d[0][1], point.d[0][2]};
}

/// On its first line.
Vector point_at(const Polyline& polyline, double place) {
  return along(polyline.vertices[0], place / polyline.places[1],
               difference(polyline.vertices[1], polyline.vertices[0]));
}

bool same(const PathSegment& a, const PathSegment& b) {
  const PathDemand &x = a.demand(), &y = b.demand();
  return x.feed_mm_s == y.feed_mm_s && x.accel_rise_mm_s2 == y.accel_rise_mm_s2 &&
         x.accel_fall_mm_s2 == y.accel_fall_mm_s2 && x.tolerance_mm == y.tolerance_mm && a.map() == b.map();
}

bool short_line(const PathSegment& segment) {
  const PathDemand& demand = segment.demand();
  return demand.tolerance_mm > 0 && segment.curve().straight() && segment.length() < kLongest_mm &&
         !demand.rest_before && !demand.rest_after;
}

/// A smooth curve through both lines' ends stays within tolerance of them (an arc of their turn is a quarter of turn
/// times length away, halved where both are alike), or they are coarse, and a curve in the tube passes the corner.
bool belong_together(const PathSegment& a, const PathSegment& b) {
  if (!short_line(a) || !short_line(b) || !same(a, b)) return false;
  CurvePoint before, after;
  a.curve().evaluate(a.length(), 1, -1, before);
  b.curve().evaluate(0, 1, 1, after);
  double turn = 0;
  for (std::size_t c = 0; c < 3; ++c) turn += (after.d[1][c] - before.d[1][c]) * (after.d[1][c] - before.d[1][c]);
  turn = std::sqrt(turn);
  const double tolerance = a.demand().tolerance_mm;
  if (turn < kMostTurn && turn * std::max(a.length(), b.length()) / 6 < tolerance) return true;
  return turn < kMostCoarseTurn && std::min(a.length(), b.length()) > kCoarse * tolerance &&
         turn * std::max(a.length(), b.length()) / 8 < kMostSagitta * tolerance;
}

/// How far the spline may be from each line: what it is at the vertices, and between two of them by the convex hull of
/// its second derivative (eq. 10).
std::vector<double> chord_distances(const std::vector<double>& knots, const std::vector<Vector>& points,
                                    const Polyline& polyline) {
  const std::vector<double> bends = quintic::second_derivative_hull(knots, points);
  const auto at = [&](double place) { return quintic::basis(knots, points.size(), place); };
  const double begin = knots[kDegree];
  Basis from = at(begin);
  double before = distance(quintic::value(from, points), point_at(polyline, begin));
  std::vector<double> distances;
  for (std::size_t k = 0; k < polyline.lines(); ++k) {
    const Basis to = at(polyline.places[k + 1]);
    const double here = distance(quintic::value(to, points), polyline.vertices[k + 1]);
    const double h = polyline.places[k + 1] - std::max(begin, polyline.places[k]);
    double bend = 0;
    for (std::size_t i = from.first; i + 2 <= to.first + kDegree; ++i) bend = std::max(bend, bends[i]);
    distances.push_back(std::max(here, before) + h * h / 8 * bend);
    before = here;
    from = to;
  }
  return distances;
}

}  // namespace

void LineFit::clear() {
  waiting_.clear();
  checked_ = 0;
  before_ = {};
}

std::size_t LineFit::run_length() const noexcept {
  if (checked_ == 0 && !waiting_.empty()) checked_ = 1;
  while (checked_ < waiting_.size() && checked_ <= kDense.lines &&
         belong_together(*waiting_[checked_ - 1], *waiting_[checked_]))
    ++checked_;
  return checked_;
}

bool LineFit::complete() const noexcept {
  return !short_line(*waiting_.front()) || run_length() < waiting_.size();
}

void LineFit::drop_lines(std::size_t count) {
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(count));
  checked_ -= std::min(checked_, count);
}

double LineFit::begin() const noexcept {
  return goes_on() ? before_.knots[kDegree] : 0;
}

std::size_t LineFit::kept_points() const noexcept {
  return goes_on() ? kDegree : 1;
}

Polyline LineFit::polyline(std::size_t lines) const {
  Polyline polyline{{point_of(*waiting_[0], 0)}, {0}, before_.polyline.previous};
  for (std::size_t i = 0; i < lines; ++i) {
    polyline.vertices.push_back(point_of(*waiting_[i], waiting_[i]->length()));
    polyline.places.push_back(polyline.places.back() + waiting_[i]->length());
  }
  return polyline;
}

bool LineFit::set_knots(const std::vector<double>& inner, Fit& fit) const {
  fit.knots.assign(kDegree + 1, 0.0);
  if (goes_on()) fit.knots.assign(before_.knots.begin(), before_.knots.begin() + kKeptKnots);
  fit.knots.insert(fit.knots.end(), inner.begin(), inner.end());
  fit.knots.insert(fit.knots.end(), kDegree + 1, fit.polyline.places.back());
  const std::size_t count = fit.knots.size() - kDegree - 1;
  if (count < kept_points() + 2) return false;
  fit.points.resize(count);
  if (goes_on()) std::copy_n(before_.points.begin(), kDegree, fit.points.begin());
  return true;
}

bool LineFit::least_squares(double step, Fit& fit) const {
  const double length = fit.polyline.places.back();
  const double from = goes_on() ? before_.knots[static_cast<std::size_t>(kKeptKnots - 1)] : 0;
  if (!(length > from + 0.5 * step)) return false;
  const auto spans = static_cast<std::size_t>(std::max(1.0, std::ceil((length - from) / step)));
  std::vector<double> inner;
  for (std::size_t i = 1; i < spans; ++i)
    inner.push_back(from + (length - from) * static_cast<double>(i) / static_cast<double>(spans));
  if (!set_knots(inner, fit)) return false;

  // Normal equations, with control points relative to the first vertex.
  const std::size_t count = fit.points.size();
  const Vector& origin = fit.polyline.vertices.front();
  Banded normal(count, kDegree);
  std::vector<Vector> right(count, Vector{});
  for (std::size_t k = 0; k < fit.polyline.places.size(); ++k) {
    const double place = k == 0 ? begin() : fit.polyline.places[k];
    const Vector target = difference(k == 0 ? point_at(fit.polyline, place) : fit.polyline.vertices[k], origin);
    const Basis basis = quintic::basis(fit.knots, count, place);
    for (std::size_t a = 0; a <= kDegree; ++a) {
      const std::size_t row = basis.first + a;
      right[row] = along(right[row], basis.values[a], target);
      for (std::size_t b = 0; b <= a; ++b) normal.at(row, a - b) += basis.values[a] * basis.values[b];
    }
  }
  for (std::size_t i = 0; i + 3 < count; ++i) {
    static constexpr std::array<double, 4> kThird{-1, 3, -3, 1};
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b <= a; ++b) normal.at(i + a, a - b) += kEvenness * kThird[a] * kThird[b];
    }
  }
  for (std::size_t i = 0; i < kept_points(); ++i)
    normal.fix(i, goes_on() ? difference(fit.points[i], origin) : Vector{}, right);
  normal.fix(count - 1, difference(fit.polyline.vertices.back(), origin), right);
  if (!normal.factorise()) return false;
  normal.substitute(right);
  for (std::size_t i = 0; i < count; ++i) fit.points[i] = along(origin, 1, right[i]);
  return true;
}

bool LineFit::fit_dense(std::size_t lines, bool ends, Fit& fit) const {
  fit.polyline = polyline(lines);
  const double tolerance = waiting_[0]->demand().tolerance_mm * kPart;
  const double mean = fit.polyline.places.back() / static_cast<double>(lines);
  // The overlap holds the knots that a cut keeps, and more.
  const double longest = std::min(kLongestStep_mm, mean * static_cast<double>(kDense.overlap) / 8);
  const double widest = step_ > 0 ? std::min((no_coarser_for_ > 0 ? 1 : 2) * step_, longest) : longest;
  for (int halvings = 0;; ++halvings) {
    const double step = std::ldexp(widest, -halvings);
    if (step < 0.9 * mean) return false;
    fit.coarser_failed = halvings > 0;
    if (!least_squares(step, fit)) continue;
    fit.deviations_mm = chord_distances(fit.knots, fit.points, fit.polyline);
    if (largest(fit.deviations_mm) <= tolerance) return make_segments({}, kDense.overlap, ends, fit);
  }
}

bool LineFit::fit_tube(std::size_t lines, bool ends, Fit& fit) const {
  fit.polyline = polyline(lines);
  const std::vector<double>& places = fit.polyline.places;
  // The spline swings from one side of each line to the other: three spans do that as well as more. A line much shorter
  // than its neighbours needs fewer.
  const double from = goes_on() ? before_.knots[static_cast<std::size_t>(kKeptKnots - 1)] : 0;
  std::vector<double> inner;
  for (std::size_t k = 0; k < lines; ++k) {
    double longest = 0;
    for (std::size_t i = k > 1 ? k - 2 : 0; i <= k + 2 && i < lines; ++i)
      longest = std::max(longest, places[i + 1] - places[i]);
    const double length = places[k + 1] - places[k];
    const int spans = static_cast<int>(std::ceil(kSpansALine * length / longest - 1e-9));
    for (int i = k == 0 ? 1 : 0; i < spans; ++i) inner.push_back(places[k] + length * i / spans);
  }
  std::erase_if(inner, [&](double knot) { return knot <= from + 0.05 * places.back() / static_cast<double>(lines); });
  if (!set_knots(inner, fit)) return false;

  // At either end half of the tolerance is left for the blend with another move.
  const double tolerance = waiting_[0]->demand().tolerance_mm;
  std::vector<double> widths(lines, kTubePart * tolerance);
  if (!goes_on()) widths.front() = 0.5 * tolerance;
  if (ends) widths.back() = 0.5 * tolerance;
  for (int trial = 0;; ++trial) {
    if (!smoothest_in_tube(fit.knots, fit.polyline, widths, kept_points(), fit.points)) return false;
    fit.deviations_mm = tube_distances(fit.knots, fit.points, fit.polyline, tolerance);
    const double deviation = largest(fit.deviations_mm);
    if (deviation <= tolerance) break;
    if (trial == kTubeTrials || deviation > 1.2 * tolerance) return false;
    for (double& width : widths) width *= 0.995 * tolerance / deviation;
  }

  if (lines >= kWorthALaw) make_faster(widths, fit);

  std::vector<std::size_t> cuts;
  const auto knot_at = [&](double place) { return quintic::span_of(fit.knots, fit.points.size(), place); };
  if (!goes_on()) cuts.push_back(knot_at(places[1]));
  if (ends && knot_at(places[lines - 1]) > (cuts.empty() ? kDegree : cuts.back()))
    cuts.push_back(knot_at(places[lines - 1]));
  return make_segments(std::move(cuts), kTube.overlap, ends, fit);
}

void LineFit::make_faster(const std::vector<double>& widths, Fit& fit) const {
  auto lines = line_limits({waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(fit.polyline.lines())});
  if (!lines) return;
  DraftLaw law(fit.knots, fit.polyline, std::move(*lines), joints_);
  fastest_in_tube(fit.knots, fit.polyline, widths, waiting_[0]->demand().tolerance_mm, kept_points(), law, fit.points,
                  fit.deviations_mm);
}

bool LineFit::fit(bool finish, Fit& fit) const {
  const std::size_t run = run_length();
  if (run < kShortest && !goes_on()) return false;
  const bool whole = finish || complete();
  const auto ends = [&](const Window& window) { return whole && run <= window.lines; };
  return fit_dense(std::min(run, kDense.lines), ends(kDense), fit) ||
         fit_tube(std::min(run, kTube.lines), ends(kTube), fit);
}

bool LineFit::make_segments(std::vector<std::size_t> cuts, std::size_t overlap, bool ends, Fit& fit) const {
  Nurbs nurbs;
  nurbs.degree = static_cast<int>(kDegree);
  nurbs.dimension = 3;
  nurbs.knots = fit.knots;
  for (const Vector& point : fit.points) nurbs.points.push_back({point[0], point[1], point[2]});
  CurvePoint start;
  waiting_.front()->curve().evaluate(0, 0, 1, start);
  const auto space = std::make_shared<const curves::SpaceCurve>(nurbs, NurbsSpace::Tip,
                                                                Vector{start.d[0][3], start.d[0][4], start.d[0][5]});
  const std::size_t last = kDegree + space->spline().span_count();
  fit.cut = last;
  if (!ends) {
    const auto& places = fit.polyline.places;
    if (places.size() < overlap + 2) return false;
    fit.cut = quintic::span_of(fit.knots, fit.points.size(), places[places.size() - 1 - overlap]);
    if (fit.cut <= kDegree) return false;
  }
  const auto part = [&](std::size_t from, std::size_t to) -> std::shared_ptr<const PathSegment> {
    auto curve = curves::NurbsCurve::make(space, from - kDegree, to - kDegree);
    if (!curve) return nullptr;
    return segment(fit, std::move(*curve), fit.knots[from], fit.knots[to]);
  };
  fit.heads.clear();
  cuts.push_back(fit.cut);
  for (std::size_t from = kDegree; const std::size_t to : cuts) {
    if (to <= from || to > fit.cut) continue;
    fit.heads.push_back(part(from, to));
    if (!fit.heads.back()) return false;
    from = to;
  }
  if (!ends) fit.tail = part(fit.cut, last);
  return ends || fit.tail != nullptr;
}

std::shared_ptr<const PathSegment> LineFit::segment(const Fit& fit, std::shared_ptr<const Curve> curve, double from,
                                                    double to) const {
  const double rate = curve->length() / (to - from);
  std::vector<MoveStretch> stretches;
  std::size_t first = fit.polyline.places.size();
  double deviation = 0;
  for (std::size_t k = 0; k + 1 < fit.polyline.places.size() && fit.polyline.places[k] < to; ++k) {
    if (fit.polyline.places[k + 1] <= from) continue;
    first = std::min(first, k);
    deviation = std::max(deviation, fit.deviations_mm[k]);
    const double a = std::max(fit.polyline.places[k], from) - fit.polyline.places[k];
    const double b = to < fit.polyline.places[k + 1] ? to - fit.polyline.places[k] : waiting_[k]->length();
    append_stretches(*waiting_[k], a, b, (fit.polyline.places[k] + a - from) * rate,
                     (fit.polyline.places[k] + b - from) * rate, stretches);
  }
  const PathSegment& line = *waiting_[first];
  PathDemand demand = line.demand();
  demand.deviation_mm = deviation;
  auto segment = std::make_shared<PathSegment>(std::move(curve), line.map(), demand, stretches);
  JointPoint joints;
  double s_failed = 0;
  if (line.evaluate(from - fit.polyline.places[first], 0, 1, joints) != KinematicsStatus::Ok ||
      segment->resolve({joints.d[0].data(), segment->joint_count()}, s_failed) != KinematicsStatus::Ok ||
      find_offence(*segment, joints_))
    return nullptr;
  return segment;
}

void LineFit::take(Fit fit, SegmentQueue& out) {
  for (auto& head : fit.heads) out.push_back(std::move(head));
  step_ = fit.knots[fit.cut] - fit.knots[fit.cut - 1];
  no_coarser_for_ = fit.coarser_failed ? kWindowsAsFine : std::max(no_coarser_for_ - 1, 0);
  if (!fit.tail) {
    before_ = {};
    drop_lines(fit.polyline.places.size() - 1);
    return;
  }
  // The next window keeps the control points that shape the spline at the cut: nothing jumps there up to the fourth
  // derivative.
  const double cut = fit.knots[fit.cut];
  std::size_t done = 0;
  while (fit.polyline.places[done + 1] <= cut) ++done;
  const auto kept = static_cast<std::ptrdiff_t>(fit.cut - kDegree);
  before_ = std::move(fit);
  before_.knots.erase(before_.knots.begin(), before_.knots.begin() + kept);
  before_.points.erase(before_.points.begin(), before_.points.begin() + kept);
  const double shift = before_.polyline.places[done];
  for (double& knot : before_.knots) knot -= shift;
  auto& [vertices, places, previous] = before_.polyline;
  if (done > 0) previous = vertices[done - 1];
  vertices.erase(vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(done));
  places.erase(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(done));
  drop_lines(done);
}

void LineFit::advance(bool finish, SegmentQueue& out) {
  if (waiting_.empty() || !(finish || ready())) return;
  Fit found;
  if (fit(finish, found)) {
    take(std::move(found), out);
  } else if (goes_on()) {
    // No spline follows within tolerance: the window before ends as it was found, at the end of its last line.
    out.push_back(std::move(before_.tail));
    drop_lines(before_.polyline.places.size() - 1);
    before_ = {};
  } else {
    // The whole run, as it is: less than a run would be no better.
    const std::size_t count = finish || complete() ? std::min(run_length(), kDense.lines) : 1;
    for (std::size_t i = 0; i < count; ++i) out.push_back(waiting_[i]);
    drop_lines(count);
  }
}

}  // namespace rmac
