#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace rmac::fieldbus::modbus {

/// What passed between a client and one unit since the line was started.
struct UnitTraffic {
  struct Trouble {
    std::string message;
    double age_s = 0;
  };

  std::uint64_t requests = 0;
  std::uint64_t answers = 0;  ///< that fit their question; refusals are not among them
  std::uint64_t timeouts = 0;
  std::uint64_t wrong_answers = 0;          ///< another unit's, or spoilt
  std::uint64_t disconnects = 0;            ///< the connection or the port failed in mid-question
  std::map<int, std::uint64_t> exceptions;  ///< by code (V1.1b3, 7)
  std::optional<Trouble> last_trouble;
};

struct UnitReport {
  int unit = 0;
  std::string state;  ///< "answers", "does not answer", "is not understood", "is busy", "refuses"; of its latest round
  UnitTraffic traffic;
};

/// What a Modbus line went through since it was started, and how it is now.
struct LineReport {
  std::string endpoint;
  std::uint64_t rounds = 0;
  std::uint64_t connections = 0;  ///< times the line was opened
  std::vector<UnitReport> units;
};

/// What an interface implements beside its port when it owns a Modbus line.
class LineReports {
 public:
  virtual ~LineReports() = default;
  /// Any thread but the servo thread; never while it is started or stopped.
  [[nodiscard]] virtual LineReport line_report() const = 0;
};

}  // namespace rmac::fieldbus::modbus
