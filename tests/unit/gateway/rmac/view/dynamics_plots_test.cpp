// A mill's own loops and models go through seeded motions; what the page plots is held to them cycle by cycle.
#include "gateway/rmac/view/dynamics_plots.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "gateway/device_database/device_database.hpp"
#include "places.hpp"
#include "plotted.hpp"

namespace rmac::cli {
namespace {

using nlohmann::json;

/// Half of the last digit of the page's numbers, and of its times where a value changes fast.
constexpr double kErrorRounding = 1e-6, kShareRounding = 1e-4, kPeriod_s = 0.001;
const std::filesystem::path kTree = std::filesystem::path(RMAC_BINARY_DIR) / "drivers";

struct Mill {
  explicit Mill(const std::string& folder)
      : device(gateway::read_device_database(kTree / folder / "device.json").value()),
        loader({kTree / folder, kTree / "modules"}) {}
  [[nodiscard]] std::unique_ptr<gateway::AxisDynamics> open() const {
    auto axes = gateway::AxisDynamics::open(device, loader, kPeriod_s);
    if (!axes) ADD_FAILURE() << axes.error().message;
    return axes ? std::move(*axes) : nullptr;
  }
  /// On axes of which motor and load are one, and whose encoders are right: what they do is smooth.
  void have_rigid_axes() {
    for (const char* bends : {"stiffness_nm_rad", "load_inertia_kg_m2", "presliding_turns", "cogging", "torque_ripple",
                              "encoder_noise_counts", "encoder_interpolation_counts"}) {
      device.digital_control_interface.numbers.erase(bends);
    }
    for (sdk::Actuator& actuator : device.actuators) actuator.cogging = {};
  }
  sdk::DeviceObject device;
  gateway::ModuleLoader loader;
};

/// Hurried and easy moves with rests between them, as a planner of limited jerk would have them, more or less.
std::vector<gateway::CycleSample> moves_at_random(unsigned seed, std::size_t joints, int moves) {
  std::mt19937_64 random(seed);
  const auto between = [&](double least, double most) { return std::uniform_real_distribution<>(least, most)(random); };
  std::vector<gateway::CycleSample> cycles;
  gateway::CycleSample sample;
  sample.joint_count = sample.joint_count_with_held = static_cast<std::uint32_t>(joints);
  const auto add = [&](bool moving) {
    sample.moving = moving;
    sample.t_s += kPeriod_s;
    cycles.push_back(sample);
  };
  for (int move = 0; move < moves; ++move) {
    const gateway::CycleSample from = sample;
    std::array<double, kMaxJoints> way{};
    for (std::size_t j = 0; j < joints; ++j) way[j] = between(-25, 25) - from.position_set[j];
    const double time_s = between(0.6, 1.5);
    const int count = static_cast<int>(time_s / kPeriod_s);
    for (int i = 1; i <= count; ++i) {
      const double u = static_cast<double>(i) / count;
      for (std::size_t j = 0; j < joints; ++j) {
        sample.position_set[j] = from.position_set[j] + way[j] * u * u * u * (10 + u * (-15 + 6 * u));
        sample.velocity_set[j] = way[j] * u * u * (30 + u * (-60 + 30 * u)) / time_s;
        sample.acceleration_set[j] = way[j] * u * (60 + u * (-180 + 120 * u)) / (time_s * time_s);
      }
      add(true);
    }
    for (int i = 0; i < static_cast<int>(random() % 200); ++i) add(false);
  }
  return cycles;
}

const json& find(const json& plots, const std::string& row, const std::string& name) {
  const auto found = std::ranges::find_if(plots, [&](const json& p) { return p["row"] == row && p["name"] == name; });
  EXPECT_NE(found, plots.end()) << row << " " << name;
  return *found;
}

/// The page's plots after a machine went through some cycles.
json plotted(gateway::AxisDynamics& axes, const std::vector<gateway::CycleSample>& cycles,
             const std::function<void(const gateway::CycleSample&)>& after) {
  PlotTracks plots;
  DynamicsPlots kept(axes, plots);
  for (const gateway::CycleSample& planned : cycles) {
    axes.cycle(planned, {.line = 1});
    kept.cycle(planned);
    after(planned);
  }
  axes.finish();
  plots.end();
  return plots.to_json();
}

// Red when a plot is another joint's or motor's, a cycle late, a share of something else, or coarser than it says. What
// cogs takes more points than what is smooth.
TEST(DynamicsPlots, HoldEveryCycleWithinWhatTheySay) {
  for (const std::string folder : {"mill/3-axis/DMACXYZ", "mill/5-axis/SuginoXYZAC"}) {
    const double cycles_a_point = folder == "mill/3-axis/DMACXYZ" ? 1.5 : 4;
    Mill mill(folder);
    if (folder == "mill/5-axis/SuginoXYZAC") mill.have_rigid_axes();
    for (unsigned seed = 1; seed <= 4; ++seed) {
      const auto axes = mill.open();
      ASSERT_NE(axes, nullptr);
      const std::size_t count = mill.device.joints.size(), motors = mill.device.actuators.size();
      std::vector<std::vector<Sample>> off(count), torque(motors);
      const json plots = plotted(*axes, moves_at_random(seed, count, 4), [&](const gateway::CycleSample& planned) {
        for (std::size_t j = 0; j < count; ++j) {
          off[j].push_back({planned.t_s, axes->joints()[j] - planned.position_set[j]});
        }
        for (std::size_t i = 0; i < motors; ++i) {
          const double rated_nm = mill.device.actuators[i].scale.rated_torque_nm;
          torque[i].push_back({planned.t_s, axes->torque_nm(i) / rated_nm});
        }
      });
      ASSERT_FALSE(axes->stopped()) << axes->stopped()->why;
      ASSERT_EQ(plots.size(), 1 + count + motors);
      for (std::size_t j = 0; j < count; ++j) {
        const json& plot = find(plots, "joints off", mill.device.joints[j].limits.name);
        EXPECT_EQ(plot["unit"], mill.device.joints[j].limits.type == JointType::Rotary ? "°" : "mm");
        EXPECT_EQ(plot["within"], DynamicsPlots::kWithin);
        EXPECT_LE(farthest(plot, off[j]), DynamicsPlots::kWithin + kErrorRounding)
            << folder << " seed " << seed << " joint " << j;
        EXPECT_LT(static_cast<double>(plot["t"].size()), static_cast<double>(off[j].size()) / cycles_a_point);
      }
      for (std::size_t i = 0; i < motors; ++i) {
        const sdk::Actuator& actuator = mill.device.actuators[i];
        const json& plot = find(plots, "motors", actuator.bus + " " + std::to_string(actuator.axis));
        EXPECT_EQ(plot["within"], DynamicsPlots::kWithinOfRated);
        EXPECT_LE(farthest(plot, torque[i]), DynamicsPlots::kWithinOfRated + kShareRounding)
            << folder << " seed " << seed;
        const double stops_nm = actuator.max_measured_torque_nm, rated_nm = actuator.scale.rated_torque_nm;
        const double allowed = stops_nm > 0 ? stops_nm / rated_nm : 3.5;
        EXPECT_EQ(plot["levels"], json({{{"name", "rated"}, {"is", 1.0}}, {{"name", "allowed"}, {"is", allowed}}}));
        EXPECT_LT(static_cast<double>(plot["t"].size()), static_cast<double>(torque[i].size()) / cycles_a_point);
      }
    }
  }
}

// The plot of the tip is of the same cycles as its greatest deviation and its mean square.
TEST(DynamicsPlots, HaveTheTipAsFarOffItsPathAsItIs) {
  const Mill mill("mill/5-axis/SuginoXYZAC");
  for (unsigned seed = 11; seed <= 13; ++seed) {
    const auto axes = mill.open(), again = mill.open();
    ASSERT_NE(axes, nullptr);
    ASSERT_NE(again, nullptr);
    const auto cycles = moves_at_random(seed, mill.device.joints.size(), 4);
    const json plots = plotted(*axes, cycles, [](const auto&) {});
    std::vector<Sample> told;
    again->on_deviation([&](double t_s, double off_mm) { told.push_back({t_s, off_mm}); });
    for (const gateway::CycleSample& planned : cycles) again->cycle(planned, {.line = 1});
    again->finish();
    EXPECT_EQ(told.size(), static_cast<std::size_t>(std::ranges::count_if(cycles, &gateway::CycleSample::moving)));
    const json& plot = find(plots, "off the path", "off the path");
    EXPECT_LE(farthest(plot, told), DynamicsPlots::kWithin + kErrorRounding) << "seed " << seed;
    EXPECT_EQ(plot["levels"], json({{{"name", "PositioningTolerance"}, {"is", mill.device.positioning_tolerance_mm}}}));
    const auto is = plot["is"].get<std::vector<double>>();
    EXPECT_NEAR(*std::ranges::max_element(is), axes->deviation().peak_mm(), DynamicsPlots::kWithin);
    EXPECT_GT(axes->deviation().peak_mm(), 5 * DynamicsPlots::kWithin) << "which is little against what it shows";
  }
}

TEST(DynamicsPlots, EndWhereAFaultStopsTheMachine) {
  Mill mill("mill/3-axis/DMACXYZ");
  mill.device.joints[0].max_following_error = 0.001;
  const auto axes = mill.open();
  ASSERT_NE(axes, nullptr);
  const json plots = plotted(*axes, moves_at_random(5, 3, 3), [](const auto&) {});
  ASSERT_TRUE(axes->stopped());
  for (const json& plot : plots) {
    EXPECT_LE(plot["t"].back().get<double>(), axes->stopped()->t_s + 1e-9) << plot["row"] << plot["name"];
  }
  EXPECT_NEAR(find(plots, "joints off", "X")["t"].back().get<double>(), axes->stopped()->t_s, 1e-9);
}

// A machine that allows any deviation has nothing to hold the tip against.
TEST(DynamicsPlots, HoldTheTipAgainstNothingWhereEverythingIsAllowed) {
  Mill mill("mill/3-axis/DMACXYZ");
  mill.device.positioning_tolerance_mm = 0;
  const auto axes = mill.open();
  ASSERT_NE(axes, nullptr);
  const json plots = plotted(*axes, moves_at_random(6, 3, 1), [](const auto&) {});
  EXPECT_EQ(find(plots, "off the path", "off the path")["levels"], json::array());
}

}  // namespace
}  // namespace rmac::cli
