#pragma once

#include <modbus/modbus.h>

#include <chrono>
#include <memory>

#include "rmac/fieldbus/modbus/client.hpp"

namespace rmac::fieldbus::modbus {

struct FreeContext {
  void operator()(modbus_t* context) const noexcept { modbus_free(context); }
};
using Context = std::unique_ptr<modbus_t, FreeContext>;

/// Empty where the endpoint can be tried, else what is wrong in it.
[[nodiscard]] std::string check(const Endpoint& endpoint);

/// A context for the endpoint, not connected.
[[nodiscard]] Context make_context(const Endpoint& endpoint);

/// Connects `context` within `deadline`: 0, or the errno of what failed.
[[nodiscard]] int open_line(modbus_t* context, const Endpoint& endpoint, std::chrono::milliseconds deadline) noexcept;

/// Closes what `open_line` opened. Never waits for a serial line to send what is left.
void close_line(modbus_t* context, const Endpoint& endpoint) noexcept;

}  // namespace rmac::fieldbus::modbus
