#include "gateway/verification/checks/actuator_map_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>

namespace rmac::verifier {
namespace {

constexpr double kStep_s = 1e-5;

class ActuatorMapCheck {
 public:
  ActuatorMapCheck(const ActuatorMap& map, const ActuatorMapCase& given)
      : map_(map), given_(given), n_(given.joints.size()), random_(given.seed) {}

  Checked run() {
    if (map_.joint_count() != n_ || (given_.actuators != 0 && map_.actuator_count() != given_.actuators)) {
      return found("counts",
                   fmt::format("it maps {} joints to {} actuators; {} joints (held ones included) and {} actuators are "
                               "wanted",
                               map_.joint_count(), map_.actuator_count(), n_, given_.actuators),
                   -1, {});
    }
    shafts_ = map_.actuator_count();
    for (; sample_ < given_.samples; ++sample_) {
      at_ = random_joints();
      auto fine = check_inverse().and_then([&] { return check_velocities_and_power(); }).and_then([&] {
        return check_efforts();
      });
      if (fine = misdeed_or(given_.misdeed, std::move(fine)); !fine) return fine;
    }
    return {};
  }

 private:
  using Values = std::vector<double>;

  double random(double least, double most) { return std::uniform_real_distribution<>(least, most)(random_); }
  /// Far enough from the ends of travel for differences to stay within.
  Values random_joints() {
    Values values;
    for (const MappedJoint& joint : given_.joints) {
      const double margin = 2 * kStep_s * speed(joint);
      values.push_back(random(joint.min + margin, joint.max - margin));
    }
    return values;
  }
  static double speed(const MappedJoint& joint) { return joint.max - joint.min; }
  [[nodiscard]] Values shafts_at(const Values& joints) const {
    Values shafts(shafts_, std::nan(""));
    map_.actuator_positions(joints, shafts);
    return shafts;
  }
  [[nodiscard]] tl::unexpected<CounterExample> fault(const char* check, std::string what,
                                                     std::vector<NamedNumbers> more = {}) const {
    std::vector<NamedNumbers> values{named("joints", at_)};
    for (NamedNumbers& value : more) values.push_back(std::move(value));
    return found(check, std::move(what), sample_, std::move(values));
  }

  Checked check_inverse() {
    const Values shafts = shafts_at(at_);
    Values back(n_, std::nan(""));
    map_.joint_positions(shafts, back);
    for (std::size_t j = 0; j < n_; ++j) {
      if (!(std::abs(back[j] - at_[j]) <= 1e-9 * speed(given_.joints[j]))) {
        return fault("inverse", fmt::format("joint {} comes back {} off", j, back[j] - at_[j]),
                     {named("shafts", shafts), named("back", back)});
      }
    }
    return {};
  }

  Checked check_velocities_and_power() {
    Values rates(n_), efforts(n_), up(n_), down(n_);
    for (std::size_t j = 0; j < n_; ++j) {
      rates[j] = random(-speed(given_.joints[j]), speed(given_.joints[j]));
      efforts[j] = random(-100, 100);
      up[j] = at_[j] + kStep_s * rates[j];
      down[j] = at_[j] - kStep_s * rates[j];
    }
    const Values above = shafts_at(up), below = shafts_at(down);
    Values shaft_rates(shafts_), answer(n_, std::nan("")), torques(shafts_, std::nan(""));
    for (std::size_t a = 0; a < shafts_; ++a) shaft_rates[a] = (above[a] - below[a]) / (2 * kStep_s);
    map_.joint_velocities(shafts_at(at_), shaft_rates, answer);
    map_.actuator_efforts(at_, efforts, torques);
    double at_joints = 0, at_shafts = 0, size = 0;
    for (std::size_t j = 0; j < n_; ++j) {
      if (!(std::abs(answer[j] - rates[j]) <= 1e-5 * speed(given_.joints[j]))) {
        return fault("velocities",
                     fmt::format("joint {} is said to move at {} where positions move at {}", j, answer[j], rates[j]),
                     {named("shaft velocities", shaft_rates)});
      }
      at_joints += efforts[j] * rates[j] * given_.joints[j].power_scale;
      size += std::abs(efforts[j] * rates[j] * given_.joints[j].power_scale);
    }
    for (std::size_t a = 0; a < shafts_; ++a) at_shafts += torques[a] * shaft_rates[a];
    if (std::abs(at_shafts - at_joints) <= 1e-5 * size) return {};
    return fault("power", fmt::format("{} W at the joints are {} W at the shafts", at_joints, at_shafts),
                 {named("velocities", rates), named("efforts", efforts), named("torques", torques)});
  }

  Checked check_efforts() {
    Values first(n_), second(n_), sum(n_), reached(shafts_);
    for (std::size_t j = 0; j < n_; ++j) {
      first[j] = random(-100, 100);
      second[j] = random(-100, 100);
      sum[j] = first[j] + second[j];
      Values unit(n_);
      unit[j] = 1;
      map_.actuator_efforts(at_, unit, reached);
      double any = 0;
      for (const double torque : reached) any += std::abs(torque);
      if (!(any > 0)) return fault("efforts", fmt::format("no shaft feels an effort of joint {}", j));
    }
    Values of_first(shafts_), of_second(shafts_), of_sum(shafts_);
    map_.actuator_efforts(at_, first, of_first);
    map_.actuator_efforts(at_, second, of_second);
    map_.actuator_efforts(at_, sum, of_sum);
    for (std::size_t a = 0; a < shafts_; ++a) {
      const double off = std::abs(of_sum[a] - of_first[a] - of_second[a]);
      if (!(off <= 1e-9 * (1 + std::abs(of_first[a]) + std::abs(of_second[a])))) {
        return fault("efforts", fmt::format("shaft {}: the torque of two efforts is {} off the sum of theirs", a, off),
                     {named("first", first), named("second", second)});
      }
    }
    return {};
  }

  const ActuatorMap& map_;
  const ActuatorMapCase& given_;
  std::size_t n_;
  std::size_t shafts_ = 0;
  std::mt19937_64 random_;
  std::int64_t sample_ = 0;
  Values at_;
};

}  // namespace

Checked check_actuator_map(const ActuatorMap& map, const ActuatorMapCase& given) {
  return ActuatorMapCheck(map, given).run();
}

}  // namespace rmac::verifier
