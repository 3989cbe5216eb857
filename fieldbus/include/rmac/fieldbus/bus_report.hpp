#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rmac/fieldbus/can/can_port.hpp"
#include "rmac/fieldbus/eds/object_entry.hpp"
#include "rmac/fieldbus/modbus/line_report.hpp"

namespace rmac::fieldbus {

/// What a node of a bus went through since the bus was started, and how it is now.
struct NodeReport {
  struct Emergency {
    std::uint16_t code = 0;
    std::string text;
    std::uint8_t error_register = 0;  ///< 1001h
    double age_s = 0;
  };
  struct Abort {
    ObjectAddress object;
    std::uint32_t code = 0;
    std::string text;
  };

  std::uint8_t node = 0;
  std::vector<std::size_t> axes;  ///< of the bus, by their places
  std::string state;
  std::optional<std::string> problem;  ///< why it is away
  std::uint64_t lost = 0;              ///< how often it went away
  std::uint64_t recovered = 0;         ///< and was brought up again
  std::uint64_t missed_answers = 0;    ///< SYNCs that one of its axes left unanswered
  std::uint64_t answers = 0;           ///< pairs of answers, one cycle apart, whose distance was measured
  double jitter_mean_s = 0;            ///< how far that distance was from the cycle
  double jitter_most_s = 0;
  std::uint64_t emergency_count = 0;   ///< EMCY messages, those that tell of no error among them
  std::vector<Emergency> emergencies;  ///< the latest of them, newest first
  std::uint64_t abort_count = 0;       ///< SDO transfers that the node refused, whoever asked
  std::vector<Abort> aborts;           ///< the latest of them, newest first
};

/// What a CAN bus went through since it was started, and how it is now.
struct BusReport {
  std::string interface;
  std::uint64_t cycles = 0;
  std::uint64_t unsent = 0;         ///< frames of a cycle that the port did not take
  std::uint64_t short_answers = 0;  ///< PDOs shorter than what is mapped
  CanHealth health;
  CanController controller;  ///< now
  std::vector<NodeReport> nodes;
};

/// What all buses that run went through, of those that watch what hangs on them.
struct FieldbusReport {
  std::vector<BusReport> can;
  std::vector<modbus::LineReport> modbus;
};

/// What a control interface implements beside its port when it watches the nodes of a bus.
class BusReports {
 public:
  virtual ~BusReports() = default;
  /// Any thread but the servo thread; never while it is started or stopped.
  [[nodiscard]] virtual BusReport report() const = 0;
};

}  // namespace rmac::fieldbus
