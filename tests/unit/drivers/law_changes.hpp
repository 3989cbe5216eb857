#pragma once

#include <random>

#include "mill_on_simulated_bus.hpp"

namespace rmac::mill_test {

/// Follows one law after the other, and one set of gains after the other, as a swap between two cycles does it, and
/// remembers by how much the effort changes for it. A twin of each law keeps its gains for that cycle: what it would
/// have changed anyway is no step.
class SwitchingLaw : public ServoLaw {
 public:
  struct Choice {
    std::shared_ptr<ServoLaw> law, twin;
    std::vector<double> gains;
  };
  explicit SwitchingLaw(std::vector<Choice> laws) : laws_(std::move(laws)) {}
  [[nodiscard]] std::span<const GainInfo> gains() const noexcept override { return laws_[now_].law->gains(); }
  [[nodiscard]] bool set_gains(std::span<const double>) noexcept override { return false; }
  void set_effort_limit(double effort) noexcept override {
    for (const Choice& choice : laws_) {
      choice.law->set_effort_limit(effort);
      choice.twin->set_effort_limit(effort);
    }
  }
  void engage(const ServoInput& input, double effort) noexcept override {
    laws_[now_].law->engage(input, effort);
    laws_[now_].twin->engage(input, effort);
  }
  [[nodiscard]] double update(const ServoInput& input) noexcept override {
    const double before = effort_;
    if (wanted_ != now_) {
      now_ = wanted_;
      engage(input, effort_);
      effort_ = laws_[now_].law->update(input);
      (void)laws_[now_].twin->update(input);
      largest_step_ = std::max(largest_step_, std::abs(effort_ - before));
      return effort_;
    }
    const Choice& choice = laws_[now_];
    std::vector<double> gains = choice.gains;
    for (double& gain : gains) gain *= factor_;
    const bool changes = factor_ != factor_before_ && choice.law->set_gains(gains);
    effort_ = choice.law->update(input);
    const double unchanged = choice.twin->update(input);
    if (changes) {
      largest_gain_step_ = std::max(largest_gain_step_, std::abs(effort_ - unchanged));
      (void)choice.twin->set_gains(gains);
      engage(input, effort_);
    }
    factor_before_ = factor_;
    return effort_;
  }

  void change_to(std::size_t law) { wanted_ = law; }
  /// All gains to so much of what device.json gives.
  void change_gains(double factor) { factor_ = factor; }
  [[nodiscard]] std::size_t now() const { return now_; }
  [[nodiscard]] std::size_t count() const { return laws_.size(); }
  [[nodiscard]] double largest_step() const { return largest_step_; }
  [[nodiscard]] double largest_gain_step() const { return largest_gain_step_; }

 private:
  std::vector<Choice> laws_;
  std::size_t now_ = 0, wanted_ = 0;
  double factor_ = 1, factor_before_ = 1;
  double effort_ = 0;
  double largest_step_ = 0, largest_gain_step_ = 0;
};

struct LawChanges {
  int count = 0, gain_count = 0;
  double largest_step_nm = 0;       ///< of the torque at a shaft, in a cycle in which its law changed
  double largest_gain_step_nm = 0;  ///< the same of its gains
  double rated_nm = 0;
  double contour_error = 0;  ///< mm
};

/// The circle of the figures while the laws of random axes change, between PID, feedforward with feedback, and fuzzy,
/// and their gains.
class LawChangesOnMill : public MillRun {
 public:
  LawChanges change_laws_on_circle(unsigned seed) {
    std::vector<SwitchingLaw*> switching;  // the mill owns them
    Mill mill("mill/3-axis/DMACXYZ", bus_, {}, [&](Mill& made, ServoLoopParts& parts) {
      nlohmann::json feedforward = made.device(), fuzzy = made.device();
      choose_feedforward(feedforward);
      choose_fuzzy(fuzzy, 120);
      for (std::size_t j = 0; j < parts.axes.size(); ++j) {
        std::vector<SwitchingLaw::Choice> laws;
        for (const auto& device : {made.device(), feedforward, fuzzy}) {
          const nlohmann::json& joint = device["Joints"][j];
          laws.push_back({made.make_law(joint), made.make_law(joint), joint["Gains"].get<std::vector<double>>()});
        }
        const auto law = std::make_shared<SwitchingLaw>(std::move(laws));
        switching.push_back(law.get());
        parts.axes[j].law = law;
      }
    });
    power_up(mill);
    std::mt19937 random(seed);
    LawChanges changes;
    const Ballbar ballbar = circle(mill, kFastCircle, [&] {
      if (random() % 40 != 0) return;
      SwitchingLaw& law = *switching[random() % switching.size()];
      if (random() % 2 == 0) {
        law.change_gains(std::uniform_real_distribution(0.6, 1.1)(random));
        ++changes.gain_count;
      } else {
        law.change_to((law.now() + 1 + random() % 2) % law.count());
        ++changes.count;
      }
    });
    changes.contour_error = ballbar.contour_error();
    constexpr double kNewtonMetres = 5e-3 / (2 * std::numbers::pi);  // at the shaft, for each newton at the joint
    for (const SwitchingLaw* law : switching) {
      changes.largest_step_nm = std::max(changes.largest_step_nm, law->largest_step() * kNewtonMetres);
      changes.largest_gain_step_nm = std::max(changes.largest_gain_step_nm, law->largest_gain_step() * kNewtonMetres);
    }
    changes.rated_nm = mill.device()["Actuators"][0]["RatedTorque"];
    return changes;
  }
};

}  // namespace rmac::mill_test
