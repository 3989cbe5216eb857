#include "gateway/buses/simulated_bus.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>
#include <string>

namespace rmac::gateway {
namespace {

using fieldbus::AxisPlantParameters;
using fieldbus::SimulatedAxis;
using fieldbus::SimulatedContact;
using fieldbus::SpindlePlantParameters;

constexpr double kTurn = 2 * std::numbers::pi;

struct Bounds {
  double min;
  double max;
};

constexpr Bounds kAxisCount{1, 64}, kSpindle{-1, 63}, kLateAnswers{0, kMostAnswerDelay};
constexpr Bounds kSeed{0, 2147483647};
constexpr const char* kLateAnswersName = "late_answers";
constexpr const char* kSeedName = "seed";

constexpr Bounds kModes{static_cast<double>(DriveMode::CyclicSyncPosition),
                        static_cast<double>(DriveMode::CyclicSyncTorque)};

/// What one number says of an axis, at the motor shaft.
struct OfAxis {
  Bounds bounds;
  void (*set)(AxisPlantParameters& axis, double value);
};

const std::map<std::string, OfAxis> kOfAxis{
    {"rated_torque_nm",
     {{1e-3, 1e4},
      [](AxisPlantParameters& axis, double value) {
        axis.rated_torque_nm = axis.brake_nm = value;
        axis.peak_torque_nm = 3 * value;
      }}},
    {"inertia_kg_m2",
     {{1e-8, 1e3},
      [](AxisPlantParameters& axis, double value) {
        axis.rotor_inertia_kg_m2 = value;
        axis.screw_inertia_kg_m2 = axis.table_mass_kg = 0;
      }}},
    {"friction_nm",
     {{0, 1e4},
      [](AxisPlantParameters& axis, double value) {
        axis.coulomb_nm = value;
        axis.static_nm = 1.2 * value;
      }}},
    {"gravity_nm", {{-1e4, 1e4}, [](AxisPlantParameters& axis, double value) { axis.gravity_nm = value; }}},
    {"negative_switch_turns",
     {{-1e6, 1e6}, [](AxisPlantParameters& axis, double value) { axis.negative_switch_rad = kTurn * value; }}},
    {"positive_switch_turns",
     {{-1e6, 1e6}, [](AxisPlantParameters& axis, double value) { axis.positive_switch_rad = kTurn * value; }}},
    {"mode",
     {kModes, [](AxisPlantParameters& axis, double value) { axis.mode = static_cast<DriveMode>(std::lround(value)); }}},
    {"counts_per_revolution",
     {{1, 4294967296.0}, [](AxisPlantParameters& axis, double value) { axis.encoder.counts_per_revolution = value; }}},
    {"stiffness_nm_rad", {{0, 1e9}, [](AxisPlantParameters& axis, double value) { axis.stiffness_nm_rad = value; }}},
    {"load_inertia_kg_m2",
     {{0, 1e3}, [](AxisPlantParameters& axis, double value) { axis.load_inertia_kg_m2 = value; }}},
    {"damping_ratio", {{0, 1}, [](AxisPlantParameters& axis, double value) { axis.damping_ratio = value; }}},
    {"play_turns", {{0, 1}, [](AxisPlantParameters& axis, double value) { axis.play_rad = kTurn * value; }}},
    {"friction_at_load", {{0, 1}, [](AxisPlantParameters& axis, double value) { axis.friction_at_load = value; }}},
    {"presliding_turns",
     {{1e-5, 1}, [](AxisPlantParameters& axis, double value) { axis.presliding_rad = kTurn * value; }}},
    {"cogging", {{0, 1}, [](AxisPlantParameters& axis, double value) { axis.cogging = value; }}},
    {"cogging_periods", {{1, 1e4}, [](AxisPlantParameters& axis, double value) { axis.cogging_periods = value; }}},
    {"torque_ripple", {{0, 1}, [](AxisPlantParameters& axis, double value) { axis.torque_ripple = value; }}},
    {"torque_ripple_periods",
     {{1, 1e4}, [](AxisPlantParameters& axis, double value) { axis.torque_ripple_periods = value; }}},
    {"encoder_noise_counts",
     {{0, 1e6}, [](AxisPlantParameters& axis, double value) { axis.encoder.noise_counts = value; }}},
    {"encoder_interpolation_counts",
     {{0, 1e6}, [](AxisPlantParameters& axis, double value) { axis.encoder.interpolation_counts = value; }}},
    {"encoder_signal_periods",
     {{1, 1e6}, [](AxisPlantParameters& axis, double value) { axis.encoder.signal_periods = value; }}},
    {"encoder_at_load", {{0, 1}, [](AxisPlantParameters& axis, double value) { axis.encoder.at_load = value >= 0.5; }}},
};

struct OfSpindle {
  Bounds bounds;
  double SpindlePlantParameters::*member;
};

const std::map<std::string, OfSpindle> kOfSpindle{
    {"spindle_max_rpm", {{1, 1e6}, &SpindlePlantParameters::max_speed_rpm}},
    {"spindle_max_torque_nm", {{1e-3, 1e5}, &SpindlePlantParameters::max_torque_nm}},
};

struct OfContact {
  Bounds bounds;
  double SimulatedContact::*member;
};

const std::map<std::string, OfContact> kOfContact{
    {"contact_surface_mm", {{-1e6, 1e6}, &SimulatedContact::surface_mm}},
    {"contact_stiffness_n_mm", {{1e-3, 1e6}, &SimulatedContact::stiffness_n_mm}},
    {"contact_damping_n_s_mm", {{0, 1e4}, &SimulatedContact::damping_n_s_mm}},
    {"contact_slope", {{-1, 1}, &SimulatedContact::slope}},
    {"contact_wave_mm", {{0, 100}, &SimulatedContact::wave_mm}},
    {"contact_wave_length_mm", {{0.1, 1e5}, &SimulatedContact::wave_length_mm}},
    {"contact_pitch_mm", {{0.1, 1000}, &SimulatedContact::pitch_mm}},
};

tl::unexpected<Error> refuse_bus(std::string message) {
  return failure(MinorCode::InvalidParameterValue, "SimulatedInterface: " + std::move(message));
}

bool inside(double value, Bounds bounds) {
  return value >= bounds.min && value <= bounds.max;
}

/// A whole number among the parameters, or `otherwise`.
Expected<int> whole_number(const sdk::ModuleChoice& choice, const char* name, Bounds bounds, int otherwise) {
  const auto given = choice.numbers.find(name);
  if (given == choice.numbers.end()) return otherwise;
  const std::vector<double>& numbers = given->second;
  if (numbers.size() != 1 || numbers[0] != std::floor(numbers[0]) || !inside(numbers[0], bounds)) {
    return refuse_bus(
        fmt::format("parameter \"{}\" must be one whole number from {} to {}", name, bounds.min, bounds.max));
  }
  return static_cast<int>(numbers[0]);
}

Expected<> set_axes(const std::string& name, const std::vector<double>& numbers, const OfAxis& of,
                    std::vector<SimulatedAxis>& axes) {
  if (numbers.size() != axes.size()) {
    return refuse_bus(
        fmt::format("parameter \"{}\" has {} numbers; give one for each of the {} axes, 0 for the spindle", name,
                    numbers.size(), axes.size()));
  }
  for (std::size_t i = 0; i < axes.size(); ++i) {
    auto* axis = std::get_if<AxisPlantParameters>(&axes[i]);
    if (axis == nullptr) continue;
    if (!inside(numbers[i], of.bounds)) {
      return refuse_bus(fmt::format("parameter \"{}\": {} of axis {} must be {} to {}", name, numbers[i], i,
                                    of.bounds.min, of.bounds.max));
    }
    of.set(*axis, numbers[i]);
  }
  return {};
}

Expected<> set_spindle(const std::string& name, const std::vector<double>& numbers, const OfSpindle& of,
                       std::vector<SimulatedAxis>& axes) {
  if (numbers.size() != 1 || !inside(numbers[0], of.bounds)) {
    return refuse_bus(
        fmt::format("parameter \"{}\" must be one number from {} to {}", name, of.bounds.min, of.bounds.max));
  }
  for (SimulatedAxis& axis : axes) {
    if (auto* spindle = std::get_if<SpindlePlantParameters>(&axis)) spindle->*of.member = numbers[0];
  }
  return {};
}

tl::unexpected<Error> not_understood(const std::string& name) {
  std::string known = "axes, spindle, late_answers, seed, contact_axis, contact_along";
  for (const auto& [key, ignored] : kOfSpindle) known += ", " + key;
  for (const auto& [key, ignored] : kOfContact) known += ", " + key;
  for (const auto& [key, ignored] : kOfAxis) known += ", " + key;
  return refuse_bus(fmt::format("parameter \"{}\" is not understood; there are {}", name, known));
}

/// What gives way has two masses that a step can follow, and what has none is not told of what lies between them.
Expected<> check_compliance(const sdk::ModuleChoice& choice, std::size_t axis, const AxisPlantParameters& plant) {
  if (!plant.gives_way()) {
    for (const char* name : {"load_inertia_kg_m2", "play_turns", "encoder_at_load"}) {
      const auto given = choice.numbers.find(name);
      if (given != choice.numbers.end() && given->second[axis] != 0)
        return refuse_bus(fmt::format("parameter \"{}\" of axis {} needs a \"stiffness_nm_rad\" above 0", name, axis));
    }
    return {};
  }
  const double whole = plant.inertia_kg_m2();
  if (!(plant.load_inertia_kg_m2 > 0 && plant.load_inertia_kg_m2 < whole)) {
    return refuse_bus(fmt::format("\"load_inertia_kg_m2\": {} of axis {} must be above 0 and below the axis's {}",
                                  plant.load_inertia_kg_m2, axis, whole));
  }
  constexpr double kMostHz = 3000;
  const double hz = plant.two_masses().resonance_rad_s() / kTurn;
  if (hz <= kMostHz) return {};
  return refuse_bus(
      fmt::format("axis {} would swing at {:.0f} Hz, and at most {} can be simulated; lower "
                  "\"stiffness_nm_rad\", or give 0 for a rigid axis",
                  axis, hz, kMostHz));
}

Expected<> finish_axes(const sdk::ModuleChoice& choice, std::vector<SimulatedAxis>& axes) {
  const auto seed = whole_number(choice, kSeedName, kSeed, 1);
  if (!seed) return tl::unexpected(seed.error());
  for (std::size_t i = 0; i < axes.size(); ++i) {
    auto* axis = std::get_if<AxisPlantParameters>(&axes[i]);
    if (axis == nullptr) continue;
    axis->encoder.seed = (static_cast<std::uint64_t>(*seed) << 32U) + i;
    if (const auto sound = check_compliance(choice, i, *axis); !sound) return sound;
  }
  return {};
}

}  // namespace

Expected<std::vector<SimulatedAxis>> simulated_axes(const sdk::ModuleChoice& choice) {
  if (!choice.texts.empty()) return not_understood(choice.texts.begin()->first);
  std::vector<SimulatedAxis> axes = fieldbus::default_simulated_axes();
  const auto count = whole_number(choice, "axes", kAxisCount, static_cast<int>(axes.size()));
  if (!count) return tl::unexpected(count.error());
  axes.resize(static_cast<std::size_t>(*count), AxisPlantParameters{});
  if (choice.numbers.contains("spindle")) {
    const auto spindle = whole_number(choice, "spindle", kSpindle, -1);
    if (!spindle) return tl::unexpected(spindle.error());
    if (*spindle >= *count)
      return refuse_bus(fmt::format("the spindle is axis {}, and there are {}", *spindle, *count));
    for (SimulatedAxis& axis : axes) {
      if (std::holds_alternative<SpindlePlantParameters>(axis)) axis = AxisPlantParameters{};
    }
    if (*spindle >= 0) axes[static_cast<std::size_t>(*spindle)] = SpindlePlantParameters{};
  }
  for (const auto& [name, numbers] : choice.numbers) {
    if (name == "axes" || name == "spindle" || name == kLateAnswersName || name == kSeedName ||
        name.starts_with("contact_"))
      continue;
    const auto of_axis = kOfAxis.find(name);
    const auto of_spindle = kOfSpindle.find(name);
    Expected<> done;
    if (of_axis != kOfAxis.end()) {
      done = set_axes(name, numbers, of_axis->second, axes);
    } else if (of_spindle != kOfSpindle.end()) {
      done = set_spindle(name, numbers, of_spindle->second, axes);
    } else {
      return not_understood(name);
    }
    if (!done) return tl::unexpected(done.error());
  }
  if (const auto done = finish_axes(choice, axes); !done) return tl::unexpected(done.error());
  return axes;
}

Expected<int> simulated_answer_delay(const sdk::ModuleChoice& choice) {
  return whole_number(choice, kLateAnswersName, kLateAnswers, 0);
}

Expected<std::optional<SimulatedContact>> simulated_contact(const sdk::ModuleChoice& choice) {
  const auto axes = simulated_axes(choice);
  if (!axes) return tl::unexpected(axes.error());
  std::optional<SimulatedContact> contact;
  for (const auto& [name, numbers] : choice.numbers) {
    if (!name.starts_with("contact_")) continue;
    if (!contact) contact.emplace();
    if (name == "contact_axis" || name == "contact_along") {
      const auto axis = whole_number(choice, name.c_str(), {0, static_cast<double>(axes->size() - 1)}, 0);
      if (!axis) return tl::unexpected(axis.error());
      (name == "contact_axis" ? contact->axis : contact->along) = static_cast<std::size_t>(*axis);
      continue;
    }
    const auto known = kOfContact.find(name);
    if (known == kOfContact.end()) return not_understood(name);
    if (numbers.size() != 1 || !inside(numbers[0], known->second.bounds)) {
      return refuse_bus(fmt::format("parameter \"{}\" must be one number from {} to {}", name, known->second.bounds.min,
                                    known->second.bounds.max));
    }
    (*contact).*known->second.member = numbers[0];
  }
  if (!contact) return contact;
  for (const std::size_t axis : {contact->axis, contact->along}) {
    if (axis >= axes->size() || !std::holds_alternative<AxisPlantParameters>((*axes)[axis])) {
      return refuse_bus(fmt::format("contact: axis {} is no servo axis of this bus", axis));
    }
  }
  if (contact->axis == contact->along) return refuse_bus("contact: contact_axis and contact_along must be two axes");
  return contact;
}

}  // namespace rmac::gateway
