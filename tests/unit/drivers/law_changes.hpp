#pragma once

#include <random>

#include "gateway/controller/exchangeable_law.hpp"
#include "mill_on_simulated_bus.hpp"

namespace rmac::mill_test {

struct LawChanges {
  int count = 0, gain_count = 0;
  double largest_step_nm = 0;       ///< of the torque at a shaft, in a cycle in which its law changed
  double largest_gain_step_nm = 0;  ///< the same of its gains
  double largest_soon_nm = 0;       ///< from cycle to cycle in the three cycles after either
  double largest_ever_nm = 0;       ///< and in all the others
  double rated_nm = 0;
  double contour_error = 0;  ///< mm
};

/// The circle of the figures while the laws of random axes are exchanged for others of PID, feedforward with feedback,
/// and fuzzy, or for the same with other gains.
class LawChangesOnMill : public MillRun {
 public:
  LawChanges change_laws_on_circle(unsigned seed) {
    Mill mill("mill/3-axis/DMACXYZ", bus_, {}, [this](Mill&, ServoLoopParts& parts) {
      for (std::size_t j = 0; j < kAxes; ++j) {
        const auto law = std::make_shared<gateway::ExchangeableLaw>(parts.axes[j].law);
        exchangeable_[j] = law.get();
        parts.axes[j].law = law;
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
      if (random() % 40 == 0) change(mill, random);
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
      double& largest = since_[j] > kSoon   ? changes_.largest_ever_nm
                        : since_[j] > 0     ? changes_.largest_soon_nm
                        : gains_changed_[j] ? changes_.largest_gain_step_nm
                                            : changes_.largest_step_nm;
      largest = std::max(largest, step);
      ++since_[j];
    }
    effort_ = report_.effort;
  }
  void change(Mill& mill, std::mt19937& random) {
    const std::size_t j = random() % kAxes;
    gains_changed_[j] = random() % 2 == 0;
    double factor = 1;
    if (gains_changed_[j]) {
      factor = std::uniform_real_distribution(0.6, 1.1)(random);
      ++changes_.gain_count;
    } else {
      law_[j] = (law_[j] + 1 + random() % 2) % devices_.size();
      ++changes_.count;
    }
    nlohmann::json joint = devices_[law_[j]]["Joints"][j];
    for (nlohmann::json& gain : joint["Gains"]) gain = factor * gain.get<double>();
    auto law = mill.make_law(joint);
    law->set_effort_limit(mill.loop().parts().axes[j].max_effort);
    exchangeable_[j]->exchange(law);
    since_[j] = 0;
  }

  std::array<gateway::ExchangeableLaw*, kAxes> exchangeable_{};  ///< the mill owns them
  std::array<nlohmann::json, 3> devices_;                        ///< as it is, with feedforward, with fuzzy laws
  std::array<std::size_t, kAxes> law_{};
  std::array<int, kAxes> since_{kLongAgo, kLongAgo, kLongAgo};  ///< cycles
  std::array<bool, kAxes> gains_changed_{};
  std::array<double, kMaxJoints> effort_{};
  LawChanges changes_;
};

}  // namespace rmac::mill_test
