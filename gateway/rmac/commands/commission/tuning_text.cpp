#include "gateway/rmac/commands/commission/tuning_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <vector>

#include "gateway/rmac/commands/commission/experiment.hpp"
#include "gateway/rmac/terminal/table.hpp"

namespace rmac::cli {

namespace {

/// Where less of creeping is explained, the joint may still stick under what was found. Of a joint without friction
/// nothing but noise may be left to explain.
constexpr double kUnderstood_percent = 98;

/// Of a record: less of it that goes by the place is not worth a word.
constexpr double kMuchByPlace = 0.001;

using Json = nlohmann::json;

void print_filters(const Json& filters) {
  for (const Json& notch : filters["Resonances"]) {
    fmt::print("  notch at {:.1f} Hz, damping {:.3g}, width {:.3g}\n", notch["Frequency"].get<double>(),
               notch["Damping"].get<double>(), notch["Width"].get<double>());
  }
  if (filters["LowPass"] > 0) fmt::print("  low-pass at {:.1f} Hz\n", filters["LowPass"].get<double>());
}

/// What creeping has shown.
void print_creep(const Json& found, const char* way, const char* effort) {
  const Json &creep = found["creep"], &motor = creep["motor"], &parameters = creep["parameters"];
  const auto number = [&](const char* key) { return parameters[key][0].get<double>(); };
  if (creep["friction"] == 0) {
    fmt::print("friction: none\n");
  } else {
    fmt::print(
        "friction slides at {:.3g} {}, builds up over {:.3g} {} and breaks away at {:.2f} times that, which is gone "
        "at {:.2g} {}/s\n",
        creep["friction"].get<double>(), effort, number("presliding"), way, number("breakaway"),
        number("stribeck_speed"), way);
  }
  if (motor.is_null()) fmt::print("cogging is not told: {}\n", creep["no_cogging"].get<std::string>());
  const Json harmonics = motor.is_null() ? Json::array() : motor["cogging"]["Harmonics"];
  for (const Json& one : harmonics) {
    const double size = std::hypot(one["Cosine"].get<double>(), one["Sine"].get<double>());
    fmt::print("cogging of {} periods a turn: {:.3g} N·m, {:.2f} % of the rated torque\n", one["Order"].get<int>(),
               size, 100 * size / motor["rated_torque"].get<double>());
  }
  const Json hidden = motor.is_null() ? Json::array() : motor["hidden"];
  if (!hidden.empty()) {
    std::vector<std::string> orders, places;
    for (const Json& one : hidden) {
      orders.push_back(fmt::format("{}", one["order"].get<int>()));
      places.push_back(fmt::format("{:.3g}", one["hz"].get<double>()));
    }
    fmt::print(
        "cogging of {} periods a turn is not told: it passed at {} Hz, where the joint gives way so that it does not "
        "show how much there is\n",
        fmt::join(orders, ", "), fmt::join(places, ", "));
  }
  if (!motor.is_null() && harmonics.empty() && hidden.empty()) fmt::print("cogging: none\n");
  const double explained = 100 * creep["explained"].get<double>();
  fmt::print("the model explains {:.1f} % of what creeping takes{}\n", explained,
             creep["friction"] > 0 && explained < kUnderstood_percent
                 ? ": friction may be something else here, as behind a soft belt or play; see "
                   "what `rmac measure-following` shows before you keep it"
                 : "");
}

/// Of a joint that several motors move side by side, which are held in step beside the law.
void print_gantry(const Json& several, const char* way) {
  if (several.is_null()) return;
  const Json& gantry = several["Gantry"];
  fmt::print(
      "{} motors move it, up to {:.2g} {} out of step in the swings; what holds them in step as stiffly as this loop "
      "holds the joint, for the Gantry of the joint in device.json beside its MaxSkew (--apply does not set it): "
      "\"Stiffness\": {}, \"Damping\": {}\n",
      several["motors"].get<int>(), several["apart"].get<double>(), way, gantry["Stiffness"].dump(),
      gantry["Damping"].dump());
}

}  // namespace

void print_tuning(const Json& found, const std::string& picture) {
  const Json& plant = found["plant"];
  const auto number = [&plant](const char* key) { return plant[key].get<double>(); };
  const bool turns = found["unit"] == "deg";
  const char* const effort = turns ? "N·m" : "N";
  const char* const way = turns ? "deg" : "mm";
  fmt::print(
      "joint {}: mass {:.4g} {}·s²/{}, friction {:.3g} {} and {:.3g} {}·s/{}, load {:.3g} {}, delay {:.2f} ms; the "
      "model explains {:.2f} % of the record{}\n",
      found["joint"].get<std::string>(), number("mass"), effort, way, number("friction"), effort, number("viscous"),
      effort, way, number("load"), effort, 1e3 * number("delay_s"), 100 * number("explained"),
      number("by_place") >= kMuchByPlace
          ? fmt::format(", what goes by the place, as a motor's cogging and cables do, {:.2f} % more",
                        100 * number("by_place"))
          : "");
  for (const Json& mode : found["resonances"]) {
    fmt::print("resonance at {:.1f} Hz, damping {:.3f}\n", mode["frequency"].get<double>(),
               mode["damping"].get<double>());
  }
  const bool crept = !found["creep"].is_null();
  if (crept) print_creep(found, way, effort);
  std::vector<std::vector<std::string>> rows;
  for (const char* key : {"before", "proposed", "elsewhere"}) {
    const Json& loop = found[key];
    if (loop.is_null()) continue;
    const auto figure = [&loop](const char* name, int digits) {
      return loop["stable"] && !loop[name].is_null() ? fmt::format("{:.{}f}", loop[name].get<double>(), digits) : "-";
    };
    rows.push_back({key == std::string("elsewhere") ? "its worst" : key,
                    loop["stable"] ? list_text(loop["gains"]) : list_text(loop["gains"]) + " unstable",
                    figure("bandwidth_hz", 1), figure("phase_margin_deg", 1), figure("gain_margin_db", 1),
                    figure("sensitivity_peak", 2)});
  }
  fmt::print("{}",
             table({"", "Kp, Ki, Kd", "bandwidth Hz", "phase margin deg", "gain margin dB", "sensitivity peak"}, rows));
  if (!found["resonances"].empty()) fmt::print("its worst: with the resonances up to 15 % elsewhere\n");
  const Json& filters = found["proposed"]["filters"];
  print_filters(filters);
  fmt::print("for DMAC_FEEDFORWARDFEEDBACK_CONTROL: {} with lead_s {:.4f}\n{}\n",
             list_text(found["feedforward_feedback_gains"]), found["lead_s"].get<double>(), picture);
  print_gantry(found["side_by_side"], way);
  if (crept) {
    fmt::print(
        "to keep it, write into the joint in device.json: \"ServoControlLaw\": {}, \"Gains\": {}, "
        "\"Resonances\": {}, \"LowPass\": {}\n",
        Json{{"Module", "DMAC_FEEDFORWARDFEEDBACK_CONTROL"}, {"Parameters", found["creep"]["parameters"]}}.dump(),
        list_text(found["feedforward_feedback_gains"]), filters["Resonances"].dump(), filters["LowPass"].dump());
    const Json& motor = found["creep"]["motor"];
    if (!motor.is_null()) fmt::print("and into its actuator: \"Cogging\": {}\n", motor["cogging"].dump());
    return;
  }
  if (found["apply"].is_null() || loses_filters(found)) return;
  fmt::print("to keep it, write into the joint in device.json: \"Gains\": {}, \"Resonances\": {}, \"LowPass\": {}\n",
             list_text(found["apply"]), filters["Resonances"].dump(), filters["LowPass"].dump());
}

bool loses_filters(const Json& found) {
  const Json& now = found["filters_in_force"];
  const bool filtered = now.is_object() && (!now["Resonances"].empty() || now["LowPass"] > 0);
  return found["misfit"].is_null() && filtered;
}

}  // namespace rmac::cli
