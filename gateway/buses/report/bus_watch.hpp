#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gateway/buses/report/bus_changes.hpp"

namespace rmac::gateway {

/// Looks at the buses every half second, and tells what changed. Time is the caller's. One thread at a time, never the
/// servo thread.
class BusWatch {
 public:
  static constexpr double kBetweenLooks_s = 0.5;
  /// Of one thing that befalls one node, a message at most so often; the next one counts those that were kept back.
  static constexpr double kBetweenMessages_s = 5;

  /// Whether it is time for another look.
  [[nodiscard]] bool due(double now_s) const noexcept { return !last_ || now_s >= looked_s_ + kBetweenLooks_s; }
  /// What there is to tell, in words. The first report, and the first after `forget`, is what others are compared with.
  [[nodiscard]] std::vector<std::string> look(fieldbus::FieldbusReport report, double now_s);
  /// Another machine hangs on the buses.
  void forget();
  /// Of the latest look: `buses` of the topic `state` (docs/protocol.md).
  [[nodiscard]] const nlohmann::json& summary() const noexcept { return summary_; }

 private:
  struct Told {
    double at_s = 0;
    std::uint64_t kept_back = 0;
    std::string latest;  ///< of those
  };
  void consider(const BusChange& change, double now_s, std::vector<std::string>& out);

  std::optional<fieldbus::FieldbusReport> last_;
  double looked_s_ = 0;
  std::map<std::string, Told> told_;  ///< by what it is about
  nlohmann::json summary_ = nlohmann::json::array();
};

}  // namespace rmac::gateway
