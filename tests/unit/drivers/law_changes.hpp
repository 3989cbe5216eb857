#pragma once

#include <limits>
#include <random>
#include <vector>

#include "gateway/mechanism/exchangeable_law.hpp"
#include "mill_on_simulated_bus.hpp"

namespace rmac::mill_test {

struct LawChanges {
  int count = 0, gain_count = 0, method_count = 0;
  double largest_step_nm = 0;       ///< of the torque at a shaft, in a cycle in which its law changed
  double largest_gain_step_nm = 0;  ///< the same of its gains
  double largest_soon_nm = 0;       ///< from cycle to cycle in the three cycles after either
  double largest_ever_nm = 0;       ///< and in all the others
  double rated_nm = 0;
  std::vector<std::array<double, 3>> torque_nm;  ///< of each cycle
  double contour_error = 0;                      ///< mm
};

/// The circle of the figures while the laws of random axes are exchanged for others of PID, feedforward with feedback,
/// and fuzzy, or for the same with other gains, and joints change between position and velocity control.
class LawChangesOnMill : public MillRun {
 public:
  LawChanges change_laws_on_circle(unsigned seed, bool methods_too = true) {
    methods_too_ = methods_too;
    Mill mill("mill/3-axis/DMACXYZ", bus_, {}, [this](Mill&, ServoLoopParts& parts) {
      for (std::size_t j = 0; j < kAxes; ++j) {
        const auto law = std::make_shared<gateway::ExchangeableLaw>(parts.joints[j].law);
        exchangeable_[j] = law.get();
        parts.joints[j].law = law;
      }
    });
    devices_ = {mill.device(), mill.device(), mill.device()};
    choose_feedforward(devices_[1]);
    choose_fuzzy(devices_[2], 120);
    power_up(mill);
    effort_ = report_.effort;
    changes_.rated_nm = mill.device()["Actuators"][0]["RatedTorque"];
    std::mt19937 random(seed);
    const Ballbar ballbar = circle(mill, kFastCircle, [&] {
      note_steps();
      if (random() % 25 == 0) change(mill, random);
    });
    changes_.contour_error = ballbar.contour_error();
    return changes_;
  }

 private:
  static constexpr std::size_t kAxes = 3;
  static constexpr int kSoon = 3, kLongAgo = 100;

  /// What the cycle before did to each axis.
  void note_steps() {
    constexpr double kNewtonMetres = 5e-3 / (2 * std::numbers::pi);  // at the shaft, for each newton at the joint
    for (std::size_t j = 0; j < kAxes; ++j) {
      const double step = std::abs(report_.effort[j] - effort_[j]) * kNewtonMetres;
      double& largest = since_[j] > kSoon ? changes_.largest_ever_nm
                        : since_[j] > 0   ? changes_.largest_soon_nm
                                          : *largest_[j];
      largest = std::max(largest, step);
      ++since_[j];
    }
    effort_ = report_.effort;
    auto& torque = changes_.torque_nm.emplace_back();
    for (std::size_t j = 0; j < kAxes; ++j) torque[j] = effort_[j] * kNewtonMetres;
  }
  void change(Mill& mill, std::mt19937& random) {
    const std::size_t j = random() % kAxes;
    double factor = 1;
    switch (random() % 3) {
      case 0:
        factor = std::uniform_real_distribution(0.6, 1.1)(random);
        largest_[j] = &changes_.largest_gain_step_nm;
        ++changes_.gain_count;
        break;
      case 1:
        law_[j] = (law_[j] + 1 + random() % 2) % devices_.size();
        largest_[j] = &changes_.largest_step_nm;
        ++changes_.count;
        break;
      default:
        if (methods_too_) mill.loop().set_control_method(j, other_than(mill.loop().parts().joints[j].method));
        ++changes_.method_count;
        return;
    }
    nlohmann::json joint = devices_[law_[j]]["Joints"][j];
    for (nlohmann::json& gain : joint["Gains"]) gain = factor * gain.get<double>();
    auto law = mill.make_law(joint);
    law->set_effort_limit(mill.loop().parts().joints[j].max_effort);
    exchangeable_[j]->exchange(law);
    since_[j] = 0;
  }
  static ControlMethod other_than(ControlMethod method) {
    return method == ControlMethod::Position ? ControlMethod::Velocity : ControlMethod::Position;
  }

  bool methods_too_ = true;
  std::array<gateway::ExchangeableLaw*, kAxes> exchangeable_{};  ///< the mill owns them
  std::array<nlohmann::json, 3> devices_;                        ///< as it is, with feedforward, with fuzzy laws
  std::array<std::size_t, kAxes> law_{};
  std::array<int, kAxes> since_{kLongAgo, kLongAgo, kLongAgo};  ///< cycles
  std::array<double*, kAxes> largest_{};                        ///< step at the kind of change that was the last
  std::array<double, kMaxJoints> effort_{};
  LawChanges changes_;
};

/// Largest difference of a torque in any cycle to that of the same run without changes of methods, N·m.
inline double largest_difference_nm(const LawChanges& a, const LawChanges& b) {
  double largest = a.torque_nm.size() == b.torque_nm.size() ? 0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(a.torque_nm.size(), b.torque_nm.size()); ++i) {
    for (std::size_t j = 0; j < 3; ++j) largest = std::max(largest, std::abs(a.torque_nm[i][j] - b.torque_nm[i][j]));
  }
  return largest;
}

}  // namespace rmac::mill_test
