#include "short_lines/line_fit.hpp"

#include <algorithm>
#include <cmath>

#include "curves/nurbs_curve.hpp"
#include "curves/vector.hpp"
#include "path/part_of.hpp"
#include "path/travel.hpp"
#include "short_lines/alike.hpp"
#include "short_lines/dense_spline.hpp"
#include "short_lines/turning_curve.hpp"
#include "splines/quintic.hpp"

namespace rmac {
namespace {

using curves::along;
using quintic::kDegree;

/// The part of the tolerance that is used: something is left for the blend where the spline meets another move at a
/// corner.
constexpr double kPartForFit = 0.95;
/// Lines that turn by more meet in a corner that was meant.
constexpr double kMostTurn = 1.5;
/// Lines longer than this, in tolerances, may turn up to here where a curve through their ends is out of it: their
/// corners are passed in the tube.
constexpr double kCoarse = 4;
constexpr double kMostCoarseTurn = 0.8;
constexpr double kMostSagitta = 8;
constexpr double kLongest_mm = 5;
/// So far beside a corner with another move, in tolerances, a spline of dense lines leaves half of it for the blend.
constexpr double kCorner = 40;
/// The part of the tolerance that is used at the samples: between them the spline goes out further.
constexpr double kTubePart = 0.97;
/// Lines from which on a law with open ends says how fast a spline is: fewer are mostly ramps.
constexpr std::size_t kWorthALaw = 20;
/// A pole that was led over so far back shapes nothing any more.
constexpr double kPoleForgotten_mm = 60;

Vector point_of(const PathSegment& line, double s) {
  CurvePoint point;
  line.curve().evaluate(s, 0, 1, point);
  return {point.d[0][0], point.d[0][1], point.d[0][2]};
}

/// A line on which the tool axis stays, or may be led by the rotary joints.
bool may_be_fitted(const PathSegment& segment) {
  return segment.curve().straight() ||
         (segment.curve().even() && segment.demand().tolerance_rad > 0 && turns_lead(segment.map()->kinematics()));
}

bool short_line(const PathSegment& segment) {
  const PathDemand& demand = segment.demand();
  return demand.tolerance_mm > 0 && segment.length() < kLongest_mm && !demand.rest_before && !demand.rest_after &&
         may_be_fitted(segment);
}

/// By how much tip and axis turn from one line to the next: tangents' difference, and that of the axis by mm.
struct Corner {
  double tip = 0, axis = 0;
  Corner(const PathSegment& a, const PathSegment& b) {
    CurvePoint before, after;
    a.curve().programmed().evaluate(a.length(), 1, -1, before);
    b.curve().programmed().evaluate(0, 1, 1, after);
    const auto jump = [&](std::size_t first) {
      double sum = 0;
      for (std::size_t c = first; c < first + 3; ++c)
        sum += (after.d[1][c] - before.d[1][c]) * (after.d[1][c] - before.d[1][c]);
      return std::sqrt(sum);
    };
    tip = jump(0);
    axis = jump(3);
  }
};

/// A smooth curve through both lines' ends stays within tolerance of them (an arc of their turn is a quarter of turn
/// times length away, halved where both are alike), or they are coarse, and a curve in the tube passes the corner.
bool belong_together(const PathSegment& a, const PathSegment& b) {
  if (!short_line(a) || !short_line(b) || !alike(a, b)) return false;
  const auto [turn, axis_turn] = Corner(a, b);
  const double tolerance = a.demand().tolerance_mm;
  if (axis_turn * std::max(a.length(), b.length()) / 6 > a.demand().tolerance_rad) return false;
  if (turn < kMostTurn && turn * std::max(a.length(), b.length()) / 6 < tolerance) return true;
  return turn < kMostCoarseTurn && std::min(a.length(), b.length()) > kCoarse * tolerance &&
         turn * std::max(a.length(), b.length()) / 8 < kMostSagitta * tolerance;
}

bool turns_at_all(const PathSegment& line) {
  CurvePoint point;
  line.curve().programmed().evaluate(0, 1, 1, point);
  return point.d[1][3] != 0 || point.d[1][4] != 0 || point.d[1][5] != 0;
}

std::size_t knot_at(const LineSpline& spline, double place) {
  return quintic::span_of(spline.knots, spline.points.size(), place);
}

}  // namespace

void LineFit::clear() {
  merger_.clear();
  drop_lines(waiting_.size());
  before_ = {};
  tube_.reset();
  begins_at_join_ = false;
}

void LineFit::count_line() const noexcept {
  checked_mm_ += waiting_[checked_++]->length();
  if (checked_ < window_ && checked_ >= kTubeLines && checked_mm_ >= kWindow_mm) window_ = checked_;
}

bool LineFit::end_at_corner() noexcept {
  const std::size_t run = std::min(run_length(), window_);
  if (run < 2 * kShortest || ++corners_made_ > kMostCorners) return false;
  std::size_t first = 1, last = run - 1;
  if (coarse_ < run) {
    last = std::clamp<std::size_t>(coarse_, 1, last);
    first = std::max(last, kBeforeCoarse + 1) - kBeforeCoarse;
  }
  double sharpest = 0;
  for (std::size_t k = first; k <= last; ++k) {
    const double turn = Corner(*waiting_[k - 1], *waiting_[k]).tip;
    if (!(turn > sharpest)) continue;
    sharpest = turn;
    corner_ = k;
  }
  drop_lines(0);  // counts again
  return sharpest > 0;
}

std::size_t LineFit::run_length() const noexcept {
  while (checked_ < waiting_.size() && checked_ <= window_ && checked_ < corner_ &&
         (checked_ == 0 || belong_together(*waiting_[checked_ - 1], *waiting_[checked_])))
    count_line();
  return checked_;
}

bool LineFit::complete() const noexcept {
  return !short_line(*waiting_.front()) || run_length() < waiting_.size();
}

void LineFit::drop_lines(std::size_t count) {
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(count));
  coarse_ = coarse_ >= count && coarse_ != kNone ? coarse_ - count : kNone;
  corner_ = corner_ > count && corner_ != kNone ? corner_ - count : kNone;
  const std::size_t known = std::min(checked_ - std::min(checked_, count), corner_);
  checked_ = 0;
  checked_mm_ = 0;
  window_ = kMostLines;
  while (checked_ < known) count_line();
}

Polyline LineFit::polyline(std::size_t lines) const {
  Polyline polyline{{point_of(*waiting_[0], 0)}, {0}, {}, before_.polyline.previous};
  for (std::size_t i = 0; i < lines; ++i) {
    const PathSegment& line = *waiting_[i];
    polyline.add(point_of(line, line.length()), line.length(), line.demand().deviation_mm);
  }
  return polyline;
}

bool LineFit::fit_dense(std::size_t lines, bool ends, Fit& fit) {
  fit = {};
  fit.polyline = polyline(lines);
  const double tolerance = waiting_[0]->demand().tolerance_mm, length = fit.polyline.places.back();
  const double third = length / 3, corner = std::min(kCorner * tolerance, third);
  DenseLines dense{fit.polyline, kPartForFit * tolerance, tolerance, third};
  if (!goes_on() && begins_at_join_) dense.start_corner_mm = corner;
  if (ends && lines < waiting_.size()) dense.end_corner_mm = corner;
  auto spline = smoothest_along(dense, before_.spline);
  if (!spline) {
    const auto& places = fit.polyline.places;
    coarse_ =
        static_cast<std::size_t>(std::upper_bound(places.begin(), places.end(), spline.error()) - places.begin()) - 1;
    return false;
  }
  fit.spline = std::move(*spline);
  std::vector<std::size_t> cuts;
  if (dense.start_corner_mm > 0) cuts.push_back(knot_at(fit.spline, dense.start_corner_mm));
  if (dense.end_corner_mm > 0) cuts.push_back(knot_at(fit.spline, length - dense.end_corner_mm) + 1);
  return make_segments(std::move(cuts), length - dense.overlap_mm, ends, fit);
}

void LineFit::begin_tube(std::size_t lines, bool ends) {
  const double tolerance = waiting_[0]->demand().tolerance_mm;
  TubeWindow window{polyline(lines), before_.spline, tolerance, {}, {}, joints_};
  // At either end half of the tolerance is left for the blend with another move.
  window.widths_mm.assign(lines, kTubePart * tolerance);
  if (!goes_on()) window.widths_mm.front() = 0.5 * tolerance;
  if (ends) window.widths_mm.back() = 0.5 * tolerance;
  for (std::size_t k = 0; k < lines; ++k) window.widths_mm[k] -= kTubePart * window.polyline.off_mm[k];
  if (lines >= kWorthALaw && !turns(lines)) {  // the law knows nothing of the rotary joints
    auto limits = line_limits({waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(lines)});
    if (limits) window.limits = std::move(*limits);
  }
  tube_.emplace(Tube{TubeFit(std::move(window)), ends});
}

bool LineFit::take_tube(Fit& fit) {
  const bool ends = tube_->ends;
  fit = {};
  fit.polyline = tube_->fit.polyline();
  fit.spline = tube_->fit.spline();
  const std::vector<double>& places = fit.polyline.places;
  const std::size_t lines = fit.polyline.lines();
  std::vector<std::size_t> cuts;
  if (!goes_on()) cuts.push_back(knot_at(fit.spline, places[1]));
  if (ends) cuts.push_back(knot_at(fit.spline, places[lines - 1]));
  return make_segments(std::move(cuts), places[lines > kTubeOverlap ? lines - kTubeOverlap : 0], ends, fit);
}

std::size_t LineFit::dense_lines(std::size_t run) const noexcept {
  if (coarse_ >= run) return std::min(run, window_);
  const std::size_t lines = coarse_ - std::min(coarse_, kBeforeCoarse);
  double length = -before_.spline.free_from();
  for (std::size_t i = 0; i < lines; ++i) length += waiting_[i]->length();
  // Fewer than these are better off in the tube, together with what is too coarse.
  return lines >= 2 * kTubeLines && length >= kWindow_mm / 2 ? lines : 0;
}

bool LineFit::fit(bool finish, Fit& fit) {
  const std::size_t run = run_length();
  if (run < kShortest && !goes_on()) return false;
  ++work_;
  const bool whole = finish || complete();
  // Dense lines up to those that are too coarse, and these in the tube.
  std::size_t tried = 0;
  for (int trial = 0; trial < 2; ++trial) {
    const std::size_t lines = dense_lines(run);
    if (lines == 0 || lines == tried) break;
    if (fit_dense(lines, whole && run <= lines, fit)) return true;
    tried = lines;
  }
  begin_tube(std::min(run, kTubeLines), whole && run <= kTubeLines);
  return false;
}

bool LineFit::make_segments(std::vector<std::size_t> cuts, double tail, bool ends, Fit& fit) const {
  Nurbs nurbs;
  nurbs.degree = static_cast<int>(kDegree);
  nurbs.dimension = 3;
  nurbs.knots = fit.spline.knots;
  for (const Vector& point : fit.spline.points) nurbs.points.push_back({point[0], point[1], point[2]});
  CurvePoint start;
  waiting_.front()->curve().evaluate(0, 0, 1, start);
  const auto space = std::make_shared<const curves::SpaceCurve>(nurbs, NurbsSpace::Tip,
                                                                Vector{start.d[0][3], start.d[0][4], start.d[0][5]});
  const std::size_t last = kDegree + space->spline().span_count();
  fit.cut = last;
  if (!ends) {
    fit.cut = knot_at(fit.spline, std::max(tail, fit.spline.begin()));
    if (fit.cut <= kDegree) return false;
  }
  std::vector<std::size_t> ways{kDegree};
  cuts.push_back(fit.cut);
  for (const std::size_t to : cuts) {
    if (to > ways.back() && to <= fit.cut) ways.push_back(to);
  }
  if (!ends) ways.push_back(last);
  TipPath tip;
  tip.from = fit.spline.begin();
  for (std::size_t i = 0; i + 1 < ways.size(); ++i) {
    auto curve = curves::NurbsCurve::make(space, ways[i] - kDegree, ways[i + 1] - kDegree);
    if (!curve) return false;
    tip.add(std::move(*curve));
  }
  if (turns(fit.polyline.lines()) && !turn(tip, ends, fit)) return false;
  fit.heads.clear();
  for (std::size_t i = 0; i < tip.pieces.size(); ++i) {
    auto laid = segment(fit, tip.pieces[i], fit.spline.knots[ways[i]], fit.spline.knots[ways[i + 1]]);
    if (!laid) return false;
    if (ends || i + 1 < tip.pieces.size()) {
      fit.heads.push_back(std::move(laid));
    } else {
      fit.tail = std::move(laid);
    }
  }
  return true;
}

bool LineFit::turns(std::size_t lines) const {
  return !before_.turns.empty() ||
         std::any_of(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(lines),
                     [](const auto& line) { return !line->curve().straight() && turns_at_all(*line); });
}

bool LineFit::turn(TipPath& tip, bool ends, Fit& fit) const {
  const std::size_t lines = fit.polyline.lines();
  const PathDemand& demand = waiting_[0]->demand();
  const std::vector<std::shared_ptr<const PathSegment>> window(waiting_.begin(),
                                                               waiting_.begin() + static_cast<std::ptrdiff_t>(lines));
  LineSpline before = before_.turns;
  if (goes_on() && before.empty()) before = resting_turns(*waiting_[0]);
  fit.overs = before_.overs;
  const auto turning = turning_lines({window, fit.polyline, tip, joints_, before}, fit.overs);
  if (!turning) return false;
  const double third = tip.length / 3, corner = std::min(kCorner * demand.tolerance_mm, third);
  TurnBounds bounds{kPartForFit * demand.tolerance_rad, third};
  if (!goes_on() && begins_at_join_) bounds.start_corner_mm = corner;
  if (ends && lines < waiting_.size()) bounds.end_corner_mm = corner;
  fit.cut_mm = ends ? tip.length : tip.starts.back();
  if (!ends) bounds.knot_at = fit.cut_mm;
  auto spline = smoothest_turns(*turning, bounds, before);
  if (!spline || (!ends && !std::binary_search(spline->knots.begin(), spline->knots.end(), fit.cut_mm))) return false;
  fit.turns = std::move(*spline);
  const auto& map = waiting_[0]->map();
  const auto table = std::make_shared<const TurnTable>(fit.turns, rotary_joints(map->kinematics()).size());
  for (std::size_t i = 0; i < tip.pieces.size(); ++i)
    tip.pieces[i] = std::make_shared<const TurningCurve>(tip.pieces[i], table, tip.starts[i], map);
  return true;
}

std::shared_ptr<const PathSegment> LineFit::segment(const Fit& fit, std::shared_ptr<const Curve> curve, double from,
                                                    double to) const {
  const double rate = curve->length() / (to - from);
  std::vector<MoveStretch> stretches;
  std::size_t first = fit.polyline.places.size();
  double deviation = 0, turn = 0;
  for (std::size_t k = 0; k + 1 < fit.polyline.places.size() && fit.polyline.places[k] < to; ++k) {
    if (fit.polyline.places[k + 1] <= from) continue;
    first = std::min(first, k);
    deviation = std::max(deviation, fit.spline.deviations[k] + fit.polyline.off_mm[k]);
    if (!fit.turns.empty()) turn = std::max(turn, fit.turns.deviations[k]);
    const double a = std::max(fit.polyline.places[k], from) - fit.polyline.places[k];
    const double b = to < fit.polyline.places[k + 1] ? to - fit.polyline.places[k] : waiting_[k]->length();
    append_stretches(*waiting_[k], a, b, (fit.polyline.places[k] + a - from) * rate,
                     (fit.polyline.places[k] + b - from) * rate, stretches);
  }
  const PathSegment& line = *waiting_[first];
  PathDemand demand = line.demand();
  demand.deviation_mm = deviation;
  demand.deviation_rad = turn;
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
  if (!fit.tail) {
    before_ = {};
    drop_lines(fit.polyline.places.size() - 1);
    return;
  }
  const double cut = fit.spline.knots[fit.cut];
  std::size_t done = 0;
  while (fit.polyline.places[done + 1] <= cut) ++done;
  before_ = std::move(fit);
  before_.spline.leave(before_.cut, before_.polyline.places[done]);
  if (LineSpline& turns = before_.turns; !turns.empty()) turns.leave(knot_at(turns, before_.cut_mm), before_.cut_mm);
  for (OverPole& over : before_.overs) over.place -= before_.cut_mm;
  std::erase_if(before_.overs, [](const OverPole& over) { return over.place < -kPoleForgotten_mm; });
  auto& [vertices, places, off_mm, previous] = before_.polyline;
  if (done > 0) previous = vertices[done - 1];
  vertices.erase(vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(done));
  places.erase(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(done));
  off_mm.erase(off_mm.begin(), off_mm.begin() + static_cast<std::ptrdiff_t>(done));
  drop_lines(done);
}

void LineFit::advance(bool finish, SegmentQueue& out) {
  if (finish) merger_.flush(joints_, waiting_);
  if (waiting_.empty() || !(finish || ready())) return;
  Fit found;
  bool fits = false;
  if (tube_) {
    ++work_;
    const TubeFit::Progress progress = tube_->fit.step();
    if (progress == TubeFit::Progress::InWork) return;
    fits = progress == TubeFit::Progress::Found && take_tube(found);
    tube_.reset();
  } else {
    fits = fit(finish, found);
    if (tube_) return;
  }
  if (fits) {
    corners_made_ = 0;
    given_up_ = 0;
    take(std::move(found), out);
  } else if (goes_on()) {
    // No spline follows within tolerance: the window before ends as it was found, at the end of its last line.
    out.push_back(std::move(before_.tail));
    drop_lines(before_.polyline.places.size() - 1);
    before_ = {};
  } else {
    if (end_at_corner()) return;  // which the next step finds
    // Some lines as they are; more of them each time, so that lines which no spline follows do not cost a fit each.
    corners_made_ = 0;
    const std::size_t count = std::min({std::max<std::size_t>(run_length(), 1), window_, kShortest << given_up_});
    given_up_ = std::min(given_up_ + 1, 8);
    for (std::size_t i = 0; i < count; ++i) out.push_back(waiting_[i]);
    drop_lines(count);
  }
  begins_at_join_ = !waiting_.empty();
}

}  // namespace rmac
