#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace rmac::gateway {

/// A set of named integers of the wire. A client may send either the integer or the name.
struct Enumeration {
  struct Value {
    const char* name;
    std::int64_t number;
  };
  const char* name;
  std::span<const Value> values;

  [[nodiscard]] const Value* find(std::int64_t number) const noexcept;
  [[nodiscard]] const Value* find(const std::string& value_name) const noexcept;
  /// "MANUAL (0), AUTOMATIC (1)", for messages and pages.
  [[nodiscard]] std::string list() const;
};

extern const Enumeration kJointTypeValues;
extern const Enumeration kJointLimitTypeValues;
extern const Enumeration kControlMethodValues;
extern const Enumeration kCycleModeValues;
extern const Enumeration kControlModeValues;
extern const Enumeration kParameterNumberValues;
extern const Enumeration kMajorCodeValues;
extern const Enumeration kMinorCodeValues;
extern const Enumeration kRotationSignValues;
extern const Enumeration kRotaryDirectionValues;

/// All of the above, for the pages and for the test against the specification.
[[nodiscard]] std::span<const Enumeration* const> enumerations();

}  // namespace rmac::gateway
