#include "gateway/buses/simulated_io.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "rmac/motion/frame.hpp"

namespace rmac::gateway {
namespace {

using fieldbus::SimulatedPart;
using fieldbus::SimulatedProbe;

constexpr double kFarthest_mm = 1e5;

struct Wiring {
  SimulatedProbe probe;
  SimulatedPart part;
};

Frame place_of(const std::vector<double>& v) {
  const auto turn = [](std::size_t axis, double degrees) {
    Frame turned;
    const double half = degrees * std::numbers::pi / 360;
    turned.q = {std::cos(half), 0, 0, 0};
    turned.q[axis + 1] = std::sin(half);
    return turned;
  };
  Frame place = compose(turn(2, v[5]), compose(turn(1, v[4]), turn(0, v[3])));
  place.p = {v[0], v[1], v[2]};
  return place;
}

/// How many numbers a parameter takes, and their bounds; `repeats`: that many again for each further body.
struct Takes {
  std::size_t count;
  bool repeats;
  double min, max;
  const char* what;
  void (*set)(Wiring& wiring, const std::vector<double>& v);
};

const std::map<std::string, Takes> kParameters{
    {"probe_input",
     {1, false, 0, 63, "the bit of the probe",
      [](Wiring& w, const std::vector<double>& v) { w.probe.touch_input = static_cast<int>(v[0]); }}},
    {"probe_ready",
     {1, false, 0, 63, "a bit",
      [](Wiring& w, const std::vector<double>& v) { w.probe.ready_input = static_cast<int>(v[0]); }}},
    {"probe_stylus_mm",
     {3, false, -kFarthest_mm, kFarthest_mm, "x, y, z",
      [](Wiring& w, const std::vector<double>& v) {
        w.probe.stylus = {v[0], v[1], v[2]};
      }}},
    {"probe_radius_mm",
     {1, false, 0, 100, "a radius", [](Wiring& w, const std::vector<double>& v) { w.probe.radius = v[0]; }}},
    {"probe_bounce_ms",
     {1, false, 0, 1000, "a time", [](Wiring& w, const std::vector<double>& v) { w.probe.bounce_s = v[0] / 1000; }}},
    {"probe_switch_rpm",
     {1, false, 0, 1e5, "a speed", [](Wiring& w, const std::vector<double>& v) { w.probe.switch_rpm = v[0]; }}},
    {"part_place",
     {6, false, -kFarthest_mm, kFarthest_mm, "x, y, z in mm and turns about x, y, z in degrees",
      [](Wiring& w, const std::vector<double>& v) { w.part.place = place_of(v); }}},
    {"part_block_mm",
     {6, true, -kFarthest_mm, kFarthest_mm, "two corners, x, y, z each, for every block",
      [](Wiring& w, const std::vector<double>& v) {
        for (std::size_t i = 0; i < v.size(); i += 6) {
          w.part.blocks.push_back({{v[i], v[i + 1], v[i + 2]}, {v[i + 3], v[i + 4], v[i + 5]}});
        }
      }}},
    {"part_bore_mm",
     {5, true, -kFarthest_mm, kFarthest_mm, "x, y, radius, bottom, top for every bore",
      [](Wiring& w, const std::vector<double>& v) {
        for (std::size_t i = 0; i < v.size(); i += 5) {
          w.part.bores.push_back({v[i], v[i + 1], v[i + 2], v[i + 3], v[i + 4]});
        }
      }}},
    {"sphere_mm",
     {4, true, -kFarthest_mm, kFarthest_mm, "x, y, z, radius for every sphere",
      [](Wiring& w, const std::vector<double>& v) {
        for (std::size_t i = 0; i < v.size(); i += 4) {
          w.part.spheres.push_back({{v[i], v[i + 1], v[i + 2]}, v[i + 3]});
        }
      }}},
};

tl::unexpected<Error> refuse_io(std::string message) {
  return failure(MinorCode::InvalidParameterValue, "SimulatedIOInterface: " + std::move(message));
}

Expected<> take_wiring(const std::string& name, const std::vector<double>& numbers, Wiring& wiring) {
  const auto known = kParameters.find(name);
  if (known == kParameters.end()) {
    std::string names;
    for (const auto& [key, takes] : kParameters) names += (names.empty() ? "" : ", ") + key;
    return refuse_io(fmt::format("parameter \"{}\" is not understood; there are {}", name, names));
  }
  const Takes& takes = known->second;
  const bool fits =
      takes.repeats ? !numbers.empty() && numbers.size() % takes.count == 0 : numbers.size() == takes.count;
  bool inside = true;
  for (const double number : numbers) inside = inside && number >= takes.min && number <= takes.max;
  const bool whole = takes.max != 63 || (fits && numbers[0] == std::floor(numbers[0]));
  if (!fits || !inside || !whole) {
    return refuse_io(fmt::format("parameter \"{}\" takes {} number{}{} from {} to {}: {}", name, takes.count,
                                 takes.count == 1 ? "" : "s", takes.repeats ? ", or a multiple," : "", takes.min,
                                 takes.max, takes.what));
  }
  takes.set(wiring, numbers);
  return {};
}

}  // namespace

Expected<std::shared_ptr<fieldbus::SimulatedIoInterface>> make_simulated_io(const sdk::ModuleChoice& choice) {
  if (!choice.texts.empty()) {
    return refuse_io(fmt::format("parameter \"{}\" takes numbers", choice.texts.begin()->first));
  }
  Wiring wiring;
  for (const auto& [name, numbers] : choice.numbers) {
    if (auto taken = take_wiring(name, numbers, wiring); !taken) return tl::unexpected(taken.error());
  }
  for (const SimulatedPart::Block& block : wiring.part.blocks) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(block.low[i] < block.high[i])) {
        return refuse_io(
            "parameter \"part_block_mm\": the first corner of a block must be below the second in x, y and z");
      }
    }
  }
  if (wiring.probe.touch_input >= 0) {
    return std::make_shared<fieldbus::SimulatedIoInterface>(wiring.probe, std::move(wiring.part));
  }
  if (!choice.numbers.empty()) return refuse_io("a part or a probe is described, and \"probe_input\" is missing");
  return std::make_shared<fieldbus::SimulatedIoInterface>();
}

Expected<std::shared_ptr<DigitalIoInterface>> with_touch_probe(std::shared_ptr<DigitalIoInterface> io,
                                                               const ServoLoopParts& parts) {
  auto simulated = std::dynamic_pointer_cast<fieldbus::SimulatedIoInterface>(io);
  if (!simulated || !simulated->probe()) return io;
  const auto simulated_bus_of = [](const ServoBus& bus) {
    return std::dynamic_pointer_cast<fieldbus::SimulatedInterface>(bus.interface);
  };
  std::vector<TouchProbeModel::Shaft> shafts;
  for (const ServoActuator& actuator : parts.actuators) {
    auto bus = simulated_bus_of(*actuator.bus);
    if (!bus || bus->is_spindle(actuator.axis)) {
      return refuse_io("its probe can touch only where all drives are simulated; leave \"probe_input\" out");
    }
    shafts.push_back({std::move(bus), actuator.axis, actuator.scale});
  }
  std::optional<TouchProbeModel::Spindle> spindle;
  if (!parts.spindles.empty()) {
    auto bus = simulated_bus_of(*parts.spindles[0].bus);
    if (bus && bus->is_spindle(parts.spindles[0].axis)) spindle = {std::move(bus), parts.spindles[0].axis};
  }
  return std::make_shared<TouchProbeModel>(std::move(simulated), parts, std::move(shafts), std::move(spindle));
}

}  // namespace rmac::gateway
