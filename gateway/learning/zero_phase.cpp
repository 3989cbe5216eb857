#include "gateway/learning/zero_phase.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace rmac::gateway {
namespace {

/// The low-pass as a difference equation, by the bilinear transformation.
class LowPass {
 public:
  LowPass(double corner_hz, double period_s) {
    const double k = std::tan(std::numbers::pi * corner_hz * period_s);
    const double scale = 1 / (1 + std::numbers::sqrt2 * k + k * k);
    gain_ = k * k * scale;
    a1_ = 2 * (k * k - 1) * scale;
    a2_ = (1 - std::numbers::sqrt2 * k + k * k) * scale;
  }
  double step(double in) noexcept {
    const double out = gain_ * (in + 2 * in1_ + in2_) - a1_ * out1_ - a2_ * out2_;
    in2_ = in1_, in1_ = in;
    out2_ = out1_, out1_ = out;
    return out;
  }

 private:
  double gain_, a1_, a2_;
  double in1_ = 0, in2_ = 0, out1_ = 0, out2_ = 0;
};

}  // namespace

void filter_zero_phase(std::span<double> values, double corner_hz, double period_s) {
  LowPass forwards(corner_hz, period_s), backwards(corner_hz, period_s);
  for (double& value : values) value = forwards.step(value);
  // What the way forwards leaves behind the end comes first on the way back; after two periods it is gone.
  std::vector<double> behind(static_cast<std::size_t>(std::ceil(2 / (corner_hz * period_s))));
  for (double& value : behind) value = forwards.step(0);
  for (auto value = behind.rbegin(); value != behind.rend(); ++value) static_cast<void>(backwards.step(*value));
  for (auto value = values.rbegin(); value != values.rend(); ++value) *value = backwards.step(*value);
}

}  // namespace rmac::gateway
