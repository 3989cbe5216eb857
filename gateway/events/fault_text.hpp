#pragma once

#include <string>

#include "gateway/mechanism/mechanism.hpp"
#include "gateway/servo/servo_link.hpp"
#include "gateway/state/event.hpp"

namespace rmac::gateway {

/// A fault in words: what happened, where, and what to do. The mechanism names joints and drives; nullptr when it is
/// gone.
[[nodiscard]] std::string describe(const ServoFault& fault, const Mechanism* mechanism);

/// The status that it leaves (Appendix IV).
[[nodiscard]] MinorCode code_of(ServoFault::Kind kind) noexcept;

/// The event that tells of a fault.
[[nodiscard]] Event event_of(const FaultRecord& record, const Mechanism* mechanism);

}  // namespace rmac::gateway
