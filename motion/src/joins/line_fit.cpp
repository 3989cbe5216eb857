#include "joins/line_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "curves/nurbs_curve.hpp"
#include "curves/vector.hpp"
#include "joins/banded.hpp"
#include "joins/blend.hpp"
#include "path/part_of.hpp"
#include "path/travel.hpp"

namespace rmac {
namespace {

using curves::along;
using curves::difference;
using curves::distance;

/// Of the tolerance: something is left for the blend where the spline meets another move at a corner.
constexpr double kPart = 0.95;
/// Lines that turn by more meet in a corner that was meant.
constexpr double kMostTurn = 0.35;
constexpr double kLongest_mm = 5;
constexpr double kLongestStep_mm = 2;
/// Weight of the spline's evenness against the squared distances: decides only what the vertices leave open.
constexpr double kEvenness = 1e-6;
/// A quintic's span depends on five knots on either side: these stay when the next window takes over.
constexpr std::ptrdiff_t kKeptKnots = 10;

Vector point_of(const PathSegment& line, double s) {
  CurvePoint point;
  line.curve().evaluate(s, 0, 1, point);
  return {point.d[0][0], point.d[0][1], point.d[0][2]};
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

/// A smooth curve through both lines' ends stays within tolerance of them: an arc of their turn is a quarter of turn
/// times length away, halved where both are alike.
bool belong_together(const PathSegment& a, const PathSegment& b) {
  if (!short_line(a) || !short_line(b) || !same(a, b)) return false;
  CurvePoint before, after;
  a.curve().evaluate(a.length(), 1, -1, before);
  b.curve().evaluate(0, 1, 1, after);
  double turn = 0;
  for (std::size_t c = 0; c < 3; ++c) turn += (after.d[1][c] - before.d[1][c]) * (after.d[1][c] - before.d[1][c]);
  turn = std::sqrt(turn);
  return turn < kMostTurn && turn * std::max(a.length(), b.length()) / 6 < a.demand().tolerance_mm;
}

/// The quintic basis functions that live on [knots[i], knots[i + 1]], at x (The NURBS Book, A2.2).
std::array<double, 6> basis(const std::vector<double>& knots, std::size_t i, double x) {
  std::array<double, 6> n{}, left{}, right{};
  n[0] = 1;
  for (std::size_t j = 1; j <= 5; ++j) {
    left[j] = x - knots[i + 1 - j];
    right[j] = knots[i + j] - x;
    double saved = 0;
    for (std::size_t r = 0; r < j; ++r) {
      const double share = n[r] / (right[r + 1] + left[j - r]);
      n[r] = saved + right[r + 1] * share;
      saved = left[j - r] * share;
    }
    n[j] = saved;
  }
  return n;
}

std::size_t span_of(const std::vector<double>& knots, std::size_t count, double x) {
  const auto first = knots.begin() + 5, last = knots.begin() + static_cast<std::ptrdiff_t>(count);
  const auto above = std::upper_bound(first, last, x);
  return static_cast<std::size_t>(above - knots.begin()) - 1;
}

}  // namespace

void LineFit::clear() {
  waiting_.clear();
  checked_ = 0;
  before_ = {};
}

std::size_t LineFit::run_length() const noexcept {
  if (checked_ == 0 && !waiting_.empty()) checked_ = 1;
  while (checked_ < waiting_.size() && checked_ <= kWindow &&
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

bool LineFit::solve(const std::vector<Vector>& vertices, double step, Fit& fit) const {
  const bool goes_on = before_.tail != nullptr;
  const double begin = goes_on ? before_.knots[kDegree] : 0, length = fit.places.back();
  const double from = goes_on ? before_.knots[static_cast<std::size_t>(kKeptKnots - 1)] : 0;
  if (!(length > from + 0.5 * step)) return false;
  const auto spans = static_cast<std::size_t>(std::max(1.0, std::ceil((length - from) / step)));
  auto& knots = fit.knots;
  knots.assign(kDegree + 1, 0.0);
  if (goes_on) knots.assign(before_.knots.begin(), before_.knots.begin() + kKeptKnots);
  for (std::size_t i = 1; i < spans; ++i)
    knots.push_back(from + (length - from) * static_cast<double>(i) / static_cast<double>(spans));
  knots.insert(knots.end(), kDegree + 1, length);
  const std::size_t count = knots.size() - kDegree - 1;
  const std::size_t kept = goes_on ? kDegree : 1;
  if (count < kept + 2) return false;

  // Normal equations, with control points relative to the first vertex.
  const Vector& origin = vertices.front();
  Banded normal(count, kDegree);
  std::vector<Vector> right(count, Vector{});
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const double place = k == 0 ? begin : fit.places[k];
    const std::size_t span = span_of(knots, count, place);
    const auto n = basis(knots, span, place);
    for (std::size_t a = 0; a <= kDegree; ++a) {
      const std::size_t row = span - kDegree + a;
      for (std::size_t c = 0; c < 3; ++c) right[row][c] += n[a] * (vertices[k][c] - origin[c]);
      for (std::size_t b = 0; b <= a; ++b) normal.at(row, a - b) += n[a] * n[b];
    }
  }
  for (std::size_t i = 0; i + 3 < count; ++i) {
    static constexpr std::array<double, 4> kThird{-1, 3, -3, 1};
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b <= a; ++b) normal.at(i + a, a - b) += kEvenness * kThird[a] * kThird[b];
    }
  }
  for (std::size_t i = 0; i < kept; ++i)
    normal.fix(i, goes_on ? difference(before_.points[i], origin) : Vector{}, right);
  normal.fix(count - 1, difference(vertices.back(), origin), right);
  if (!normal.solve(right)) return false;
  fit.points.resize(count);
  for (std::size_t i = 0; i < count; ++i) fit.points[i] = along(origin, 1, right[i]);
  return true;
}

namespace {

/// How far the spline may be from the chords between the vertices: what it is at the vertices, and between two of them
/// by the convex hull of its second derivative (eq. 10). Stops looking once that is more than `tolerance`.
double deviation(const std::vector<double>& knots, const std::vector<Vector>& points, const std::vector<double>& places,
                 const std::vector<Vector>& vertices, double from, double tolerance) {
  const std::size_t count = points.size();
  std::vector<double> bend(count, 0.0);
  for (std::size_t i = 0; i + 2 < count; ++i) {
    const double w0 = knots[i + 6] - knots[i + 1], w1 = knots[i + 7] - knots[i + 2], w = knots[i + 6] - knots[i + 2];
    if (!(w > 0)) continue;
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double d0 = 5 * (points[i + 1][c] - points[i][c]) / w0;
      const double d1 = 5 * (points[i + 2][c] - points[i + 1][c]) / w1;
      sum += 16 * (d1 - d0) * (d1 - d0) / (w * w);
    }
    bend[i] = std::sqrt(sum);
  }
  double before = 0;
  double largest = 0;
  std::size_t span_before = 0;
  for (std::size_t k = 0; largest <= tolerance && k < vertices.size(); ++k) {
    const double place = k == 0 ? from : places[k];
    const std::size_t span = span_of(knots, count, place);
    const auto n = basis(knots, span, place);
    Vector value{};
    for (std::size_t a = 0; a <= 5; ++a) value = along(value, n[a], points[span - 5 + a]);
    const double here = distance(value, vertices[k]);
    double grow = 0;
    if (k > 0) {
      const double h = place - (k == 1 ? from : places[k - 1]);
      for (std::size_t i = span_before - 5; i + 2 <= span; ++i) grow = std::max(grow, bend[i]);
      grow *= h * h / 8;
    }
    largest = std::max(largest, std::max(here, before) + grow);
    before = here;
    span_before = span;
  }
  return largest;
}

}  // namespace

bool LineFit::fit(std::size_t lines, bool ends, Fit& fit) const {
  const bool goes_on = before_.tail != nullptr;
  const double from = goes_on ? before_.knots[kDegree] : 0;
  std::vector<Vector> vertices{point_of(*waiting_[0], from)};
  fit.places = {0};
  for (std::size_t i = 0; i < lines; ++i) {
    vertices.push_back(point_of(*waiting_[i], waiting_[i]->length()));
    fit.places.push_back(fit.places.back() + waiting_[i]->length());
  }
  const double tolerance = waiting_[0]->demand().tolerance_mm * kPart;
  const double mean = fit.places.back() / static_cast<double>(lines);
  // The overlap holds the knots that a cut keeps, and more.
  const double longest = std::min(kLongestStep_mm, mean * static_cast<double>(kOverlap) / 8);
  double step = step_ > 0 ? std::min(2 * step_, longest) : longest;
  for (; step >= 0.9 * mean; step *= 0.5) {
    if (!solve(vertices, step, fit)) continue;
    fit.deviation_mm = deviation(fit.knots, fit.points, fit.places, vertices, from, tolerance);
    if (fit.deviation_mm <= tolerance) return make_segments(ends, fit);
  }
  return false;
}

bool LineFit::make_segments(bool ends, Fit& fit) const {
  Nurbs nurbs;
  nurbs.degree = static_cast<int>(kDegree);
  nurbs.dimension = 3;
  nurbs.knots = fit.knots;
  for (const Vector& point : fit.points) nurbs.points.push_back({point[0], point[1], point[2]});
  CurvePoint start;
  waiting_.front()->curve().evaluate(0, 0, 1, start);
  const auto space = std::make_shared<const curves::SpaceCurve>(nurbs, NurbsSpace::Tip,
                                                                Vector{start.d[0][3], start.d[0][4], start.d[0][5]});
  const std::size_t spans = space->spline().span_count();
  fit.cut = kDegree + spans;
  if (!ends) {
    const double keep = fit.places[fit.places.size() - 1 - kOverlap];
    fit.cut = span_of(fit.knots, fit.points.size(), keep);
    if (fit.cut <= kDegree) return false;
  }
  const double from = fit.knots[kDegree], cut = fit.knots[fit.cut];
  auto head = curves::NurbsCurve::make(space, 0, fit.cut - kDegree);
  if (!head) return false;
  fit.head = segment(fit, std::move(*head), from, cut);
  if (!fit.head) return false;
  if (ends) return true;
  auto tail = curves::NurbsCurve::make(space, fit.cut - kDegree, spans);
  if (!tail) return false;
  fit.tail = segment(fit, std::move(*tail), cut, fit.places.back());
  return fit.tail != nullptr;
}

std::shared_ptr<const PathSegment> LineFit::segment(const Fit& fit, std::shared_ptr<const Curve> curve, double from,
                                                    double to) const {
  const double rate = curve->length() / (to - from);
  std::vector<MoveStretch> stretches;
  std::size_t first = fit.places.size();
  for (std::size_t k = 0; k + 1 < fit.places.size() && fit.places[k] < to; ++k) {
    if (fit.places[k + 1] <= from) continue;
    first = std::min(first, k);
    const double a = std::max(fit.places[k], from) - fit.places[k];
    const double b = to < fit.places[k + 1] ? to - fit.places[k] : waiting_[k]->length();
    append_stretches(*waiting_[k], a, b, (fit.places[k] + a - from) * rate, (fit.places[k] + b - from) * rate,
                     stretches);
  }
  const PathSegment& line = *waiting_[first];
  PathDemand demand = line.demand();
  demand.deviation_mm = fit.deviation_mm;
  auto segment = std::make_shared<PathSegment>(std::move(curve), line.map(), demand, stretches);
  JointPoint joints;
  double s_failed = 0;
  if (line.evaluate(from - fit.places[first], 0, 1, joints) != KinematicsStatus::Ok ||
      segment->resolve({joints.d[0].data(), segment->joint_count()}, s_failed) != KinematicsStatus::Ok ||
      find_offence(*segment, joints_))
    return nullptr;
  return segment;
}

void LineFit::take(Fit fit, Segments& out) {
  out.push_back(std::move(fit.head));
  step_ = fit.knots[fit.cut] - fit.knots[fit.cut - 1];
  if (!fit.tail) {
    before_ = {};
    drop_lines(fit.places.size() - 1);
    return;
  }
  // The next window keeps the control points that shape the spline at the cut: nothing jumps there up to the fourth
  // derivative.
  const double cut = fit.knots[fit.cut];
  std::size_t done = 0;
  while (fit.places[done + 1] <= cut) ++done;
  const auto kept = static_cast<std::ptrdiff_t>(fit.cut - kDegree);
  before_ = std::move(fit);
  before_.knots.erase(before_.knots.begin(), before_.knots.begin() + kept);
  before_.points.erase(before_.points.begin(), before_.points.begin() + kept);
  const double shift = before_.places[done];
  for (double& knot : before_.knots) knot -= shift;
  before_.places.erase(before_.places.begin(), before_.places.begin() + static_cast<std::ptrdiff_t>(done));
  drop_lines(done);
}

void LineFit::advance(bool finish, Segments& out) {
  if (waiting_.empty() || !(finish || ready())) return;
  const std::size_t lines = std::min(run_length(), kWindow);
  const bool goes_on = before_.tail != nullptr;
  Fit found;
  if ((lines >= kShortest || goes_on) && fit(lines, lines < kWindow, found)) {
    take(std::move(found), out);
  } else if (goes_on) {
    // No spline follows within tolerance: the window before ends as it was found, at the end of its last line.
    out.push_back(std::move(before_.tail));
    drop_lines(before_.places.size() - 1);
    before_ = {};
  } else {
    // The whole run, as it is: less than a run would be no better.
    const std::size_t count = finish || complete() ? lines : 1;
    for (std::size_t i = 0; i < count; ++i) out.push_back(waiting_[i]);
    drop_lines(count);
  }
}

}  // namespace rmac
