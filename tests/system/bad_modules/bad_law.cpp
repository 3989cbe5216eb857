#include <algorithm>
#include <array>
#include <cmath>

#include "rmac/motion/ports/servo_law.hpp"
#include "rmac/sdk/module.hpp"

namespace {

using namespace rmac;

enum class Defect { HidesNoNumber, PushesAway };
constexpr Defect kDefect = Defect::DEFECT;

/// Effort by the position error, the velocity error, and a gain that is not used; an offset for engaging.
class BadLaw final : public ServoLaw {
 public:
  std::span<const GainInfo> gains() const noexcept override { return kGains; }
  bool set_gains(std::span<const double> values) noexcept override {
    if (values.size() != kGains.size()) return false;
    if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); })) return false;
    const double before = effort(last_);
    std::copy(values.begin(), values.end(), values_.begin());
    offset_ += before - effort(last_);
    return true;
  }
  void set_effort_limit(double limit) noexcept override { limit_ = limit; }
  void engage(const ServoInput& input, double wanted) noexcept override {
    last_ = input;
    offset_ = 0;
    offset_ = std::clamp(wanted, -limit_, limit_) - effort(input);
  }
  double update(const ServoInput& input) noexcept override {
    if (!is_finite(input)) return kDefect == Defect::HidesNoNumber ? 0 : std::nan("");
    last_ = input;
    return std::clamp(effort(input), -limit_, limit_);
  }

 private:
  static constexpr std::array<GainInfo, 3> kGains{{{"P", "N/mm"}, {"I", "N/(mm·s)"}, {"D", "N·s/mm"}}};
  static constexpr double kSense = kDefect == Defect::PushesAway ? -1 : 1;

  double effort(const ServoInput& in) const noexcept {
    return offset_ + kSense * (values_[0] * (in.position_setpoint - in.position) +
                               values_[2] * (in.velocity_setpoint - in.velocity));
  }

  std::array<double, 3> values_{};
  ServoInput last_{};
  double offset_ = 0;
  double limit_ = 0;
};

struct Factory {
  static ServoLaw* create(sdk::Parameters, char*, std::size_t) { return new BadLaw; }
};

}  // namespace

RMAC_MODULE(ServoLaw, "BadLaw", ServoLaw, Factory)
