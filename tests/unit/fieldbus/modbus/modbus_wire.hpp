#pragma once

#include <gtest/gtest.h>

#include "unit/fieldbus/modbus/register_bank.hpp"
#include "unit/fieldbus/modbus/still_clock.hpp"

namespace rmac::fieldbus::modbus {

/// A client that is connected to an honest slave, in the test's own thread; their time stands still.
struct ModbusWire {
  explicit ModbusWire(ModbusPeer::Wire wire) : peer(wire) {
    peer.respond([this](const Bytes& request) { return bank.answer(request); });
    client = std::move(*Client::create(peer.endpoint(), std::chrono::seconds(60), clock.now()));
    EXPECT_TRUE(client->connect());
  }

  /// What was written since it was asked last, one value each: address and value.
  std::vector<std::pair<int, int>> written() {
    std::vector<std::pair<int, int>> found;
    reads = 0;
    for (const Bytes& request : peer.take_requests()) {
      if (request[1] <= 4) ++reads;
      if (request[1] == 6) found.emplace_back(request[2] << 8U | request[3], request[4] << 8U | request[5]);
    }
    return found;
  }

  RegisterBank bank;  // outlives the peer, which answers from it
  StillClock clock;
  ModbusPeer peer;
  std::unique_ptr<Client> client;
  int reads = 0;  ///< beside what `written` told last
};

}  // namespace rmac::fieldbus::modbus
