#include "gateway/rmac/commands/watch/interruption.hpp"

namespace rmac::cli {

Result<> wait_until_interrupted(Connection& connection) {
  auto waited = connection.wait([] { return false; });
  return connection.interrupted() ? Result<>() : waited;
}

}  // namespace rmac::cli
