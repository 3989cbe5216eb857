#include <deque>
#include <random>

#include "honest_axes.hpp"
#include "mill_on_simulated_bus.hpp"

namespace rmac::mill_test {
namespace {

class SwingingMill {
 public:
  explicit SwingingMill(const std::vector<fieldbus::SimulatedAxis>& axes, const Mill::Edit& edit = {},
                        bool late = false)
      : simulated_(std::make_shared<fieldbus::SimulatedInterface>(axes, 0.001)) {
    simulated_->set_answer_delay(late ? 2 : 0);
    bus_ = std::make_shared<ServoBus>(simulated_);
    mill_ = std::make_unique<Mill>("mill/3-axis/DMACXYZ", bus_, edit);
    command_.power = true;
  }

  void cycle() { mill_->loop().cycle(command_, report_); }
  void rest(int cycles) {
    for (int i = 0; i < cycles && sound(); ++i) {
      if (!report_.follows) hold_still();
      cycle();
    }
  }
  /// All joints by `distance`, within `feed`, `acceleration` and jerk.
  void move(double distance, double feed, double acceleration, double jerk) {
    const RestToRest profile(std::abs(distance), feed, acceleration, jerk);
    const auto start = command_.setpoint.position;
    const double sign = distance > 0 ? 1 : -1;
    const auto cycles = static_cast<int>(std::ceil(profile.duration() * 1000));
    for (int i = 1; i <= cycles && sound(); ++i) {
      const auto [s, v, a] = profile.at(i * 1e-3);
      for (std::size_t j = 0; j < 3; ++j) {
        command_.setpoint.position[j] = start[j] + sign * s;
        command_.setpoint.velocity[j] = sign * v;
        command_.setpoint.acceleration[j] = sign * a;
      }
      if (before_cycle) before_cycle();
      cycle();
    }
  }
  [[nodiscard]] bool sound() const { return report_.fault.kind == ServoFault::Kind::None; }
  [[nodiscard]] const ServoReport& report() const { return report_; }
  [[nodiscard]] fieldbus::SimulatedInterface& bus() { return *simulated_; }

  std::function<void()> before_cycle;

 private:
  void hold_still() {
    const std::span<const double> hold = mill_->loop().hold_position();
    std::copy(hold.begin(), hold.end(), command_.setpoint.position.begin());
  }

  std::shared_ptr<fieldbus::SimulatedInterface> simulated_;
  std::shared_ptr<ServoBus> bus_;
  std::unique_ptr<Mill> mill_;
  ServoCommand command_;
  ServoReport report_;
};

/// Loops that are so much slower, in forces.
Mill::Edit softer(double share) {
  return [share](nlohmann::json& device) {
    for (nlohmann::json& joint : device["Joints"]) {
      for (nlohmann::json& gain : joint["Gains"]) gain = gain.get<double>() * share;
      joint["Gains"][1] = joint["Gains"][1].get<double>() * share;
    }
  };
}

double largest_swing(const std::deque<std::array<double, kMaxJoints>>& efforts) {
  double most = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto [least, largest] = std::minmax_element(
        efforts.begin(), efforts.end(), [j](const auto& one, const auto& other) { return one[j] < other[j]; });
    most = std::max(most, (*largest)[j] - (*least)[j]);
  }
  return most;
}

TEST(OscillationOnMill, StopsTheShippedGainsOnAxesThatBend) {
  for (const double damping : {0.02, 0.005}) {
    for (const double hz : {212.0, 274.0, 350.0}) {
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SwingingMill mill(honest_axes(hz, damping, 10 * seed));
        int since_large = 0;
        std::deque<std::array<double, kMaxJoints>> lately;
        for (int i = 0; i < 3000 && mill.sound(); ++i) {
          mill.rest(1);
          lately.push_back(mill.report().effort);
          if (lately.size() > 6) lately.pop_front();
          if (since_large > 0 || largest_swing(lately) > 0.2 * 800) ++since_large;
        }
        ASSERT_STREQ(to_string(mill.report().fault.kind), "Oscillation") << hz << " Hz, " << damping;
        EXPECT_EQ(mill.report().fault.part, ServoFault::Part::Joint);
        EXPECT_NEAR(mill.report().fault.value, hz, 0.1 * hz);
        EXPECT_LE(since_large, 50 + 10) << hz << " Hz, " << damping << ", seed " << seed;
      }
    }
  }
}

TEST(OscillationOnMill, StopsThemWhereOnlyMotionSetsThemSwinging) {
  SwingingMill mill(honest_axes(600, 0.005, 1));
  mill.rest(1000);
  ASSERT_TRUE(mill.sound()) << "bristles hold it at rest";
  mill.move(20, 100, 1000, 10000);
  EXPECT_STREQ(to_string(mill.report().fault.kind), "Oscillation");
}

TEST(OscillationOnMill, StopsThemOnCanToo) {
  SwingingMill mill(honest_axes(212, 0.02, 1), softer(0.5), true);
  mill.rest(2000);
  EXPECT_STREQ(to_string(mill.report().fault.kind), "Oscillation");
}

/// What a mill does for some seconds: moves at its limits there and back, rests, blows, teeth.
void work(SwingingMill& mill, std::mt19937& random, double force_n) {
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> normal;
  const double to_shaft = 1e-3 / kRadPerMm;
  for (int part = 0; part < 6 && mill.sound(); ++part) {
    const double hz = 10 + 300 * share(random), teeth = share(random) < 0.5 ? force_n * share(random) : 0;
    const double noise = share(random) < 0.5 ? force_n / 4 * share(random) : 0;
    const double blow = share(random) < 0.3 ? 2 * force_n * share(random) : 0;
    double t = 0;
    mill.before_cycle = [&, hz, teeth, noise, blow]() mutable {
      t += 1e-3;
      const double steady = t > 0.05 ? blow : 0;
      const double cut = std::max(0.0, std::sin(2 * std::numbers::pi * hz * t)) * teeth;
      for (std::size_t j = 0; j < 3; ++j) mill.bus().push(j, to_shaft * (steady + cut + noise * normal(random)));
    };
    const bool slow = share(random) < 0.5;
    const double length = (slow ? 5 : 16) + 10 * share(random), sign = part % 2 == 0 ? 1 : -1;
    mill.move(sign * length, slow ? 30 : 80, 1000, 10000);
    mill.rest(static_cast<int>(200 * share(random)));
  }
  for (std::size_t j = 0; j < 3; ++j) mill.bus().push(j, 0);
}

TEST(OscillationOnMill, LeavesWorkAlone) {
  std::mt19937 random(17);
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const bool rigid = seed % 3 == 0, late = seed % 3 == 1;
    // Loops that hold: a rigid axis, a stiff one, and on CAN one that bends with half the gains.
    SwingingMill mill(rigid ? fieldbus::default_simulated_axes() : honest_axes(late ? 274 : 480, 0.02, seed),
                      late ? softer(0.5) : Mill::Edit{}, late);
    mill.rest(300);
    ASSERT_TRUE(mill.sound()) << "seed " << seed << ": " << to_string(mill.report().fault.kind);
    work(mill, random, 60);
    EXPECT_TRUE(mill.sound()) << "seed " << seed << ": " << to_string(mill.report().fault.kind);
  }
}

}  // namespace
}  // namespace rmac::mill_test
