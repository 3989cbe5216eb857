#include "gateway/verification/checks/servo_law_check.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

namespace rmac::verifier {
namespace {

constexpr double kLimit = 100;
/// Beyond what gains make of the inputs here, so that the limit does not hide or make a jump.
constexpr double kFarLimit = 1e12;
/// At the limit: more than a useful integral needs to get there.
constexpr double kSaturated_s = 2;
constexpr double kMostLeaving_s = 20;

NamedNumbers named_input(const char* name, const ServoInput& input) {
  return {
      name,
      {input.position_setpoint, input.velocity_setpoint, input.acceleration_setpoint, input.position, input.velocity}};
}

class ServoLawCheck {
 public:
  ServoLawCheck(ServoLaw& law, const ServoLawCase& given)
      : law_(law),
        gains_(given.gains),
        other_gains_(given.other_gains),
        seed_(static_cast<std::mt19937::result_type>(given.seed)),
        rest_{.period_s = given.period_s} {
    if (other_gains_.empty()) other_gains_ = gains_;
  }

  Checked run() {
    return check_gains()
        .and_then([&] { return check_bounded(); })
        .and_then([&] { return check_engage(); })
        .and_then([&] { return check_resting(); })
        .and_then([&] { return check_new_gains(); })
        .and_then([&] { return check_refused_gains(); })
        .and_then([&] { return check_windup(); })
        .and_then([&] { return check_no_number(); });
  }

 private:
  /// Sets gains that it took before.
  [[nodiscard]] Checked set(const std::vector<double>& gains) {
    if (law_.set_gains(gains)) return {};
    return found("gains", "it refuses gains that it takes at other times", -1, {named("gains", gains)});
  }

  Checked check_gains() {
    if (law_.gains().size() != gains_.size()) {
      return found("gains", fmt::format("it takes {} gains", law_.gains().size()), -1, {named("gains", gains_)});
    }
    for (const GainInfo& gain : law_.gains()) {
      if (gain.name == nullptr || *gain.name == '\0' || gain.unit == nullptr || *gain.unit == '\0') {
        return found("gains", "one has no name or no unit", -1, {});
      }
    }
    for (const auto& gains : {other_gains_, gains_}) {
      if (!law_.set_gains(gains)) return found("gains", "it refuses them", -1, {named("gains", gains)});
    }
    return {};
  }

  [[nodiscard]] ServoInput random_input(std::mt19937& random, double size) const {
    std::uniform_real_distribution<> value(-size, size);
    return {.position_setpoint = value(random),
            .velocity_setpoint = value(random),
            .acceleration_setpoint = value(random),
            .position = value(random),
            .velocity = value(random),
            .period_s = rest_.period_s};
  }
  [[nodiscard]] int cycles(double time_s) const { return static_cast<int>(std::lround(time_s / rest_.period_s)); }
  static double random_effort(std::mt19937& random) {
    return std::uniform_real_distribution<>(-kLimit, kLimit)(random);
  }

  Checked check_bounded() {
    std::mt19937 random(seed_);
    law_.set_effort_limit(kLimit);
    law_.engage(rest_, 0);
    for (int i = 0; i < 10000; ++i) {
      const ServoInput input = random_input(random, i % 2 == 0 ? 1e-3 : 1e6);
      const double effort = law_.update(input);
      if (!(std::abs(effort) <= kLimit)) {
        return found("effort limit", fmt::format("it puts out {} with a limit of {}", effort, kLimit), i,
                     {named_input("input", input)});
      }
      if (i % 100 != 0) continue;
      if (auto taken = set(i % 200 == 0 ? other_gains_ : gains_); !taken) return taken;
    }
    const ServoInput input = random_input(random, 1);
    law_.engage(input, 10 * kLimit);
    if (const double effort = law_.update(input); !(std::abs(effort) <= kLimit)) {
      return found("effort limit", fmt::format("engaged with {} it puts out {}", 10 * kLimit, effort), 0,
                   {named_input("input", input)});
    }
    return set(gains_);
  }

  Checked check_engage() {
    std::mt19937 random(seed_);
    law_.set_effort_limit(kLimit);
    for (int i = 0; i < 1000; ++i) {
      const ServoInput input = random_input(random, 10);
      const double effort = random_effort(random);
      law_.engage(input, effort);
      if (const double next = law_.update(input); !(std::abs(next - effort) <= 1e-6)) {
        return found("engaging", fmt::format("the output jumps from {} to {}", effort, next), i,
                     {named_input("input", input)});
      }
      for (int cycle = 0; cycle < i % 5; ++cycle) (void)law_.update(random_input(random, 10));
    }
    return {};
  }

  /// What holds the joint at rest is what the law puts out there, and goes on with.
  Checked check_resting() {
    const double resting = law_.resting_effort();
    if (!std::isfinite(resting)) return found("resting effort", fmt::format("it is {}", resting), 0, {});
    law_.set_effort_limit(std::abs(resting) + kLimit);
    law_.engage(rest_, resting);
    for (int i = 0; i < 1000; ++i) {
      if (const double effort = law_.update(rest_); !(std::abs(effort - resting) <= 1e-6)) {
        return found("resting effort", fmt::format("it is {}, but at rest the law puts out {}", resting, effort), i,
                     {});
      }
    }
    return {};
  }

  /// With steady input the step in which gains change is no larger than the steps before and after it together: those
  /// of the integral, and of an offset that fades. Steady is rest, or a speed at which friction that builds up over a
  /// way has done so.
  Checked check_new_gains() {
    constexpr double kFast = 1e6;
    std::mt19937 random(seed_);
    law_.set_effort_limit(kFarLimit);
    for (int i = 0; i < 1000; ++i) {
      ServoInput input = random_input(random, 0.01);
      for (double* const wanted : {&input.velocity_setpoint, &input.acceleration_setpoint}) {
        *wanted *= i % 2 == 0 ? 0 : kFast;
      }
      law_.engage(input, random_effort(random));
      const double first = law_.update(input);
      const double second = law_.update(input);
      if (auto taken = set(i % 3 == 0 ? gains_ : other_gains_); !taken) return taken;
      const double third = law_.update(input);
      const double fourth = law_.update(input);
      const double natural = std::abs(second - first) + std::abs(fourth - third);
      if (!(std::abs(third - second) <= 1.01 * natural + 1e-6 * (1 + std::abs(second)))) {
        return found("new gains", fmt::format("the output jumps from {} to {}", second, third), i,
                     {named_input("input", input), named("gains", i % 3 == 0 ? gains_ : other_gains_)});
      }
    }
    return set(gains_);
  }

  Checked check_refused_gains() {
    std::mt19937 random(seed_);
    const ServoInput input = random_input(random, 0.01);
    std::vector<std::vector<double>> wrong(2, gains_);
    wrong[0].push_back(1);
    if (!gains_.empty()) {
      wrong[1].pop_back();
      wrong.push_back(gains_);
      wrong.back().back() = std::numeric_limits<double>::quiet_NaN();
    } else {
      wrong.pop_back();
    }
    law_.set_effort_limit(kFarLimit);
    law_.engage(input, 5);
    const double first = law_.update(input);
    const double step = law_.update(input) - first;
    law_.engage(input, 5);
    const double again = law_.update(input);
    for (const std::vector<double>& values : wrong) {
      if (law_.set_gains(values)) return found("gains", "it takes wrong ones", -1, {named("gains", values)});
    }
    if (again == first && law_.update(input) - first == step) return {};
    return found("gains", "gains that were refused changed something", 0, {named_input("input", input)});
  }

  /// Cycles at its limit that an error takes to leave it the other way, after so many cycles at it; the most that are
  /// looked at when it does not. An error that does not take it to its limit says nothing.
  std::optional<int> cycles_to_leave(int saturated, double error) {
    ServoInput ahead = rest_, behind = rest_;
    ahead.position_setpoint = error;
    behind.position_setpoint = -error;
    law_.set_effort_limit(kLimit);
    law_.engage(rest_, 0);
    double held = 0;
    for (int i = 0; i < saturated; ++i) held = law_.update(ahead);
    if (std::abs(held) < kLimit) return {};
    const int most = cycles(kMostLeaving_s);
    for (int i = 0; i < most; ++i) {
      if (law_.update(behind) != held) return i;
    }
    return most;
  }

  /// However long the output was at its limit, it leaves it as soon.
  Checked check_windup() {
    const int saturated = cycles(kSaturated_s);
    for (const double size : {0.01, 0.1, 1.0, 10.0}) {
      for (const double error : {size, -size}) {
        const auto soon = cycles_to_leave(saturated, error), late = cycles_to_leave(10 * saturated, error);
        if (!soon || !late || *late <= *soon + 1) continue;
        return found("windup",
                     fmt::format("at its limit for {} cycles it leaves it after {}, for {} cycles after {}", saturated,
                                 *soon, 10 * saturated, *late),
                     -1, {named("error", std::array{error})});
      }
    }
    return {};
  }

  Checked check_no_number() {
    constexpr double ServoInput::*kFields[] = {&ServoInput::position_setpoint, &ServoInput::velocity_setpoint,
                                               &ServoInput::acceleration_setpoint, &ServoInput::position,
                                               &ServoInput::velocity};
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::mt19937 random(seed_);
    law_.set_effort_limit(kLimit);
    for (const auto field : kFields) {
      for (const double value : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity}) {
        const ServoInput good = random_input(random, 0.01);
        ServoInput bad = good;
        bad.*field = value;
        const double effort = random_effort(random);
        law_.engage(good, effort);
        if (const double out = law_.update(bad); std::isfinite(out)) {
          return found("no number in", fmt::format("it puts out {}, which hides that a measurement failed", out), 0,
                       {named_input("input", bad)});
        }
        if (const double next = law_.update(good); !(std::abs(next - effort) <= 1e-6)) {
          return found("no number in",
                       fmt::format("it stays in the law's state: {} is put out in place of {}", next, effort), 0,
                       {named_input("input", bad)});
        }
      }
    }
    return {};
  }

  ServoLaw& law_;
  std::vector<double> gains_, other_gains_;
  std::mt19937::result_type seed_;
  ServoInput rest_;
};

}  // namespace

Checked check_servo_law(ServoLaw& law, const ServoLawCase& given) {
  return ServoLawCheck(law, given).run();
}

}  // namespace rmac::verifier
