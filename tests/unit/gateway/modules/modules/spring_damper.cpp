#include <algorithm>
#include <array>

#include "rmac/motion/ports/servo_law.hpp"
#include "rmac/sdk/module.hpp"

namespace {

/// Effort proportional to the position and velocity errors.
class SpringDamper final : public rmac::ServoLaw {
 public:
  std::span<const rmac::GainInfo> gains() const noexcept override { return kGains; }
  bool set_gains(std::span<const double> values) noexcept override {
    if (values.size() != kGains.size() || !(values[0] > 0) || !(values[1] >= 0)) return false;
    stiffness_n_mm_ = values[0];
    damping_n_s_mm_ = values[1];
    return true;
  }
  void set_effort_limit(double effort) noexcept override { limit_ = effort; }
  void engage(const rmac::ServoInput&, double) noexcept override {}
  double update(const rmac::ServoInput& in) noexcept override {
    const double effort =
        stiffness_n_mm_ * (in.position_setpoint - in.position) + damping_n_s_mm_ * (in.velocity_setpoint - in.velocity);
    return std::clamp(effort, -limit_, limit_);
  }

 private:
  static constexpr std::array<rmac::GainInfo, 2> kGains{{{"stiffness", "N/mm"}, {"damping", "N·s/mm"}}};
  double stiffness_n_mm_ = 0;
  double damping_n_s_mm_ = 0;
  double limit_ = 0;
};

struct Factory {
  static rmac::ServoLaw* create(rmac::sdk::Parameters, char*, std::size_t) { return new SpringDamper; }
};

}  // namespace

RMAC_MODULE(ServoLaw, "TestLaw", rmac::ServoLaw, Factory)
