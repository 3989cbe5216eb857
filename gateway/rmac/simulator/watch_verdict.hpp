#pragma once

#include "gateway/cutting/cutting_load.hpp"
#include "gateway/rmac/simulator/collision_watch.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// A failure where something met, or was not checked.
[[nodiscard]] Result<> collision_verdict(const CollisionWatch& watch);
/// A failure where cutting takes more than the spindle has, or something that was asked for is not told.
[[nodiscard]] Result<> force_verdict(const CollisionWatch& watch);
/// Of both: one line of all that is wrong.
[[nodiscard]] Result<> both(const Result<>& first, const Result<>& second);
/// Of collisions and forces.
[[nodiscard]] Result<> verdict(const CollisionWatch& watch);

[[nodiscard]] const char* name_of(gateway::Overload::Of of) noexcept;
[[nodiscard]] const char* unit_of(gateway::Overload::Of of) noexcept;

}  // namespace rmac::cli
