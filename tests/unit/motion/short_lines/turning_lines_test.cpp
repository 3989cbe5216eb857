// Lines on which the tool axis turns, on a head and on a table that turn by C and lean by A.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "curves/make_curves.hpp"
#include "rmac/motion/frame.hpp"
#include "rmac/motion/vector.hpp"
#include "seeds.hpp"
#include "unit/motion/joins/traces.hpp"

namespace rmac::test {
namespace {

constexpr double kRad = std::numbers::pi / 180;
constexpr double kTolerance_mm = 0.01, kTolerance_deg = 0.1;

enum class Machine { Head, Table };

PlannerModel five_axes(Machine machine) {
  using modules::ScrewAxis;
  const ScrewAxis x{JointType::Linear, {1, 0, 0}, {}}, y{JointType::Linear, {0, 1, 0}, {}},
      z{JointType::Linear, {0, 0, 1}, {}}, c{JointType::Rotary, {0, 0, 1}, {}};
  const ScrewAxis a{JointType::Rotary, {1, 0, 0}, {0, 0, machine == Machine::Head ? 200.0 : -60.0}};
  const std::vector<std::size_t> order =
      machine == Machine::Head ? std::vector<std::size_t>{0, 1, 2, 3, 4} : std::vector<std::size_t>{3, 4, 0, 1, 2};
  PlannerModel model;
  model.kinematics = std::make_shared<modules::ChainKinematics>(std::vector{x, y, z, c, a}, order, Frame{});
  for (const char* name : {"X", "Y", "Z"})
    model.joints.push_back({name, JointType::Linear, JointLimitType::Limited, -400, 400, 200, 2000, 20000});
  model.joints.push_back({"C", JointType::Rotary, JointLimitType::Infinite, 0, 0, 180, 600, 6000});
  model.joints.push_back({"A", JointType::Rotary, JointLimitType::Limited, -110, 110, 180, 600, 6000});
  return model;
}

Vector leaning(double lean, double around) {
  return {std::sin(lean) * std::cos(around), std::sin(lean) * std::sin(around), std::cos(lean)};
}

/// A smooth curve of poses, 59 mm long.
class PoseCurve {
 public:
  /// The axis turns by 20 degrees, well away from the pole.
  static PoseCurve flow_line(std::mt19937& random) {
    const auto between = uniform(random);
    const double lean = between(12, 30) * kRad, around = between(-3, 3), wave = between(0, 2) * kRad,
                 towards = between(-0.6, 0.6);
    return PoseCurve(random, [=](double t) {
      const double turn = 20 * kRad * t;
      return leaning(lean + std::cos(towards) * turn + wave * std::sin(5 * t),
                     around + std::sin(towards) * turn / std::sin(lean));
    });
  }
  /// It turns by 20 degrees on a great circle that passes the pole at `off_deg`.
  static PoseCurve past_pole(std::mt19937& random, double off_deg) {
    // Some come to the pole where a window of the fit ends, 24 mm behind its begin.
    const double around = uniform(random)(-3, 3), height = std::sin(off_deg * kRad),
                 place = uniform(random)(0.36, 0.44);
    return PoseCurve(random, [=](double t) {
      const double turn = 20 * kRad * (t - place), ahead = std::sin(turn), aside = height * std::cos(turn);
      return Vector{ahead * std::cos(around) - aside * std::sin(around),
                    ahead * std::sin(around) + aside * std::cos(around), std::cos(turn)};
    });
  }

  [[nodiscard]] ToolPose at(double part) const {
    CurvePoint point;
    curve_->evaluate(part * curve_->length(), 0, part > 0 ? -1 : 1, point);
    const auto& d = point.d[0];
    return {{d[0], d[1], d[2]}, {d[3], d[4], d[5]}};
  }
  [[nodiscard]] double length() const { return curve_->length(); }
  [[nodiscard]] const NurbsGeometry& geometry() const { return geometry_; }

  /// In lines between these lengths, rounded as post-processors round.
  [[nodiscard]] std::vector<ToolPose> lines(std::mt19937& random, double least_mm, double most_mm, bool rounded) const {
    std::vector<ToolPose> corners;
    for (double s = 0; s < length() - 0.01; s += uniform(random)(least_mm, most_mm))
      corners.push_back(at(s / length()));
    corners.push_back(at(1));
    for (ToolPose& corner : corners) {
      for (std::size_t i = 0; rounded && i < 3; ++i) {
        corner.tip[i] = std::round(corner.tip[i] * 1e3) / 1e3;
        corner.axis[i] = std::round(corner.axis[i] * 1e6) / 1e6;
      }
    }
    return corners;
  }

  static std::function<double(double, double)> uniform(std::mt19937& random) {
    return [&random](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  }

 private:
  PoseCurve(std::mt19937& random, const std::function<Vector(double)>& axis) {
    const auto between = uniform(random);
    const double across = between(-4, 4), up = between(-3, 3), phase = between(0, 6);
    constexpr int kDegree = 5, kPoints = 24;
    geometry_.space = NurbsSpace::Pose;
    geometry_.curve.degree = kDegree;
    geometry_.curve.dimension = 6;
    for (int i = 0; i < kPoints + kDegree + 1; ++i)
      geometry_.curve.knots.push_back(std::clamp(i - kDegree, 0, kPoints - kDegree));
    for (int i = 0; i < kPoints; ++i) {
      double t = 0;  // Greville's
      for (int k = 1; k <= kDegree; ++k) t += geometry_.curve.knots[static_cast<std::size_t>(i + k)] / kDegree;
      t /= kPoints - kDegree;
      const Vector a = axis(t);
      geometry_.curve.points.push_back(
          {59 * (t - 0.5), across * std::sin(4 * t + phase), up * std::cos(3 * t + 2 * phase), a[0], a[1], a[2]});
    }
    Move move;
    move.id = 1;
    move.feed_mm_s = 1;
    move.geometry = geometry_;
    const auto& p = geometry_.curve.points.front();
    const ToolPose start{{p[0], p[1], p[2]}, unit({p[3], p[4], p[5]})};
    auto curves = make_curves(move, {start, {}});
    EXPECT_TRUE(curves && curves->size() == 1);
    curve_ = std::move(curves->front());
  }

  NurbsGeometry geometry_;
  std::shared_ptr<const Curve> curve_;
};

/// Runs programs of poses and judges them.
class Program {
 public:
  explicit Program(Machine machine, const ToolPose& start, const Frames& frames = {})
      : model_(five_axes(machine)), frames_(frames), bench(model_) {
    std::vector<double> seed(5, 0.0), joints(5, 0.0);
    bench.builder.restart(seed, frames);
    EXPECT_EQ(model_.kinematics->inverse(apply_to_pose(frames.part, start), frames.tool, seed, joints),
              KinematicsStatus::Ok);
    move.id = 1;
    move.feed_mm_s = 100;
    move.tolerance_mm = kTolerance_mm;
    move.geometry = JointTargetGeometry{joints};
    EXPECT_TRUE(bench.queue(move));
  }

  void queue(const Geometry& geometry) {
    ++move.id;
    move.geometry = geometry;
    const auto queued = bench.queue(move);
    EXPECT_TRUE(queued) << queued.error().message;
  }
  void queue(const std::vector<ToolPose>& corners, int cycles_between = 0) {
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
      queue(LineGeometry{corners[i], corners[i + 1]});
      for (int k = 0; k < cycles_between; ++k) bench.cycle();
    }
  }
  /// To the end, within all limits and with every move done in its turn.
  void finish() {
    bench.planner.command(PathCommand::Run);
    ASSERT_TRUE(bench.run());
    EXPECT_EQ(bench.planner.moves_left(), 0U);
    EXPECT_EQ(bench.moves_done(), static_cast<std::size_t>(move.id));
    const auto peaks = bench.peaks();
    EXPECT_LE(peaks.velocity, kAtMost);
    EXPECT_LE(peaks.acceleration, kAtMost);
    EXPECT_LE(peaks.jerk, kAtMost) << "in cycle " << peaks.jerk_cycle;
    std::int64_t id = 0;
    for (const Setpoint& setpoint : bench.record) {
      EXPECT_GE(setpoint.move_id, id);
      id = setpoint.move_id;
    }
  }

  [[nodiscard]] ToolPose pose(const Setpoint& setpoint) const {
    ToolPose pose;
    model_.kinematics->forward({setpoint.position.data(), 5}, frames_.tool, pose);
    return apply_to_pose(inverse(frames_.part), pose);
  }
  /// Time from rest to rest behind the joint move.
  [[nodiscard]] double seconds() const {
    int moving = 0;
    for (const Setpoint& setpoint : bench.record) moving += setpoint.moving && setpoint.move_id > 1 ? 1 : 0;
    return 1e-3 * moving;
  }

  /// Between begin and end of the lines.
  [[nodiscard]] int rests() const {
    int rests = 0;
    bool moving = false;
    for (const Setpoint& setpoint : bench.record) {
      if (setpoint.move_id < 2) continue;
      rests += moving && !setpoint.moving ? 1 : 0;
      moving = setpoint.moving;
    }
    return rests - (moving ? 0 : 1);
  }

  /// Tip and axis stay within these of the lines, and end where they end.
  void expect_along(const std::vector<ToolPose>& corners, double tip_mm, double axis_deg) const {
    double worst_tip = 0, worst_axis = 0;
    std::size_t line = 0;
    for (const Setpoint& setpoint : bench.record) {
      if (setpoint.move_id < 2) continue;
      const ToolPose here = pose(setpoint);
      double least = 1e9, part = 0;
      std::size_t best = line;
      for (std::size_t k = line; k + 1 < corners.size() && k < line + 40; ++k) {
        const Vector way = difference(corners[k + 1].tip, corners[k].tip);
        const double along_it = std::clamp(dot(difference(here.tip, corners[k].tip), way) / dot(way, way), 0.0, 1.0);
        const double off = distance(here.tip, along(corners[k].tip, along_it, way));
        if (off >= least) continue;
        least = off;
        best = k;
        part = along_it;
      }
      line = best;
      const Vector a = unit(corners[line].axis), b = unit(corners[line + 1].axis);
      // Lines turn by less than a degree: the chord is the great circle.
      const Vector asked = unit(along(a, part, difference(b, a)));
      worst_tip = std::max(worst_tip, least);
      worst_axis = std::max(worst_axis, std::atan2(norm(cross(here.axis, asked)), dot(here.axis, asked)) / kRad);
    }
    EXPECT_LE(worst_tip, tip_mm + 1e-6);
    EXPECT_LE(worst_axis, axis_deg + 1e-4);
    const ToolPose end = pose(bench.record.back());
    EXPECT_LE(distance(end.tip, corners.back().tip), 1e-9);
    EXPECT_LE(distance(end.axis, unit(corners.back().axis)), 1e-9);
  }

 private:
  PlannerModel model_;
  Frames frames_;

 public:
  Move move;
  PlannerBench bench;
};

double seconds_of_nurbs(Machine machine, const PoseCurve& curve) {
  Program run(machine, curve.at(0));
  run.queue(curve.geometry());
  run.finish();
  return run.seconds();
}

class TurningLines : public ::testing::TestWithParam<std::tuple<unsigned, Machine>> {
 protected:
  std::mt19937 random_{std::get<0>(GetParam())};
  const Machine machine_ = std::get<1>(GetParam());
};

TEST_P(TurningLines, TakeNoLongerThanTheCurveTheyCameFrom) {
  const PoseCurve curve = PoseCurve::flow_line(random_);
  const double as_curve = seconds_of_nurbs(machine_, curve);
  for (const auto& [least_mm, most_mm] : {std::pair{0.98, 0.98}, {0.1, 0.1}, {0.05, 1.0}}) {
    const auto corners = curve.lines(random_, least_mm, most_mm, true);
    Program run(machine_, corners.front());
    run.queue(corners);
    run.finish();
    run.expect_along(corners, kTolerance_mm, kTolerance_deg);
    EXPECT_LE(run.seconds(), 1.05 * as_curve) << "lines of " << least_mm << " to " << most_mm << " mm";
  }
}

TEST_P(TurningLines, PassThePoleAsFastAsTheCurve) {
  for (const double off_deg : {0.0, 0.05, 0.5}) {
    const PoseCurve curve = PoseCurve::past_pole(random_, off_deg);
    const double as_curve = seconds_of_nurbs(machine_, curve);
    const auto corners = curve.lines(random_, 0.1, 0.6, true);
    Program run(machine_, corners.front());
    run.queue(corners);
    run.finish();
    run.expect_along(corners, kTolerance_mm, kTolerance_deg);
    EXPECT_LE(run.seconds(), 1.2 * as_curve) << off_deg;
  }
}

TEST_P(TurningLines, PassBesideThePoleWithoutRest) {
  for (const double off_deg : {0.08, 0.12, 0.155, 0.22, 0.3}) {
    const PoseCurve curve = PoseCurve::past_pole(random_, off_deg);
    const auto corners = curve.lines(random_, 0.1, 0.4, true);
    Program run(machine_, corners.front());
    run.move.feed_mm_s = PoseCurve::uniform(random_)(20, 100);
    run.move.orientation_tolerance_deg = PoseCurve::uniform(random_)(0.03, 0.6);
    run.queue(corners);
    run.finish();
    run.expect_along(corners, kTolerance_mm, run.move.orientation_tolerance_deg);
    EXPECT_EQ(run.rests(), 0) << off_deg;
  }
}

TEST_P(TurningLines, KeepToleranceHoweverTheyArrive) {
  const PoseCurve curve = PoseCurve::flow_line(random_);
  const auto corners = curve.lines(random_, 0.2, 0.8, true);
  Program run(machine_, corners.front());
  run.bench.planner.command(PathCommand::Run);
  run.queue(corners, 5);
  run.finish();
  run.expect_along(corners, kTolerance_mm, kTolerance_deg);
}

TEST_P(TurningLines, KeepToleranceInAPartThatLiesAskewUnderALongTool) {
  const PoseCurve curve = PoseCurve::flow_line(random_);
  const auto corners = curve.lines(random_, 0.1, 0.8, true);
  const double half = 4 * kRad;
  const Frames frames{{{30, -20, 10}, {std::cos(half), std::sin(half) * 0.6, std::sin(half) * 0.8, 0}},
                      {{0, 0, -120}, {1, 0, 0, 0}}};
  Program run(machine_, corners.front(), frames);
  run.queue(corners);
  run.finish();
  run.expect_along(corners, kTolerance_mm, kTolerance_deg);
  EXPECT_EQ(run.rests(), 0);
}

TEST_P(TurningLines, LeaveTheAxisWhereItWasAskedWithoutToleranceOfIt) {
  const PoseCurve curve = PoseCurve::flow_line(random_);
  const auto corners = curve.lines(random_, 2, 4, false);
  Program run(machine_, corners.front());
  run.move.orientation_tolerance_deg = 0;
  run.queue(corners);
  run.finish();
  run.expect_along(corners, kTolerance_mm, 0);
}

TEST_P(TurningLines, AreHeldAndOverriddenAnywhere) {
  for (const double off_deg : {0.0, 0.3, 15.0}) {
    const PoseCurve curve = PoseCurve::past_pole(random_, off_deg);
    const auto corners = curve.lines(random_, 0.1, 0.6, true);
    Program run(machine_, corners.front());
    run.queue(corners);
    const auto between = PoseCurve::uniform(random_);
    run.bench.planner.command(PathCommand::Run);
    for (int i = 0; i < 12; ++i) {
      run.bench.planner.set_override(between(10, 200));
      const int cycles = 1 + static_cast<int>(between(0, 300));
      for (int k = 0; k < cycles; ++k) run.bench.cycle();
      if (i % 3 != 0) continue;
      run.bench.planner.command(PathCommand::Stop);
      ASSERT_TRUE(run.bench.run());
      run.bench.planner.command(PathCommand::Run);
    }
    run.finish();
    run.expect_along(corners, kTolerance_mm, kTolerance_deg);
  }
}

TEST_P(TurningLines, JoinWithWhatFollows) {
  const PoseCurve curve = PoseCurve::flow_line(random_);
  auto corners = curve.lines(random_, 0.1, 0.5, true);
  Program run(machine_, corners.front());
  run.queue(corners);
  // On with the axis at rest, in lines as short, around a corner, and back with it turning.
  const auto on = [&](const Vector& way, int lines, double turn) {
    for (int i = 0; i < lines; ++i) {
      const ToolPose last = corners.back();
      const Vector axis = unit(along(last.axis, turn, {0, 0, 1}));
      corners.push_back({along(last.tip, 1, way), axis});
      run.queue(LineGeometry{last, corners.back()});
    }
  };
  on({0.3, 0, 0}, 30, 0);
  on({0, 0.3, 0}, 30, 0.002);
  Arc3Geometry arc;
  arc.start = corners.back();
  arc.via = along(arc.start.tip, 1, {-2, 2, 0});
  arc.end = {along(arc.start.tip, 1, {-4, 0, 0}), arc.start.axis};
  run.queue(arc);
  run.queue(JointTargetGeometry{{0, 0, 0, 0, 0}});
  run.finish();
  const Setpoint& end = run.bench.record.back();
  for (std::size_t j = 0; j < 5; ++j) EXPECT_NEAR(end.position[j], 0, 1e-9);
  // What was laid before the arc kept its tolerance.
  std::erase_if(run.bench.record, [&](const Setpoint& setpoint) {
    return setpoint.move_id > static_cast<std::int64_t>(corners.size()) || setpoint.move_id < 2;
  });
  double worst = 0;
  Trace lines;
  for (const ToolPose& corner : corners) lines.push_back(corner.tip);
  for (const Setpoint& setpoint : run.bench.record)
    worst = std::max(worst, distance_to_trace(run.pose(setpoint).tip, lines));
  EXPECT_LE(worst, kTolerance_mm + 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Seeds, TurningLines,
                         ::testing::Combine(seeds(6), ::testing::Values(Machine::Head, Machine::Table)));

}  // namespace
}  // namespace rmac::test
