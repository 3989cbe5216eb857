#include "gateway/rmac/commands/operate/motion.hpp"

#include "gateway/rmac/wire/authority.hpp"
#include "gateway/rmac/wire/fault_watch.hpp"
#include "gateway/rmac/wire/requests.hpp"
#include "gateway/rmac/wire/rest.hpp"

namespace rmac::cli {

Result<> move_and_wait(Connection& connection, const std::string& method, const nlohmann::json& params) {
  FaultWatch faults(connection, FaultWatch::HearsOf::Faults);
  return with_authority(connection, [&]() -> Result<> {
    if (auto heard = faults.begin(); !heard) return heard;
    if (auto begun = connection.command(method, params); !begun) return begun;
    const auto rest = wait_for_rest(connection, faults.failure());
    if (!rest) {
      static_cast<void>(stop_now(connection));
      return tl::unexpected(rest.error());
    }
    return rest->faulted() ? fail("the machine is in a fault; `rmac status` says which") : Result<>();
  });
}

}  // namespace rmac::cli
