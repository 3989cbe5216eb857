#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace rmac::gateway {

inline constexpr const char* kBase = "base";
inline constexpr const char* kTable = "table";
inline constexpr const char* kSpindle = "spindle";

/// A chain of n joints has n + 1 rigid links: the table is number 0, and each joint leads to the next, the last one to
/// the spindle. A joint's name stands for the link that it moves against the base: on the table's side of the base the
/// one before the joint, on the other side the one behind it.
///
/// `chain`: names of the joints from the table to the spindle, with `base` among them. None for a name of no link.
[[nodiscard]] std::optional<std::size_t> link_number(std::span<const std::string> chain, const std::string& name);

}  // namespace rmac::gateway
