// What motors take is held to statics and to Newton, by data of device.json and nothing of the loops.
#include "gateway/dynamics/axis_dynamics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>
#include <utility>

#include "gateway/device_database/device_database.hpp"
#include "gateway/tools/tool.hpp"
#include "places.hpp"

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using testing::HasSubstr;

constexpr double kPeriod_s = 0.001;
const fs::path kTree = fs::path(RMAC_BINARY_DIR) / "drivers";

struct Machine {
  explicit Machine(const std::string& folder)
      : device(read_device_database(kTree / folder / "device.json").value()),
        loader({kTree / folder, kTree / "modules"}) {}
  sdk::DeviceObject device;
  ModuleLoader loader;
};

std::unique_ptr<AxisDynamics> open(const Machine& machine) {
  auto axes = AxisDynamics::open(machine.device, machine.loader, kPeriod_s);
  if (!axes) ADD_FAILURE() << axes.error().message;
  return axes ? std::move(*axes) : nullptr;
}

/// Cycles of a motion, as the planner would leave them behind.
class Motion {
 public:
  /// `after`: hears of each cycle; may be empty.
  Motion(AxisDynamics& axes, const std::vector<double>& from, std::function<void(const CycleSample&)> after = {})
      : axes_(axes), after_(std::move(after)) {
    sample_.joint_count = sample_.joint_count_with_held = static_cast<std::uint32_t>(from.size());
    std::ranges::copy(from, sample_.position_set.begin());
    sample_.moving = true;
  }
  /// To there by the polynomial of least jerk.
  void go(const std::vector<double>& to, double time_s, const AxisDynamics::Beside& beside = {}) {
    const CycleSample from = sample_;
    const int cycles = static_cast<int>(time_s / kPeriod_s);
    for (int i = 1; i <= cycles; ++i) {
      const double u = static_cast<double>(i) / cycles;
      for (std::size_t j = 0; j < to.size(); ++j) {
        const double way = to[j] - from.position_set[j];
        sample_.position_set[j] = from.position_set[j] + way * u * u * u * (10 + u * (-15 + 6 * u));
        sample_.velocity_set[j] = way * u * u * (30 + u * (-60 + 30 * u)) / time_s;
        sample_.acceleration_set[j] = way * u * (60 + u * (-180 + 120 * u)) / (time_s * time_s);
      }
      cycle(beside);
    }
  }
  /// The force comes within a tenth of a second.
  void rest(double time_s, const AxisDynamics::Beside& beside = {}) {
    constexpr int kRise = 100;
    sample_.velocity_set.fill(0);
    sample_.acceleration_set.fill(0);
    for (int i = 1; i <= std::lround(time_s / kPeriod_s); ++i) {
      AxisDynamics::Beside now = beside;
      now.force_n *= std::min(1.0, static_cast<double>(i) / kRise);
      cycle(now);
    }
  }

 private:
  void cycle(const AxisDynamics::Beside& beside) {
    sample_.t_s += kPeriod_s;
    axes_.cycle(sample_, beside);
    if (after_) after_(sample_);
  }
  AxisDynamics& axes_;
  std::function<void(const CycleSample&)> after_;
  CycleSample sample_;
};

double most(const AxisDynamics& axes, std::size_t motor) {
  return axes.motor_torques()[motor].peak_nm;
}

// A screw turns a force into its pitch's share of a turn; what friction holds of it the motor need not.
TEST(AxisDynamics, HasMotorsHoldWhatPushesTheTool) {
  const Machine mill("mill/3-axis/DMACXYZ");
  constexpr double kPitch_mm = 5, kFriction_nm = 0.018, kForce_n = 250, kStiffness_n_mm = 25000;
  const double torque = kForce_n * kPitch_mm * 1e-3 / (2 * std::numbers::pi);
  for (const double sign : {-1.0, 1.0}) {
    for (int axis = 0; axis < 2; ++axis) {
      const auto axes = open(mill);
      Motion motion(*axes, {0, 0, 0});
      motion.rest(0.2);
      Vector3d force = Vector3d::Zero();
      force[axis] = sign * kForce_n;
      motion.rest(1, {.force_n = force});
      ASSERT_FALSE(axes->stopped()) << axes->stopped()->why;
      const auto pushed = static_cast<std::size_t>(axis), other = static_cast<std::size_t>(1 - axis);
      EXPECT_GT(most(*axes, pushed), torque - 1.2 * kFriction_nm);
      EXPECT_LT(most(*axes, pushed), 1.1 * torque + kFriction_nm);
      EXPECT_LT(most(*axes, other), 0.001);
      EXPECT_GT(axes->joint_deviations()[pushed].peak, 0.001) << "it gives way first";
      EXPECT_NEAR(axes->joints()[pushed], sign * kForce_n / kStiffness_n_mm, 0.002)
          << "the motor comes back, and what it moves stays away by what is between them";
    }
  }
}

// A table that turns feels a force by its lever: the work of the force on a small turn is that of the table's torque.
TEST(AxisDynamics, HasTurningJointsFeelForcesByTheirLever) {
  const Machine mill("mill/5-axis/SuginoXYZAC");
  std::mt19937_64 random(3);
  const auto between = [&](double least, double most) { return std::uniform_real_distribution<>(least, most)(random); };
  for (int k = 0; k < 6; ++k) {
    const auto kinematics = mill.loader.load<Kinematics>(mill.device.kinematics);
    ASSERT_TRUE(kinematics) << kinematics.error().message;
    const std::vector<double> at{between(-60, 60), between(-60, 60), between(-60, 60), between(-40, 40),
                                 between(-90, 90)};
    const Frame tip_frame = tip_on_interface({.number = 1, .length_mm = between(20, 120)});
    const Vector3d force(between(-900, 900), between(-900, 900), between(-900, 900));
    const auto tip = [&](std::size_t joint, double by) {
      std::vector<double> moved = at;
      moved[joint] += by;
      ToolPose pose;
      kinematics->object->forward(moved, tip_frame, pose);
      return Vector3d(pose.tip[0], pose.tip[1], pose.tip[2]);
    };
    std::vector<double> efforts;
    for (std::size_t j = 0; j < at.size(); ++j) {
      constexpr double kStep = 1e-3;
      const double work = force.dot(tip(j, kStep) - tip(j, -kStep)) / (2 * kStep);  // N, or N·mm a degree
      efforts.push_back(j < 3 ? work : work * 1e-3 * 180 / std::numbers::pi);
    }
    const auto map = mill.loader.load<ActuatorMap>(mill.device.actuator_map);
    ASSERT_TRUE(map) << map.error().message;
    std::vector<double> torques(mill.device.actuators.size());
    map->object->actuator_efforts(at, efforts, torques);

    const auto holds = [&](const Vector3d& pushed) {
      const auto axes = open(mill);
      Motion motion(*axes, at);
      motion.rest(6, {.tool = tip_frame, .force_n = pushed});
      EXPECT_FALSE(axes->stopped()) << axes->stopped()->why;
      return axes->motor_torques();
    };
    const auto free = holds(Vector3d::Zero()), pushed = holds(force);
    for (std::size_t i = 0; i < torques.size(); ++i) {
      // Friction takes its share of either, and the first moment counts.
      const double with = free[i].rms_nm + std::abs(torques[i]),
                   against = std::abs(free[i].rms_nm - std::abs(torques[i]));
      const double slack = 0.3 + 0.08 * std::abs(torques[i]);
      EXPECT_LT(std::min(std::abs(pushed[i].rms_nm - with), std::abs(pushed[i].rms_nm - against)), slack)
          << k << " motor " << i << " " << pushed[i].rms_nm << " " << torques[i];
    }
  }
}

TEST(AxisDynamics, TellsWhatStopsTheMachineAndWhere) {
  const Machine mill("mill/3-axis/DMACXYZ");
  const auto axes = open(mill);
  Motion motion(*axes, {0, 0, 0});
  motion.go({10, 0, 0}, 1, {.line = 3});
  motion.rest(0.5, {.line = 4, .force_n = {5000, 0, 0}});
  ASSERT_TRUE(axes->stopped());
  EXPECT_EQ(axes->stopped()->line, 4);
  EXPECT_NEAR(axes->stopped()->t_s, 1.05, 0.05);
  EXPECT_THAT(axes->stopped()->why, HasSubstr("X"));
  const std::vector<double> then(axes->joints().begin(), axes->joints().end());
  motion.rest(0.5, {.line = 5, .force_n = {5000, 0, 0}});
  EXPECT_EQ(std::vector<double>(axes->joints().begin(), axes->joints().end()), then) << "nothing goes on";
}

// Red when a motor's torque is another's, or of another cycle than the means.
TEST(AxisDynamics, TellsOfEachCycleWhatItsMeansAreMadeOf) {
  const Machine mill("mill/3-axis/DMACXYZ");
  for (unsigned seed = 1; seed <= 3; ++seed) {
    std::mt19937_64 random(seed);
    const auto between = [&](double least, double most) {
      return std::uniform_real_distribution<>(least, most)(random);
    };
    const auto axes = open(mill);
    struct Seen {
      double peak = 0, peak_t_s = 0, sum2 = 0;
    };
    std::vector<Seen> seen(mill.device.actuators.size());
    int cycles = 0;
    Motion motion(*axes, {0, 0, 0}, [&](const CycleSample& planned) {
      ++cycles;
      for (std::size_t i = 0; i < seen.size(); ++i) {
        const double nm = axes->torque_nm(i);
        seen[i].sum2 += nm * nm;
        if (std::abs(nm) > seen[i].peak) seen[i].peak = std::abs(nm), seen[i].peak_t_s = planned.t_s;
      }
    });
    for (int k = 0; k < 4; ++k) {
      motion.go({between(-30, 30), between(-30, 30), between(-30, 30)}, between(0.8, 2));
    }
    ASSERT_FALSE(axes->stopped()) << axes->stopped()->why;
    const auto told = axes->motor_torques();
    for (std::size_t i = 0; i < seen.size(); ++i) {
      EXPECT_GT(told[i].peak_nm, 0.01) << "seed " << seed << " motor " << i;
      EXPECT_EQ(told[i].peak_nm, seen[i].peak);
      EXPECT_EQ(told[i].peak_t_s, seen[i].peak_t_s);
      EXPECT_NEAR(told[i].rms_nm, std::sqrt(seen[i].sum2 / cycles), 1e-9);
    }
  }
}

TEST(AxisDynamics, BringsJointsToWhereTheMotionBegins) {
  const Machine mill("mill/3-axis/DMACXYZ");
  const auto axes = open(mill);
  Motion motion(*axes, {40, -30, 20});
  motion.rest(0.001);
  ASSERT_FALSE(axes->stopped()) << axes->stopped()->why;
  // Z's weight, which gives 4.7 µm, is in its zero.
  EXPECT_THAT(axes->joints(), testing::Pointwise(testing::DoubleNear(0.002), std::vector<double>{40, -30, 20}));
  EXPECT_LT(axes->joint_deviations()[0].peak, 0.002) << "the way there does not count";
}

/// Of a simulated axis without friction that is pushed at its load with this torque and frequency: how far the load
/// swings, rad.
double swing_rad(const fieldbus::AxisPlantParameters& parameters, double torque_nm, double frequency_hz) {
  fieldbus::AxisPlantParameters free = parameters;
  free.coulomb_nm = free.static_nm = 1e-9;
  free.viscous_nm_s = free.gravity_nm = free.cogging = 0;
  fieldbus::AxisPlant plant(free);
  constexpr double kStep_s = 2e-5;
  double least = 0, most = 0, drift = 0;
  const auto swings = static_cast<int>(60 / parameters.damping_ratio / 10);
  const auto steps = static_cast<int>(swings / frequency_hz / kStep_s);
  for (int i = 0; i < steps; ++i) {
    // A cosine leaves no drift behind.
    plant.push(torque_nm * std::cos(2 * std::numbers::pi * frequency_hz * (i + 0.5) * kStep_s));
    plant.advance(0, false, kStep_s);
    if (i < steps * 9 / 10) continue;
    if (i == steps * 9 / 10) drift = least = most = plant.load_rad();
    least = std::min(least, plant.load_rad()), most = std::max(most, plant.load_rad());
  }
  return drift != 0 ? (most - least) / 2 : 0;
}

// At its resonance an oscillator swings by the force over twice its damping and stiffness.
TEST(AxisDynamics, SwingsAtTheTipAsItsAxesDo) {
  constexpr double kMPerRad = 5e-3 / (2 * std::numbers::pi), kForce_n = 10;
  for (const auto& [stiffness, load] : {std::pair(15.8, 1.27e-5), {7.9, 1.1e-5}, {15.8, 0.6e-5}}) {
    Machine mill("mill/3-axis/DMACXYZ");
    auto& numbers = mill.device.digital_control_interface.numbers;
    numbers["stiffness_nm_rad"] = {stiffness, 0, 0, 0, 0, 0, 0, 0};
    numbers["load_inertia_kg_m2"] = {load, 0, 0, 0, 0, 0, 0, 0};
    const auto axes = open(mill);
    ASSERT_NE(axes, nullptr);
    const auto modes = axes->modes(tip_on_interface({.number = 1, .length_mm = 40}));
    ASSERT_EQ(modes.size(), 1u) << "the others are rigid";
    EXPECT_TRUE(modes[0].directions.isApprox(Vector3d::UnitX() * Vector3d::UnitX().transpose(), 1e-9));
    fieldbus::AxisPlantParameters plant;
    plant.rotor_inertia_kg_m2 = 2.2e-5, plant.screw_inertia_kg_m2 = plant.table_mass_kg = 0;
    plant.stiffness_nm_rad = stiffness, plant.load_inertia_kg_m2 = load;
    const double swings_mm = 1000 * kMPerRad * swing_rad(plant, kForce_n * kMPerRad, modes[0].frequency_hz);
    EXPECT_NEAR(kForce_n / (2 * modes[0].damping_ratio * modes[0].stiffness_n_mm) / swings_mm, 1, 0.03) << stiffness;
  }
}

// A table that leans swings its tip where the lever takes it, and the farther the longer the lever.
TEST(AxisDynamics, SwingsByTheLeverOfAJointThatTurns) {
  Machine mill("mill/5-axis/SuginoXYZAC");
  auto& numbers = mill.device.digital_control_interface.numbers;
  ASSERT_TRUE(numbers.contains("inertia_kg_m2"));
  for (const auto& [name, share] : {std::pair("stiffness_nm_rad", 0.0), {"load_inertia_kg_m2", 0.5}}) {
    numbers[name].assign(numbers["inertia_kg_m2"].size(), 0);
    const std::size_t table = mill.device.actuators[3].axis;
    numbers[name][table] = share > 0 ? share * numbers["inertia_kg_m2"][table] : 40;
  }
  const auto axes = open(mill);
  ASSERT_NE(axes, nullptr);
  const auto mode = [&](double length_mm) {
    const auto modes = axes->modes(tip_on_interface({.number = 1, .length_mm = length_mm}));
    EXPECT_EQ(modes.size(), 1u);
    return modes.front();
  };
  const VibrationMode near = mode(30), far = mode(90);
  EXPECT_EQ(near.frequency_hz, far.frequency_hz);
  EXPECT_NEAR(near.directions.trace(), 1, 1e-9);
  EXPECT_NEAR(near.directions(0, 0), 0, 1e-9) << "about X";
  EXPECT_NE(near.stiffness_n_mm, far.stiffness_n_mm);
}

// With a spring, the load swings where the motor stands: what is told is the load.
TEST(AxisDynamics, TellsWhereTheLoadIsBehindWhatBends) {
  Machine mill("mill/3-axis/DMACXYZ");
  auto& numbers = mill.device.digital_control_interface.numbers;
  numbers["stiffness_nm_rad"] = {15.8, 15.8, 0, 0, 0, 0, 0, 0};
  numbers["load_inertia_kg_m2"] = {1.27e-5, 1.27e-5, 0, 0, 0, 0, 0, 0};
  mill.device.joints[0].gains = {345, 14586, 6.0};
  mill.device.joints[1].gains = {345, 14586, 6.0};
  for (std::size_t j = 0; j < 2; ++j) {
    mill.device.joints[j].mechanics.resonances = {{.frequency_hz = 274.7, .damping = 0.02, .width = 0.3}};
    mill.device.joints[j].mechanics.low_pass_hz = 180;
  }
  const auto axes = open(mill);
  ASSERT_NE(axes, nullptr);
  Motion motion(*axes, {0, 0, 0});
  motion.rest(0.3);
  constexpr double kForce_n = 200, kStiffness_n_mm = 25'000;
  motion.rest(1.5, {.force_n = {kForce_n, 0, 0}});
  ASSERT_FALSE(axes->stopped()) << axes->stopped()->why;
  EXPECT_NEAR(axes->joints()[0] - axes->report().position[0], kForce_n / kStiffness_n_mm, 0.0008);
  EXPECT_NEAR(axes->report().position[0], 0, 0.0021) << "the encoder at the motor sees nothing of it but its rest_band";
}

TEST(AxisDynamics, RefusesWhatHasNoModelOfItsAxes) {
  Machine mill("mill/5-axis/TarusXYZCA");
  ASSERT_TRUE(AxisDynamics::open(mill.device, mill.loader, kPeriod_s)) << "it has models beside its buses";
  std::erase_if(mill.device.digital_control_interface.texts,
                [](const auto& text) { return text.first.ends_with("model.interface"); });
  const auto axes = AxisDynamics::open(mill.device, mill.loader, kPeriod_s);
  ASSERT_FALSE(axes);
  EXPECT_THAT(axes.error().message, HasSubstr("can0.model.interface"));
}

}  // namespace
}  // namespace rmac::gateway
