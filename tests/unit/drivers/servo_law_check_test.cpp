// The laws' conformance suite, held against laws that break one rule each: a check that finds nothing is worth nothing.
#include "gateway/verification/checks/servo_law_check.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "gateway/mechanism/exchangeable_law.hpp"

namespace rmac {
namespace {

using verifier::check_servo_law;

enum class Defect {
  None,
  WrongCount,
  NamelessGain,
  BeyondItsLimit,
  BeyondItsLimitOnEngaging,
  JumpsOnEngaging,
  JumpsOnNewGains,
  TakesTooManyGains,
  TakesGainsThatAreNoNumber,
  KeepsPartOfRefusedGains,
  WindsUp,
  HidesNoNumber,
  KeepsNoNumber,
  DriftsAtRest,
  TakesItsCycleForAMillisecond,
};

/// A PI law that keeps every rule but one.
class Law final : public ServoLaw {
 public:
  explicit Law(Defect defect) : defect_(defect) {}

  std::span<const GainInfo> gains() const noexcept override {
    static constexpr std::array<GainInfo, 3> kGains{{{"Kp", "N/mm"}, {"Ki", "N/(mm·s)"}, {"more", "N"}}};
    static constexpr std::array<GainInfo, 2> kNameless{{{"Kp", "N/mm"}, {"", "N/(mm·s)"}}};
    if (defect_ == Defect::NamelessGain) return kNameless;
    return {kGains.data(), defect_ == Defect::WrongCount ? 3U : 2U};
  }
  bool set_gains(std::span<const double> values) noexcept override {
    const bool fits = values.size() == 2 || (defect_ == Defect::TakesTooManyGains && values.size() > 2);
    const bool finite = std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    if (!fits || (!finite && defect_ != Defect::TakesGainsThatAreNoNumber)) {
      if (defect_ == Defect::KeepsPartOfRefusedGains && !values.empty()) kp_ = 1.5 * values[0];
      return false;
    }
    if (defect_ != Defect::JumpsOnNewGains) integral_ += (kp_ - values[0]) * error_;
    kp_ = values[0];
    ki_ = values[1];
    return true;
  }
  void set_effort_limit(double effort) noexcept override { limit_ = effort; }
  double resting_effort() const noexcept override { return 20; }
  void engage(const ServoInput& input, double effort) noexcept override {
    error_ = input.position_setpoint - input.position;
    const double within = defect_ == Defect::BeyondItsLimitOnEngaging ? effort : std::clamp(effort, -limit_, limit_);
    engaged_ = defect_ == Defect::BeyondItsLimitOnEngaging;
    const double period_s = defect_ == Defect::TakesItsCycleForAMillisecond ? 0.001 : input.period_s;
    integral_ = within - kp_ * error_ - ki_ * error_ * period_s;
    if (defect_ == Defect::JumpsOnEngaging) integral_ = 20;
  }
  double update(const ServoInput& input) noexcept override {
    if (!is_finite(input)) {
      if (defect_ == Defect::KeepsNoNumber) integral_ += 1;
      return defect_ == Defect::HidesNoNumber ? 0 : std::numeric_limits<double>::quiet_NaN();
    }
    error_ = input.position_setpoint - input.position;
    const double grown = integral_ + ki_ * error_ * input.period_s;
    const double wanted = kp_ * error_ + grown;
    const bool winds_up = std::abs(wanted) > limit_ && wanted * error_ > 0;
    if (!winds_up || defect_ == Defect::WindsUp) integral_ = grown;
    if (defect_ == Defect::DriftsAtRest) integral_ += 1e-3;
    if (defect_ == Defect::BeyondItsLimit) return std::clamp(wanted, -limit_, 1.001 * limit_);
    if (std::exchange(engaged_, false)) return wanted;
    return std::clamp(wanted, -limit_, limit_);
  }

 private:
  Defect defect_;
  double kp_ = 0, ki_ = 0, error_ = 0, integral_ = 0, limit_ = 0;
  bool engaged_ = false;
};

verifier::Checked check(Defect defect, double period_s = 0.001) {
  Law law(defect);
  return check_servo_law(law, {{1000, 50000}, {300, 1000}, 1, period_s});
}

constexpr std::array kPeriods{0.000125, 0.00025, 0.0005, 0.001, 0.002};

TEST(LawsConformance, FindsNothingWhereNothingIsWrong) {
  for (const double period_s : kPeriods) {
    const auto checked = check(Defect::None, period_s);
    EXPECT_TRUE(checked) << period_s << ": " << to_string(checked.error());
  }
}

TEST(LawsConformance, IsHeldAtThePeriodThatTheLawIsToRunIn) {
  for (const double period_s : kPeriods) {
    const auto checked = check(Defect::TakesItsCycleForAMillisecond, period_s);
    ASSERT_EQ(checked.has_value(), period_s == 0.001) << period_s;
    if (!checked) {
      EXPECT_EQ(checked.error().check, "engaging") << period_s;
    }
  }
}

TEST(ExchangeableLaw, KeepsWhatItsLawKeeps) {
  gateway::ExchangeableLaw law(std::make_shared<Law>(Defect::None));
  const auto checked = check_servo_law(law, {{1000, 50000}, {300, 1000}});
  EXPECT_TRUE(checked) << to_string(checked.error());
}

TEST(ExchangeableLaw, GoesOnFromTheEffortOfTheLawBeforeWhateverTheSetpointDoes) {
  const auto one = [](double kp) {
    auto made = std::make_shared<Law>(Defect::None);
    EXPECT_TRUE(made->set_gains(std::array{kp, 0.0}));
    made->set_effort_limit(1000);
    return std::static_pointer_cast<ServoLaw>(made);
  };
  gateway::ExchangeableLaw law(one(100));
  law.engage({}, 40);
  const double before = law.update({.position_setpoint = 0.5});
  EXPECT_DOUBLE_EQ(before, 90);
  auto other = one(300);
  law.exchange(other);
  EXPECT_DOUBLE_EQ(law.update({.position_setpoint = 0.6}), before) << "a cycle's way further";
  EXPECT_DOUBLE_EQ(law.update({.position_setpoint = 0.7}), before + 300 * 0.1);
  other = one(100);
  law.exchange(other);
  law.engage({.position_setpoint = 0.7}, -7);  // of a drive that was enabled again meanwhile
  EXPECT_DOUBLE_EQ(law.update({.position_setpoint = 0.7}), -7);
}

struct Broken {
  Defect defect;
  const char* name;
  const char* check;  ///< that finds it
};
void PrintTo(const Broken& broken, std::ostream* out) {
  *out << broken.name;
}

class BrokenLaw : public testing::TestWithParam<Broken> {};

TEST_P(BrokenLaw, IsFoundByTheCheckOfItsRule) {
  const auto checked = check(GetParam().defect);
  ASSERT_FALSE(checked) << "nothing was found";
  EXPECT_EQ(checked.error().check, GetParam().check) << to_string(checked.error());
}

INSTANTIATE_TEST_SUITE_P(
    OfEveryKind, BrokenLaw,
    testing::Values(Broken{Defect::WrongCount, "WrongCount", "gains"},
                    Broken{Defect::NamelessGain, "NamelessGain", "gains"},
                    Broken{Defect::BeyondItsLimit, "BeyondItsLimit", "effort limit"},
                    Broken{Defect::BeyondItsLimitOnEngaging, "BeyondItsLimitOnEngaging", "effort limit"},
                    Broken{Defect::JumpsOnEngaging, "JumpsOnEngaging", "engaging"},
                    Broken{Defect::JumpsOnNewGains, "JumpsOnNewGains", "new gains"},
                    Broken{Defect::TakesTooManyGains, "TakesTooManyGains", "gains"},
                    Broken{Defect::TakesGainsThatAreNoNumber, "TakesGainsThatAreNoNumber", "gains"},
                    Broken{Defect::KeepsPartOfRefusedGains, "KeepsPartOfRefusedGains", "gains"},
                    Broken{Defect::WindsUp, "WindsUp", "windup"},
                    Broken{Defect::HidesNoNumber, "HidesNoNumber", "no number in"},
                    Broken{Defect::KeepsNoNumber, "KeepsNoNumber", "no number in"},
                    Broken{Defect::DriftsAtRest, "DriftsAtRest", "resting effort"}),
    [](const testing::TestParamInfo<Broken>& broken) { return std::string(broken.param.name); });

}  // namespace
}  // namespace rmac
