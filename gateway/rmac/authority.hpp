#pragma once

#include <functional>

#include "gateway/rmac/connection.hpp"
#include "gateway/rmac/failure.hpp"

namespace rmac::cli {

/// Takes the motion lease, does `work`, gives the lease back. Giving it back stops motion: `work` ends at rest.
[[nodiscard]] Result<> with_authority(Connection& connection, const std::function<Result<>()>& work);

}  // namespace rmac::cli
