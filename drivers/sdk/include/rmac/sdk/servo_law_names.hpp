#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace rmac::sdk {

/// Appendix IV's constants for servo laws, and the module behind each.
inline constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kServoLawNames{{
    {"DMAC_PID_CONTROL", "PIDServoControlLaw"},
    {"DMAC_FEEDFORWARD_CONTROL", "FeedforwardServoControlLaw"},
    {"DMAC_FEEDFORWARDFEEDBACK_CONTROL", "FeedforwardFeedbackServoControlLaw"},
    {"DMAC_FUZZY_CONTROL", "FuzzyServoControlLaw"},
}};

/// The module behind a servo law as a client names it: one of Appendix IV's constants, or a module's own name.
[[nodiscard]] inline std::string servo_law_module(std::string_view name) {
  for (const auto& [constant, module] : kServoLawNames) {
    if (name == constant) return std::string(module);
  }
  return std::string(name);
}

}  // namespace rmac::sdk
