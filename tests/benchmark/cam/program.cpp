#include "program.hpp"

#include <algorithm>
#include <cmath>

#include "../motion/shapes.hpp"
#include "judge.hpp"

namespace rmac::bench {
namespace {

double distance(const Vector& a, const Vector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double distance_to_line(const Vector& p, const Vector& a, const Vector& b) {
  double along = 0, length = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    along += (p[c] - a[c]) * (b[c] - a[c]);
    length += (b[c] - a[c]) * (b[c] - a[c]);
  }
  const double part = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0;
  return distance(p, {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2])});
}

/// How far points that go along a polyline, forward only, are from it. One that is farther than `enough` from where the
/// search has come to is looked for anywhere: paths that turn back on themselves lead a search astray.
double off(const std::vector<Vector>& points, const std::vector<Vector>& polyline, double enough = 1e300) {
  // As far ahead as a tool may have come in a cycle, and more.
  constexpr double kAhead_mm = 2;
  double worst = 0;
  std::size_t line = 0;
  for (const Vector& point : points) {
    double least = 1e300, ahead_mm = 0;
    std::size_t best = line;
    const auto look_at = [&](std::size_t k) {
      const double here = distance_to_line(point, polyline[k], polyline[k + 1]);
      if (here < least) {
        least = here;
        best = k;
      }
    };
    for (std::size_t k = line; k + 1 < polyline.size() && ahead_mm < kAhead_mm; ++k) {
      look_at(k);
      if (k > line) ahead_mm += distance(polyline[k], polyline[k + 1]);
    }
    if (least > enough) {
      for (std::size_t k = 0; k + 1 < polyline.size(); ++k) look_at(k);
    }
    worst = std::max(worst, least);
    line = best;
  }
  return worst;
}

/// The way with places between a cycle and the next, by the cubic through four of them: a chord between two setpoints
/// is a little inside of a bend.
std::vector<Vector> between_cycles(const std::vector<Vector>& way) {
  std::vector<Vector> finer;
  for (std::size_t i = 0; i + 1 < way.size(); ++i) {
    const Vector &a = way[i > 0 ? i - 1 : 0], &b = way[i], &c = way[i + 1], &d = way[std::min(i + 2, way.size() - 1)];
    for (const double u : {0.0, 0.25, 0.5, 0.75}) {
      Vector at;
      for (std::size_t k = 0; k < 3; ++k) {
        const double rise = (c[k] - a[k]) / 2, fall = (d[k] - b[k]) / 2, step = c[k] - b[k];
        at[k] = b[k] + u * (rise + u * (3 * step - 2 * rise - fall + u * (rise + fall - 2 * step)));
      }
      finer.push_back(at);
    }
  }
  finer.push_back(way.back());
  return finer;
}

}  // namespace

std::vector<Vector> rounded(std::vector<Vector> corners, double to_mm) {
  for (Vector& corner : corners) {
    for (double& value : corner) value = std::round(value / to_mm) * to_mm;
  }
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

tl::expected<Machined, std::string> machine(const Program& program, const PlannerModel& model) {
  const auto& corners = program.corners;
  Judge judge(model, {corners.front().begin(), corners.front().end()});
  std::vector<Vector> way{corners.front()};
  judge.on_joints = [&way](std::span<const double> joints) { way.push_back({joints[0], joints[1], joints[2]}); };
  Move move;
  move.feed_mm_s = program.feed_mm_s;
  move.tolerance_mm = program.tolerance_mm;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    move.id = static_cast<std::int64_t>(i) + 1;
    move.geometry = LineGeometry{{corners[i], kUp}, {corners[i + 1], kUp}};
    if (auto queued = judge.drive.queue(move); !queued) return tl::unexpected(queued.error().message);
  }
  auto done = judge.run();
  // Of the tool from the lines, and of each corner from the tool's way.
  if (done) done->deviation_mm = std::max(off(way, corners), off(corners, between_cycles(way)));
  return done;
}

namespace {

/// What was sent, as a polyline that misses it by less than a micrometre: finer where it bends.
void append(std::vector<Vector>& polyline, const PathSegment& segment) {
  constexpr double kStep_mm = 0.02, kLeastSteps = 8;
  if (polyline.empty()) polyline.push_back(segment.pose(0).tip);
  const auto nodes = segment.nodes();
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
    const double width = nodes[k + 1] - nodes[k];
    const double steps = segment.curve().straight() ? 1 : std::max(std::ceil(width / kStep_mm), kLeastSteps);
    for (double i = 1; i <= steps; ++i) polyline.push_back(segment.pose(nodes[k] + width * i / steps).tip);
  }
}

}  // namespace

tl::expected<Machined, NotMachined> machine(const std::vector<Move>& moves, const PlannerModel& model) {
  const auto start_of = [](const Geometry& geometry) -> Vector {
    if (const auto* line = std::get_if<LineGeometry>(&geometry)) return line->start.tip;
    if (const auto* arc = std::get_if<ArcGeometry>(&geometry)) return arc->start.tip;
    const auto& pole = std::get<NurbsGeometry>(geometry).curve.points.front();
    return {pole[0], pole[1], pole[2]};
  };
  const Vector start = start_of(moves.front().geometry);
  Judge judge(model, {start.begin(), start.end()});
  std::vector<Vector> way{start}, sent;
  judge.on_joints = [&way](std::span<const double> joints) { way.push_back({joints[0], joints[1], joints[2]}); };
  PathBuilder builder(model);
  builder.restart(std::vector<double>{start[0], start[1], start[2]}, Frames{});
  for (const Move& move : moves) {
    const auto segments = builder.build(move);
    if (!segments) return tl::unexpected(NotMachined{true, segments.error().message});
    for (const auto& segment : *segments) append(sent, *segment);
    if (auto queued = judge.drive.queue(move); !queued)
      return tl::unexpected(NotMachined{true, queued.error().message});
  }
  auto done = judge.run();
  if (!done) return tl::unexpected(NotMachined{false, done.error()});
  done->deviation_mm = off(way, sent, moves.front().tolerance_mm);
  return *done;
}

tl::expected<Machined, std::string> machine(const Nurbs& nurbs, double tolerance_mm, double feed_mm_s,
                                            const PlannerModel& model) {
  const auto& start = nurbs.points.front();
  Judge judge(model, {start[0], start[1], start[2]});
  Move move;
  move.id = 1;
  move.feed_mm_s = feed_mm_s;
  move.tolerance_mm = tolerance_mm;
  move.geometry = NurbsGeometry{NurbsSpace::Tip, nurbs};
  if (auto queued = judge.drive.queue(move); !queued) return tl::unexpected(queued.error().message);
  return judge.run();
}

}  // namespace rmac::bench
