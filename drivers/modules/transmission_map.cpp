#include "rmac/modules/transmission_map.hpp"

#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>

#include "rmac/modules/linkage_transmissions.hpp"
#include "rmac/modules/proportional_transmissions.hpp"

namespace rmac::modules {
namespace {

using Numbers = std::span<const double>;
using Made = std::unique_ptr<ActuatorMap>;

/// One kind of transmission: how many numbers it takes, what they are, how many of them, from the front, are above 0,
/// and what makes it. Null where the numbers do not go together.
struct Kind {
  std::string_view name;
  std::size_t numbers;
  std::size_t positive;
  const char* meaning;
  Made (*make)(Numbers numbers);
  const char* wrong;  ///< what to say when `make` gives null
};

template <typename Transmission>
Made made(Transmission transmission) {
  return std::make_unique<Transmission>(std::move(transmission));
}

Made make_piston(Numbers n) {
  const LeverPiston::Parameters parameters{n[0], n[1], n[4], n[2], n[3], n[5], n[6]};
  return LeverPiston::turns_everywhere(parameters) ? made(LeverPiston(parameters)) : nullptr;
}

Made make_four_bar(Numbers n) {
  if (std::abs(n[6]) != 1) return nullptr;
  const FourBarLinkage linkage({n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8]});
  return linkage.turns_everywhere() ? made(linkage) : nullptr;
}

constexpr Kind kKinds[] = {
    {"screw", 2, 2, "lead_mm, gear", [](Numbers n) { return made(Proportional::screw(n[0], n[1])); }, ""},
    {"gear", 1, 1, "gear", [](Numbers n) { return made(Proportional::gear(n[0])); }, ""},
    {"gantry", 2, 2, "lead_mm, gear", [](Numbers n) { return made(GantryPair(n[0], n[1])); }, ""},
    {"differential", 2, 2, "gear, gear", [](Numbers n) { return made(DifferentialPair::rotary(n[0], n[1])); }, ""},
    {"belt-differential", 2, 2, "lead_mm, lead_mm",
     [](Numbers n) { return made(DifferentialPair::linear(n[0], n[1])); }, ""},
    {"piston", 7, 4, "base_mm, lever_mm, lead_mm, gear, angle_at_zero_deg, min_deg, max_deg", make_piston,
     "the lever's angle must stay between 5 and 175 degrees from min_deg to max_deg"},
    {"four-bar", 9, 5,
     "crank_mm, coupler_mm, rocker_mm, ground_mm, gear, rocker_at_zero_deg, branch (1 or -1), min_deg, max_deg",
     make_four_bar,
     "the linkage must close, 10 degrees off its dead centres, at 0 and from min_deg to max_deg; try the other branch"},
};

const char* find_text(sdk::Parameters parameters, std::string_view name) {
  for (const sdk::Parameter& parameter : parameters) {
    if (parameter.name == name) return parameter.text;
  }
  return nullptr;
}

bool fit(const Kind& kind, Numbers numbers) {
  if (numbers.size() != kind.numbers) return false;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!std::isfinite(numbers[i]) || (i < kind.positive && numbers[i] <= 0)) return false;
  }
  return true;
}

/// Null with the reason in `why`.
Made make_transmission(std::string_view name, const std::string& key, Numbers numbers, std::string& why) {
  std::string known;
  for (const Kind& kind : kKinds) {
    known += (known.empty() ? "" : ", ") + std::string(kind.name);
    if (name != kind.name) continue;
    if (!fit(kind, numbers)) {
      why = "parameter " + key + " must be the " + std::to_string(kind.numbers) + " numbers of a " + std::string(name) +
            ": " + kind.meaning + "; the first " + std::to_string(kind.positive) + " above 0";
      return nullptr;
    }
    Made result = kind.make(numbers);
    if (!result) why = "parameter " + key + ": " + kind.wrong;
    return result;
  }
  why = "there is no transmission \"" + std::string(name) + "\"; there are " + known;
  return nullptr;
}

/// The first parameter that none of the transmissions reads, or nothing.
std::string stray_parameter(sdk::Parameters parameters, std::size_t count) {
  for (const sdk::Parameter& parameter : parameters) {
    const std::string_view name = parameter.name;
    bool known = name == "transmissions";
    for (std::size_t i = 1; i <= count; ++i) known = known || name == "t" + std::to_string(i);
    if (!known) return std::string(name);
  }
  return "";
}

}  // namespace

ActuatorMap* TransmissionMapFactory::create(sdk::Parameters parameters, char* error, std::size_t error_size) noexcept {
  const auto refuse = [&](const std::string& why) {
    std::snprintf(error, error_size, "%s", why.c_str());
    return nullptr;
  };
  const char* const text = find_text(parameters, "transmissions");
  std::string_view names = text != nullptr ? text : "";
  std::vector<Made> transmissions;
  while (true) {
    names.remove_prefix(std::min(names.find_first_not_of(' '), names.size()));
    if (names.empty()) break;
    const std::string_view name = names.substr(0, names.find(' '));
    names.remove_prefix(name.size());
    const std::string key = "t" + std::to_string(transmissions.size() + 1);
    std::string why;
    Made next = make_transmission(name, key, sdk::find_numbers(parameters, key.c_str()), why);
    if (!next) return refuse(why);
    transmissions.push_back(std::move(next));
  }
  if (transmissions.empty()) {
    return refuse("parameter transmissions must name the transmission of each joint, parted by blanks");
  }
  if (const std::string stray = stray_parameter(parameters, transmissions.size()); !stray.empty()) {
    return refuse("parameter " + stray + " is not understood; there are transmissions and t1 to t" +
                  std::to_string(transmissions.size()) + ", numbers of each");
  }
  return new TransmissionMap(std::move(transmissions));
}

}  // namespace rmac::modules

RMAC_MODULE(ActuatorMap, "TransmissionMap", rmac::ActuatorMap, rmac::modules::TransmissionMapFactory)
