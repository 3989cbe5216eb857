#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/failure.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::cli {

/// How a probe gets about, in the part frame.
struct ProbeWays {
  double safe_height_mm = 0;  ///< at which it may go from any point to any other
  double clearance_mm = 5;    ///< off the surface, along the normal, where it begins to measure
  double speed_mm_s = 20;
};

/// Touches one point after the other, each move done before the next is asked for. Needs motion authority.
class Prober {
 public:
  Prober(Connection& connection, const ProbeWays& ways);
  ~Prober();
  Prober(const Prober&) = delete;
  Prober& operator=(const Prober&) = delete;

  /// Before the first point: the cycle runs, and the machine stands.
  [[nodiscard]] Result<> begin();
  /// Goes over the point at the safe height, down beside it, and towards it against `normal`, which is unit; where the
  /// tip's centre was at the hit. `tip`: where it is to be then.
  [[nodiscard]] Result<Vector> touch(const Vector& tip, const Vector& normal);
  /// Up to the safe height.
  [[nodiscard]] Result<> leave();

 private:
  [[nodiscard]] Result<> move(const char* method, const Vector& to);
  void take(const std::string& topic, const nlohmann::json& note);

  Connection& connection_;
  ProbeWays ways_;
  Vector at_{};
  std::int64_t move_id_ = 0;
  bool done_ = false;
  std::string failure_;
  std::optional<Vector> hit_;
};

}  // namespace rmac::cli
