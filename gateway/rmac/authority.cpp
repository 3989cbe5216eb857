#include "gateway/rmac/authority.hpp"

namespace rmac::cli {

Result<> with_authority(Connection& connection, const std::function<Result<>()>& work) {
  if (auto lease = connection.call("authority.acquire"); !lease) {
    return tl::unexpected(lease.error());
  }
  auto done = work();
  auto released = connection.call("authority.release");
  if (done && !released) {
    return tl::unexpected(released.error());
  }
  return done;
}

}  // namespace rmac::cli
