#pragma once

#include <iomanip>
#include <random>
#include <sstream>

#include "unit/motion/planner/planner_bench.hpp"

namespace rmac::test {

/// What a client does after some cycles: queues a move, scales the feed, holds or goes on.
struct Action {
  enum class Kind { Queue, Override, Hold, Resume };
  Kind kind = Kind::Queue;
  int after_cycles = 0;
  double percent = 100;  ///< of `Override`
  double feed_mm_s = 0;  ///< of `Queue`, as all below
  double tolerance_mm = 0;
  int degree = 1;              ///< 0: an arc through the middle point, 1: a line, more: a NURBS over all points
  std::vector<Vector> points;  ///< behind where the queue ends
};

/// A whole program, as data: it can be cut down and run again.
struct FuzzProgram {
  double jerk_mm_s3 = 10000;
  std::vector<Action> actions;
};

/// C++ that makes the same program: what a failing test prints, to be pasted into a test of its own.
inline std::string as_code(const FuzzProgram& program) {
  std::ostringstream out;
  out << std::setprecision(17) << "FuzzProgram program{" << program.jerk_mm_s3 << ", {\n";
  static constexpr const char* kNames[] = {"Queue", "Override", "Hold", "Resume"};
  for (const Action& a : program.actions) {
    out << "  {Action::Kind::" << kNames[static_cast<int>(a.kind)] << ", " << a.after_cycles << ", " << a.percent
        << ", " << a.feed_mm_s << ", " << a.tolerance_mm << ", " << a.degree << ", {";
    for (const Vector& p : a.points) out << "{" << p[0] << ", " << p[1] << ", " << p[2] << "}, ";
    out << "}},\n";
  }
  out << "}};\n";
  return out.str();
}

inline FuzzProgram random_program(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto whole = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  FuzzProgram program;
  program.jerk_mm_s3 = seed % 2 == 0 ? 10000 : 50000;
  const int count = whole(4, 14);
  for (int i = 0; i < count; ++i) {
    Action action;
    action.after_cycles = whole(0, 3) == 0 ? whole(1, 600) : 0;
    switch (whole(0, 7)) {
      case 0:
        action.kind = Action::Kind::Override;
        action.percent = whole(0, 5) == 0 ? 0 : uniform(1, 200);
        break;
      case 1:
        action.kind = Action::Kind::Hold;
        break;
      case 2:
        action.kind = Action::Kind::Resume;
        break;
      default: {
        action.feed_mm_s = std::exp(uniform(std::log(10), std::log(200)));
        action.tolerance_mm = whole(0, 1) == 0 ? 0 : uniform(0.001, 0.2);
        action.degree = whole(0, 5);
        const int points = action.degree == 0 ? 2 : action.degree == 1 ? 1 : whole(action.degree, 9);
        for (int k = 0; k < points; ++k)
          action.points.push_back({uniform(-45, 45), uniform(-45, 45), uniform(-20, 20)});
      }
    }
    program.actions.push_back(std::move(action));
  }
  return program;
}

inline Move move_of(const Action& action, std::int64_t id, const ToolPose& from) {
  Move move;
  move.id = id;
  move.feed_mm_s = action.feed_mm_s;
  move.tolerance_mm = action.tolerance_mm;
  if (action.degree == 0) {
    move.geometry = Arc3Geometry{action.points[0], from, {action.points[1], kUp}};
  } else if (action.degree == 1) {
    move.geometry = LineGeometry{from, {action.points[0], kUp}};
  } else {
    NurbsGeometry geometry;
    auto& curve = geometry.curve;
    curve.degree = action.degree;
    curve.points.push_back({from.tip[0], from.tip[1], from.tip[2]});
    for (const Vector& p : action.points) curve.points.push_back({p[0], p[1], p[2]});
    const int count = static_cast<int>(curve.points.size());
    for (int i = 0; i < count + curve.degree + 1; ++i)
      curve.knots.push_back(std::clamp(i - curve.degree, 0, count - curve.degree));
    move.geometry = geometry;
  }
  return move;
}

/// Runs a program to its end. What went wrong in words, or nothing. A move that is refused is left out: it was refused
/// before it could move anything.
inline std::string fault_of(const FuzzProgram& program) {
  PlannerBench bench(mill(program.jerk_mm_s3));
  bench.planner.command(PathCommand::Run);
  std::size_t queued = 0;
  std::int64_t id = 0;
  for (const Action& action : program.actions) {
    for (int i = 0; i < action.after_cycles; ++i) bench.cycle();
    switch (action.kind) {
      case Action::Kind::Queue:
        if (bench.queue(move_of(action, ++id, bench.builder.end_pose()))) ++queued;
        break;
      case Action::Kind::Override:
        bench.planner.set_override(action.percent);
        break;
      case Action::Kind::Hold:
        bench.planner.command(PathCommand::Stop);
        break;
      case Action::Kind::Resume:
        bench.planner.command(PathCommand::Run);
    }
  }
  bench.planner.command(PathCommand::Run);
  bench.planner.set_override(100);
  std::ostringstream fault;
  if (!bench.run(600000)) fault << "did not come to its end; ";
  const auto peaks = bench.peaks();
  // Rounding of positions of up to 50 mm shows in their third differences, and nothing else may pass a limit.
  constexpr double kAtMost = 1.001;
  if (peaks.velocity > kAtMost) fault << "speed " << peaks.velocity << " of the limit; ";
  if (peaks.acceleration > kAtMost) fault << "acceleration " << peaks.acceleration << " of the limit; ";
  if (peaks.jerk > kAtMost) fault << "jerk " << peaks.jerk << " of the limit in cycle " << peaks.jerk_cycle << "; ";
  if (bench.moves_done() != queued) fault << bench.moves_done() << " of " << queued << " moves done; ";
  if (bench.planner.moves_left() != 0) fault << bench.planner.moves_left() << " moves left over; ";
  const auto end = bench.builder.end_joints();
  for (std::size_t j = 0; j < 3; ++j) {
    const double off = std::abs(bench.record.back().position[j] - end[j]);
    if (!(off <= 1e-9)) fault << "joint " << j << " ends " << off << " mm off; ";
  }
  return fault.str();
}

/// The smallest program found that still satisfies `fails`: without actions, without waits, without points.
template <typename Fails>
FuzzProgram shrunk(FuzzProgram program, const Fails& fails) {
  for (bool smaller = true; smaller;) {
    smaller = false;
    const auto keep_if_failing = [&](FuzzProgram tried) {
      if (!fails(tried)) return false;
      program = std::move(tried);
      smaller = true;
      return true;
    };
    for (std::size_t i = program.actions.size(); i-- > 0;) {
      FuzzProgram tried = program;
      tried.actions.erase(tried.actions.begin() + static_cast<std::ptrdiff_t>(i));
      keep_if_failing(std::move(tried));
    }
    for (std::size_t i = 0; i < program.actions.size(); ++i) {
      if (program.actions[i].after_cycles > 0) {
        FuzzProgram tried = program;
        tried.actions[i].after_cycles /= 2;
        keep_if_failing(std::move(tried));
      }
      while (static_cast<int>(program.actions[i].points.size()) > std::max(1, program.actions[i].degree) &&
             program.actions[i].degree > 1) {
        FuzzProgram tried = program;
        tried.actions[i].points.pop_back();
        if (!keep_if_failing(std::move(tried))) break;
      }
    }
  }
  return program;
}

}  // namespace rmac::test
