#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rmac/fieldbus/bus_report.hpp"

namespace rmac::gateway {

/// What became of one thing on a bus between two reports.
struct BusChange {
  std::string about;        ///< what it befell, and of which kind it is: "can0 node 3 EMCY"
  std::string message;      ///< for a person
  std::uint64_t times = 1;  ///< how often; the message tells of the latest

  friend bool operator==(const BusChange&, const BusChange&) = default;
};

/// What changed from one report to the next. A bus, a node or a unit that was not there before, and a bus that was
/// brought up anew in between, has nothing to be compared with: it changes nothing.
[[nodiscard]] std::vector<BusChange> changes_between(const fieldbus::FieldbusReport& before,
                                                     const fieldbus::FieldbusReport& now);

}  // namespace rmac::gateway
