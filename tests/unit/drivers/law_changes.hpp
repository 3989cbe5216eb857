#pragma once

#include <random>

#include "mill_on_simulated_bus.hpp"

namespace rmac::mill_test {

/// Follows one law after the other, as a swap between two cycles does it, and remembers by how much the effort changes
/// where they change.
class SwitchingLaw : public ServoLaw {
 public:
  explicit SwitchingLaw(std::vector<std::shared_ptr<ServoLaw>> laws) : laws_(std::move(laws)) {}
  [[nodiscard]] std::span<const GainInfo> gains() const noexcept override { return laws_[now_]->gains(); }
  [[nodiscard]] bool set_gains(std::span<const double> values) noexcept override {
    return laws_[now_]->set_gains(values);
  }
  void set_effort_limit(double effort) noexcept override {
    for (const auto& law : laws_) law->set_effort_limit(effort);
  }
  void engage(const ServoInput& input, double effort) noexcept override { laws_[now_]->engage(input, effort); }
  [[nodiscard]] double update(const ServoInput& input) noexcept override {
    const double before = effort_;
    if (wanted_ != now_) {
      now_ = wanted_;
      laws_[now_]->engage(input, effort_);
      effort_ = laws_[now_]->update(input);
      largest_step_ = std::max(largest_step_, std::abs(effort_ - before));
    } else {
      effort_ = laws_[now_]->update(input);
    }
    return effort_;
  }

  void change_to(std::size_t law) { wanted_ = law; }
  [[nodiscard]] std::size_t now() const { return now_; }
  [[nodiscard]] std::size_t count() const { return laws_.size(); }
  [[nodiscard]] double largest_step() const { return largest_step_; }

 private:
  std::vector<std::shared_ptr<ServoLaw>> laws_;
  std::size_t now_ = 0, wanted_ = 0;
  double effort_ = 0;
  double largest_step_ = 0;
};

struct LawChanges {
  int count = 0;
  double largest_step_nm = 0;  ///< of the torque at a shaft, in a cycle in which its law changed
  double rated_nm = 0;
  double contour_error = 0;  ///< mm
};

/// The circle of the figures while the laws of random axes change, between PID, feedforward with feedback, and fuzzy.
class LawChangesOnMill : public MillRun {
 public:
  LawChanges change_laws_on_circle(unsigned seed) {
    std::vector<SwitchingLaw*> switching;  // the mill owns them
    Mill mill("mill/3-axis/DMACXYZ", bus_, {}, [&](Mill& made, ServoLoopParts& parts) {
      nlohmann::json feedforward = made.device(), fuzzy = made.device();
      choose_feedforward(feedforward);
      choose_fuzzy(fuzzy, 120);
      for (std::size_t j = 0; j < parts.axes.size(); ++j) {
        std::vector<std::shared_ptr<ServoLaw>> laws{parts.axes[j].law};
        for (const auto& device : {feedforward, fuzzy}) laws.push_back(made.make_law(device["Joints"][j]));
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
      law.change_to((law.now() + 1 + random() % 2) % law.count());
      ++changes.count;
    });
    changes.contour_error = ballbar.contour_error();
    for (const SwitchingLaw* law : switching) {
      const double newton_metres = law->largest_step() * 5e-3 / (2 * std::numbers::pi);
      changes.largest_step_nm = std::max(changes.largest_step_nm, newton_metres);
    }
    changes.rated_nm = mill.device()["Actuators"][0]["RatedTorque"];
    return changes;
  }
};

}  // namespace rmac::mill_test
