#pragma once

#include "rmac/motion/servo/servo_inputs.hpp"

namespace rmac {

/// Makes hits of a touch probe's contact, which bounces. Real-time safe.
class ProbeSignal {
 public:
  /// `inputs` as they were read in this cycle. `on_for_s`: how long ago the contact closed, where its input has time
  /// stamps. `latched`: a drive has latched its position at an edge of the contact, which may be over by now.
  void read(const ServoProbe& probe, std::uint64_t inputs, double on_for_s, bool latched, double period_s) noexcept;
  [[nodiscard]] const ProbeReport& report() const noexcept { return report_; }

 private:
  ProbeReport report_;
  double open_s_ = 0;  ///< the contact of a probe that touches has been open for so long
};

}  // namespace rmac
