#pragma once

#include <string>
#include <string_view>

#include "rmac/motion/error.hpp"

namespace rmac::sdk {

/// The module behind a servo law as a client names it: one of Appendix IV's constants, or a module's own name. An error
/// for a constant whose law does not exist yet.
[[nodiscard]] inline Expected<std::string> servo_law_module(std::string_view name) {
  if (name == "DMAC_PID_CONTROL") return "PIDServoControlLaw";
  for (const std::string_view later :
       {"DMAC_FEEDFORWARD_CONTROL", "DMAC_FEEDFORWARDFEEDBACK_CONTROL", "DMAC_FUZZY_CONTROL"}) {
    if (name == later) {
      return failure(MinorCode::UnsupportedOperation,
                     std::string(name) +
                         ": this servo law is not there yet; use DMAC_PID_CONTROL or the name of a "
                         "servo-law module");
    }
  }
  return std::string(name);
}

}  // namespace rmac::sdk
