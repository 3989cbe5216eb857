#include "random_programs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "../motion/machines.hpp"
#include "../motion/shapes.hpp"
#include "curves/vector.hpp"

namespace rmac::bench {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
/// Places stay inside of this, mm.
constexpr double kReach = 45;

class Maker {
 public:
  explicit Maker(unsigned long number) : random_(number) {}

  RandomProgram make(unsigned long number) {
    RandomProgram program;
    const double acceleration = logarithmic(300, 5000), jerk = logarithmic(500, 100'000);
    program.model = bench_xyz(acceleration, jerk);
    program.tolerance_mm = chance(0.2) ? 0 : logarithmic(0.001, 0.1);
    move_.tolerance_mm = program.tolerance_mm;
    move_.feed_mm_s = logarithmic(2, 200);
    if (chance(0.3)) move_.accel_rise_mm_s2 = logarithmic(50, 3000);
    if (chance(0.3)) move_.accel_fall_mm_s2 = logarithmic(50, 3000);
    struct Kind {
      const char* name;
      void (Maker::*make)();
    };
    constexpr std::array kKinds{Kind{"long lines", &Maker::long_lines},
                                Kind{"short lines", &Maker::short_lines},
                                Kind{"zigzag", &Maker::zigzag},
                                Kind{"spiral", &Maker::spiral},
                                Kind{"arcs", &Maker::arcs},
                                Kind{"NURBS", &Maker::nurbs},
                                Kind{"tiny lines", &Maker::tiny_lines},
                                Kind{"mixed", &Maker::mixed}};
    const Kind& kind = kKinds[pick(kKinds.size())];
    at_ = place(30);
    (this->*kind.make)();
    program.moves = std::move(moves_);
    const auto number_of = [](const char* what, double value) {
      return std::string(", ") + what + std::to_string(value);
    };
    program.name = "program " + std::to_string(number) + ", " + kind.name + number_of("a ", acceleration) +
                   number_of("j ", jerk) + number_of("tolerance ", program.tolerance_mm);
    return program;
  }

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
  double logarithmic(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  bool chance(double part) { return uniform(0, 1) < part; }
  std::size_t pick(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_); }
  Vector place(double reach) { return {uniform(-reach, reach), uniform(-reach, reach), uniform(-10, 10)}; }

  void add(Geometry geometry, const Vector& end) {
    move_.id = static_cast<std::int64_t>(moves_.size()) + 1;
    move_.geometry = std::move(geometry);
    moves_.push_back(move_);
    at_ = end;
  }
  void line_to(Vector to) {
    for (double& value : to) value = std::clamp(value, -kReach, kReach);
    if (curves::distance(at_, to) < 1e-6) return;
    add(LineGeometry{{at_, kUp}, {to, kUp}}, to);
  }
  /// As a post-processor writes it.
  void rounded_line_to(Vector to) {
    for (double& value : to) value = std::round(value * 1000) / 1000;
    line_to(to);
  }

  void long_lines() {
    for (std::size_t n = 2 + pick(6); n > 0; --n) line_to(place(40));
  }
  void short_lines() {
    const double radius = logarithmic(0.5, 15), step = logarithmic(0.02, 1), rise = uniform(-0.5, 0.5);
    const Vector centre = at_;
    const double lobes = static_cast<double>(1 + pick(5)), depth = uniform(0, 0.6);
    const std::size_t lines = 30 + pick(300);
    for (std::size_t i = 0; i < lines; ++i) {
      const double angle = static_cast<double>(i) * step / radius, r = radius * (1 + depth * std::cos(lobes * angle));
      rounded_line_to({centre[0] + r * std::cos(angle), centre[1] + r * std::sin(angle), centre[2] + rise * angle});
    }
  }
  void zigzag() {
    const double height = logarithmic(0.01, 3), pitch = logarithmic(0.01, 1), slope = uniform(0, kTurn);
    const Vector along{std::cos(slope), std::sin(slope), 0}, across{-along[1], along[0], 0}, start = at_;
    const std::size_t lines = 20 + pick(250);
    for (std::size_t i = 1; i <= lines; ++i) {
      const double n = static_cast<double>(i), side = i % 2 == 0 ? -height : height;
      line_to(curves::along(curves::along(start, n * pitch, along), side, across));
    }
  }
  void spiral() {
    const double gap = logarithmic(0.05, 3), chord = logarithmic(0.02, 0.5);
    const Vector centre = at_;
    double radius = uniform(0, 0.5), angle = 0;
    const std::size_t lines = 50 + pick(350);
    for (std::size_t i = 0; i < lines && radius < 15; ++i) {
      const double turn = std::min(chord / std::max(radius, 0.1), 1.0);
      angle += turn;
      radius += gap * turn / kTurn;
      rounded_line_to({centre[0] + radius * std::cos(angle), centre[1] + radius * std::sin(angle), centre[2]});
    }
  }
  void arc() {
    const double radius = logarithmic(0.2, 12), from = uniform(0, kTurn), turn = uniform(0.2, 1.9) * kTurn / 2;
    ArcGeometry arc;
    arc.rotation = chance(0.5) ? 1 : -1;
    for (std::size_t c = 0; c < 3; ++c)
      arc.center[c] = at_[c] - (c == 0 ? radius * std::cos(from) : c == 1 ? radius * std::sin(from) : 0);
    const double to = from + arc.rotation * turn;
    const Vector end{arc.center[0] + radius * std::cos(to), arc.center[1] + radius * std::sin(to), at_[2]};
    if (std::abs(arc.center[0]) + radius > kReach || std::abs(arc.center[1]) + radius > kReach) return;
    arc.start = {at_, kUp};
    arc.end = {end, kUp};
    add(arc, end);
  }
  void arcs() {
    while (moves_.size() < 3) arc();
    for (std::size_t n = pick(8); n > 0; --n) arc();
  }
  void curve() {
    const std::size_t poles = 6 + pick(8);
    const double size = logarithmic(1, 30);
    std::vector<std::vector<double>> points{{at_[0], at_[1], at_[2]}};
    while (points.size() < poles) {
      const auto& before = points.back();
      const Vector step = curves::scaled(size / 40, place(40));
      points.push_back({std::clamp(before[0] + step[0], -kReach, kReach),
                        std::clamp(before[1] + step[1], -kReach, kReach),
                        std::clamp(before[2] + step[2], -kReach, kReach)});
    }
    const Vector end{points.back()[0], points.back()[1], points.back()[2]};
    add(NurbsGeometry{NurbsSpace::Tip, clamped(3 + static_cast<int>(pick(3)), std::move(points))}, end);
  }
  void nurbs() {
    for (std::size_t n = 1 + pick(2); n > 0; --n) curve();
  }
  void tiny_lines() {
    const double length = logarithmic(0.001, 0.02);
    double heading = uniform(0, kTurn);
    for (std::size_t n = 40 + pick(300); n > 0; --n) {
      heading += uniform(-0.3, 0.3);
      line_to({at_[0] + length * std::cos(heading), at_[1] + length * std::sin(heading), at_[2]});
    }
  }
  void mixed() {
    for (std::size_t n = 4 + pick(12); n > 0; --n) {
      switch (pick(4)) {
        case 0:
          line_to(place(40));
          break;
        case 1:
          arc();
          break;
        case 2:
          curve();
          break;
        default:
          for (std::size_t k = 1 + pick(20); k > 0; --k)
            line_to(curves::along(at_, logarithmic(0.001, 2) / 40, place(40)));
      }
    }
    if (moves_.empty()) line_to(place(40));
  }

  std::mt19937_64 random_;
  Move move_;
  Vector at_{};
  std::vector<Move> moves_;
};

}  // namespace

RandomProgram random_program(unsigned long number) {
  return Maker(number).make(number);
}

}  // namespace rmac::bench
