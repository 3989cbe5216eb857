#include <random>

#include "mill_on_simulated_bus.hpp"
#include "rmac/modules/proportional_transmissions.hpp"
#include "rmac/modules/transmission_map.hpp"
#include "rmac/motion/servo/servo_handover.hpp"

namespace rmac::mill_test {
namespace {

constexpr double kBoundX = 0.5;  // mm: MaxFollowingError
constexpr std::size_t kLeft = 0, kRight = 1, kRightAxis = 4;
const Gantry kHeldLate{.max_skew = 0.2, .stiffness = 519, .damping = 7.6};  // the same of drives that answer late
const Gantry kHeld{.max_skew = 0.2, .stiffness = 1550, .damping = 11.1};    // halves of the law's Kp and Kd

/// DMACXYZ with X on two screws, which nothing holds together but a bridge as stiff as `bridge_n_mm`.
class GantryRun : public MillRun {
 public:
  explicit GantryRun(std::optional<Gantry> gantry, double bridge_n_mm = 0,
                     std::vector<fieldbus::SimulatedAxis> axes = fieldbus::default_simulated_axes(), bool late = false)
      : bridge_nm_rad_(bridge_n_mm / 1000 / (kRadPerMm * kRadPerMm)) {
    simulated_ = std::make_shared<fieldbus::SimulatedInterface>(axes, 0.001);
    if (late) simulated_->set_answer_delay(1);
    bus_ = std::make_shared<ServoBus>(simulated_);
    make(gantry, late);
  }
  /// Another loop on the same drives.
  void make(const std::optional<Gantry>& gantry, bool late = false, std::int32_t right_home_counts = 0) {
    mill_.emplace(
        "mill/3-axis/DMACXYZ", bus_,
        [late, right_home_counts](nlohmann::json& device) {
          nlohmann::json& x = device["Joints"][0];
          if (late) x["Gains"] = {519, 31140, 7.6};
          for (nlohmann::json& gain : x["Gains"]) gain = 2 * gain.get<double>();
          x["MaxEffort"] = 1600;
          device["Actuators"].insert(device["Actuators"].begin() + 1, device["Actuators"][0]);
          device["Actuators"][1]["Axis"] = kRightAxis;
          device["Actuators"][1]["HomeCounts"] = right_home_counts;
        },
        [&](Mill&, ServoLoopParts& parts) {
          std::vector<std::unique_ptr<ActuatorMap>> maps;
          maps.push_back(std::make_unique<modules::GantryPair>(5, 1));
          for (int i = 0; i < 2; ++i)
            maps.push_back(std::make_unique<modules::Proportional>(modules::Proportional::screw(5, 1)));
          parts.actuator_map = std::make_shared<modules::TransmissionMap>(std::move(maps));
          parts.joints[0].gantry = gantry;
          parts.joints[0].bounds.stop_deceleration = 1000;
        });
  }
  [[nodiscard]] Mill& mill() { return *mill_; }
  [[nodiscard]] fieldbus::AxisPlant& side(std::size_t side) {
    return simulated_->plant(side == kLeft ? 0 : kRightAxis);
  }
  [[nodiscard]] double skew_mm() { return (side(kLeft).load_rad() - side(kRight).load_rad()) / kRadPerMm; }

  /// One cycle with what the bridge does to either side. False from a fault on.
  bool step() {
    // Of a cycle before: it damps by more than that swings.
    constexpr double kDampingS = 0.002;
    const double speed = side(kLeft).load_rad_s() - side(kRight).load_rad_s();
    const double pull = bridge_nm_rad_ * (side(kLeft).load_rad() - side(kRight).load_rad() + kDampingS * speed);
    simulated_->push(0, -pull);
    simulated_->push(kRightAxis, pull);
    mill_->loop().cycle(command_, report_);
    largest_skew_ = std::max(largest_skew_, std::abs(skew_mm()));
    return report_.fault.kind == ServoFault::Kind::None;
  }
  bool stand(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      if (!step()) return false;
    }
    return true;
  }
  void enable() {
    command_.power = true;
    for (int i = 0; i < 100 && !report_.follows; ++i) {
      ASSERT_TRUE(step());
      hold_still(*mill_);
    }
    ASSERT_TRUE(report_.follows);
  }
  /// X to and fro, so many times; `before` each cycle.
  bool go(int times, const std::function<void(int cycle)>& before = {}, double way = 10, double feed = 2000.0 / 60) {
    const RestToRest profile(way, feed, 1000, 10000);
    int cycle = 0;
    for (int k = 0; k < times; ++k) {
      const double start = command_.setpoint.position[0], sign = k % 2 == 0 ? 1 : -1;
      for (double t = 0.001; t < profile.duration() + 0.001; t += 0.001) {
        const auto [s, v, a] = profile.at(t);
        command_.setpoint.position[0] = start + sign * s;
        command_.setpoint.velocity[0] = sign * v;
        command_.setpoint.acceleration[0] = sign * a;
        if (before) before(cycle++);
        if (!step()) return false;
      }
    }
    return true;
  }
  [[nodiscard]] fieldbus::SimulatedInterface& simulated() { return *simulated_; }
  [[nodiscard]] const ServoReport& report() const { return report_; }
  [[nodiscard]] double largest_skew() const { return largest_skew_; }
  void power(bool on) { command_.power = on; }
  /// Leaves a fault as a person does who knows no better, and enables again.
  void reset_and_enable() {
    power(false);
    stand(500);
    command_.reset = true;
    stand(20);
    command_.reset = false;
    command_.power = true;
    for (int i = 0; i < 100 && !report_.follows; ++i) {
      hold_still(*mill_);
      step();
    }
  }

 private:
  static constexpr double kRadPerMm = 2 * std::numbers::pi / 5;
  double bridge_nm_rad_, largest_skew_ = 0;
  std::optional<Mill> mill_;
};

/// Sides of one machine differ: one carries the cable chain, the other the motor of the spindle.
std::vector<fieldbus::SimulatedAxis> sides_that_differ(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto times = [&](double least, double most) { return std::uniform_real_distribution<>(least, most)(random); };
  std::vector<fieldbus::SimulatedAxis> axes = fieldbus::default_simulated_axes();
  auto& right = std::get<fieldbus::AxisPlantParameters>(axes[kRightAxis]);
  right.table_mass_kg *= times(0.6, 1.6);
  right.viscous_nm_s *= times(0.5, 2);
  const double friction = times(0.6, 1.6);
  right.coulomb_nm *= friction;
  right.static_nm *= friction;
  right.encoder.seed = seed;
  return axes;
}

TEST(GantryOnMill, IsHeldTogetherThoughItsSidesDifferAndNothingElseHoldsThem) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const bool late = seed % 2 == 0;
    GantryRun run(late ? kHeldLate : kHeld, 0, sides_that_differ(seed), late);
    run.enable();
    EXPECT_TRUE(run.go(20)) << to_string(run.report().fault.kind) << " " << run.report().fault.value;
    EXPECT_LT(run.largest_skew(), late ? 0.15 : 0.06);
    EXPECT_NEAR(run.report().ahead[kLeft] - run.report().ahead[kRight], run.skew_mm(), 1e-3);
  }
}

TEST(GantryOnMill, StopsBeforeItsFrameIsBentWhereNothingHoldsItTogether) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    GantryRun run({}, 0, sides_that_differ(seed));
    run.enable();
    EXPECT_FALSE(run.go(400));
    EXPECT_STREQ(to_string(run.report().fault.kind), "Skewed");
    run.stand(1000);
    EXPECT_LT(std::abs(run.skew_mm()), kBoundX + 0.2);
  }
}

TEST(GantryOnMill, IsLeftToAStiffBridgeUnlessItIsSaid) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    GantryRun run({}, 1000, sides_that_differ(seed));
    run.enable();
    EXPECT_TRUE(run.go(20));
    EXPECT_LT(run.largest_skew(), 0.1);
  }
}

TEST(GantryOnMill, StopsWhereOneOfItsEncodersFreezes) {
  int named = 0, near = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    std::mt19937_64 random(seed);
    const auto below = [&](int end) { return std::uniform_int_distribution<>(0, end - 1)(random); };
    const std::size_t side = below(2) == 0 ? kLeft : kRight;
    const int frozen_at = 50 + below(1500);
    const bool noise = below(2) == 0, held = below(2) == 0;
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", side " << side << ", at " << frozen_at
                                    << (held ? ", held" : ", a bridge"));
    std::vector<fieldbus::SimulatedAxis> axes = sides_that_differ(seed);
    for (const std::size_t axis : {std::size_t{0}, kRightAxis})
      std::get<fieldbus::AxisPlantParameters>(axes[axis]).encoder.noise_counts = noise ? 1 : 0;
    GantryRun run(held ? std::optional(kHeld) : std::nullopt, held ? 0 : 1000, axes);
    run.enable();
    double way = 0, before = 0;
    int cycles = 0;
    EXPECT_FALSE(run.go(10, [&](int cycle) {
      const double wanted = run.report().position_set[0];
      if (cycle > frozen_at) ++cycles, way += std::abs(wanted - before);
      before = wanted;
      if (cycle == frozen_at) run.simulated().freeze_encoder(side == kLeft ? 0 : kRightAxis, true);
    }));
    const std::string kind = to_string(run.report().fault.kind);
    EXPECT_TRUE(kind == "EncoderFrozen" || kind == "Skewed") << kind;
    named += kind == "EncoderFrozen" ? 1 : 0;
    EXPECT_EQ(run.report().fault.part, ServoFault::Part::Actuator);
    EXPECT_EQ(run.report().fault.index, side);
    EXPECT_TRUE(way < 1 || cycles < 20) << way << " mm, " << cycles << " cycles";
    run.stand(1000);
    EXPECT_LT(run.largest_skew(), 5);
    near += run.largest_skew() < 1 ? 1 : 0;
  }
  EXPECT_GE(named, 70);
  EXPECT_GE(near, 95);
}

// Of axes that stick by up to a tenth of MaxEffort, while they creep and turn round.
TEST(GantryOnMill, HasNoFrozenEncoderWhereASideSticks) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const auto between = [&](double least, double most) {
      return std::uniform_real_distribution<>(least, most)(random);
    };
    std::vector<fieldbus::SimulatedAxis> axes = sides_that_differ(seed);
    const double friction = between(0.01, 0.035);
    for (const std::size_t axis : {std::size_t{0}, kRightAxis}) {
      auto& plant = std::get<fieldbus::AxisPlantParameters>(axes[axis]);
      plant.coulomb_nm = friction * between(0.7, 1.4);
      plant.static_nm = plant.coulomb_nm * between(1, 1.3);
      plant.encoder.noise_counts = between(0, 2) < 1 ? 1 : 0;
    }
    const bool held = between(0, 2) < 1;
    GantryRun run(held ? std::optional(kHeld) : std::nullopt, held ? 0 : 1000, axes);
    run.enable();
    const double feed = 0.2 * std::pow(150, between(0, 1));
    EXPECT_TRUE(run.go(4, {}, feed / 4, feed)) << to_string(run.report().fault.kind) << " at " << feed << " mm/s";
  }
}

TEST(GantryOnMill, StopsWhereOneSideSeizes) {
  for (const std::size_t side : {kLeft, kRight}) {
    SCOPED_TRACE(side);
    GantryRun run(kHeld, 50);
    run.enable();
    EXPECT_FALSE(run.go(3, [&](int cycle) {
      if (cycle == 200) run.side(side).touch({20, 0.05, run.side(side).load_rad(), true});
    }));
    EXPECT_STREQ(to_string(run.report().fault.kind), "Skewed");
    EXPECT_EQ(run.report().fault.index, side);
    run.stand(1000);
    EXPECT_LT(run.largest_skew(), 0.4) << "0.2 mm, three cycles, and the brakes'";
  }
}

TEST(GantryOnMill, IsBentByNoResetBeyondTwiceItsBound) {
  for (const bool held : {true, false}) {
    SCOPED_TRACE(held);
    GantryRun run(held ? std::optional(kHeld) : std::nullopt, 50);
    const double bound = held ? kHeld.max_skew : kBoundX;
    run.enable();
    EXPECT_FALSE(run.go(3, [&](int cycle) {
      if (cycle == 200) run.side(kLeft).touch({20, 0.05, run.side(kLeft).load_rad(), true});
    }));
    for (int round = 0; round < 10; ++round) {
      run.reset_and_enable();
      EXPECT_FALSE(run.report().follows && run.go(2));
      EXPECT_NE(run.report().fault.kind, ServoFault::Kind::None);
      EXPECT_LE(run.report().fault.bound, 2 * bound);
    }
    EXPECT_LT(run.largest_skew(), 2 * bound + 0.2);
  }
}

// Whoever pushed them, or whichever counter lost a turn: nobody asked for that way.
TEST(GantryOnMill, IsNotEnabledWhereItsSidesAreFarApart) {
  GantryRun run(kHeld);
  run.enable();
  ASSERT_TRUE(run.stand(100));
  run.power(false);
  run.stand(200);
  run.side(kLeft).put_at(run.side(kLeft).angle_rad() + 15 * 2 * std::numbers::pi / 5);
  run.side(kRight).put_at(run.side(kRight).angle_rad() - 15 * 2 * std::numbers::pi / 5);
  const double apart = run.skew_mm();
  run.power(true);
  run.stand(300);
  EXPECT_STREQ(to_string(run.report().fault.kind), "Skewed");
  EXPECT_NEAR(run.report().fault.value, 30, 0.1);
  EXPECT_NEAR(run.skew_mm(), apart, 0.01);
}

TEST(GantryOnMill, HasNoFrozenEncoderAsItsPowerComesAgain) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    std::vector<fieldbus::SimulatedAxis> axes = sides_that_differ(seed);
    for (const std::size_t axis : {std::size_t{0}, kRightAxis})
      std::get<fieldbus::AxisPlantParameters>(axes[axis]).encoder.noise_counts = 1;
    GantryRun run(kHeld, 0, axes);
    run.enable();
    ASSERT_TRUE(run.stand(200));
    run.power(false);
    run.stand(100);
    for (const std::size_t side : {kLeft, kRight}) run.side(side).put_at(run.side(side).angle_rad() + 0.04);
    run.enable();
    EXPECT_TRUE(run.stand(50)) << to_string(run.report().fault.kind);
  }
}

TEST(GantryOnMill, RestsWithAWeightThatItsLawDoesNotKnow) {
  std::vector<fieldbus::SimulatedAxis> axes = fieldbus::default_simulated_axes();
  for (const std::size_t axis : {std::size_t{0}, kRightAxis})
    std::get<fieldbus::AxisPlantParameters>(axes[axis]).gravity_nm = 0.2;
  GantryRun run(kHeld, 0, axes);
  for (const std::size_t side : {kLeft, kRight}) run.side(side).put_at(300 * 2 * std::numbers::pi / 5);
  run.power(true);
  for (int i = 0; i < 1000 && !run.report().follows; ++i) {
    run.hold_still(run.mill());
    run.stand(1);
  }
  run.stand(200);
  EXPECT_STREQ(to_string(run.report().fault.kind), "None");
  EXPECT_TRUE(run.report().follows);
}

TEST(GantryOnMill, StopsWhereItsHoldSwings) {
  Gantry swings = kHeld;
  swings.damping *= 8;
  GantryRun run(swings, 0, sides_that_differ(3));
  run.enable();
  (void)(run.go(1) && run.stand(2000));
  EXPECT_STREQ(to_string(run.report().fault.kind), "Oscillation");
}

// As after a stop.
TEST(GantryOnMill, IsBroughtBackByAndByWhereItWasBentWithoutPower) {
  GantryRun run(kHeld, 20);
  run.enable();
  ASSERT_TRUE(run.stand(200));
  run.power(false);
  run.stand(200);
  run.side(kLeft).put_at(run.side(kLeft).angle_rad() + 0.4 * 2 * std::numbers::pi / 5);
  const double bent = run.skew_mm();
  run.enable();
  double before = bent;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(run.stand(100)) << to_string(run.report().fault.kind) << " " << run.report().fault.value;
    EXPECT_LT(run.skew_mm(), before + 0.002);
    if (i == 4) {
      EXPECT_LT(run.skew_mm(), 0.2 * bent) << "after half a second";
    }
    before = run.skew_mm();
  }
  EXPECT_LT(std::abs(run.skew_mm()), 0.05);
  EXPECT_GT(bent, 0.35);
}

TEST(GantryOnMill, KnowsHowItBelongsWhereAnotherLoopTakesItsDrives) {
  GantryRun run(kHeld, 0, sides_that_differ(3));
  run.enable();
  ASSERT_TRUE(run.go(1));
  const double before = run.report().ahead[kLeft];
  const ServoLoop& old = run.mill().loop();
  const ServoHandover handover = old.handover();
  // Where it has its home is of no matter to how it belongs.
  run.make(kHeld, false, 10'000);
  run.mill().loop().engage(handover);
  ASSERT_TRUE(run.step());
  EXPECT_NEAR(run.report().ahead[kLeft], before, 0.002);
  EXPECT_TRUE(run.stand(500));
  EXPECT_LT(run.largest_skew(), 0.06);
}

TEST(GantryOnMill, IsRefusedWhereThereIsNothingToHold) {
  const auto refusal = [](const Gantry& gantry, std::size_t joint) {
    std::string said;
    Mill mill("mill/3-axis/DMACXYZ",
              std::make_shared<ServoBus>(
                  std::make_shared<fieldbus::SimulatedInterface>(fieldbus::default_simulated_axes(), 0.001)),
              {}, [&](Mill&, ServoLoopParts& parts) {
                parts.joints[joint].gantry = gantry;
                const auto made = ServoLoop::create(ServoLoopParts(parts));
                said = made ? "" : made.error().message;
                parts.joints[joint].gantry.reset();
              });
    return said;
  };
  EXPECT_EQ(refusal(kHeld, 1), "servo loop: joint 1 has a Gantry, and not several motors of its own; take it out");
}

}  // namespace
}  // namespace rmac::mill_test
