#pragma once

#include "rmac/motion/servo_loop.hpp"

namespace rmac {

/// Makes hits of a touch probe's contact, which bounces. Real-time safe.
class ProbeSignal {
 public:
  /// `inputs` as `io` gave them in this cycle; `io` may be null. False when the inputs could not be read.
  void read(const ServoProbe& probe, const DigitalIoInterface* io, std::uint64_t inputs, double period_s) noexcept;
  [[nodiscard]] const ProbeReport& report() const noexcept { return report_; }

 private:
  ProbeReport report_;
  double open_s_ = 0;  ///< the contact of a probe that touches has been open for so long
};

}  // namespace rmac
