#pragma once

#include <cstdint>
#include <memory>
#include <mutex>

#include "gateway/animation/machine_drawing.hpp"
#include "rmac/motion/ports/kinematics.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// The shape of the mechanism in force, and what can be drawn of it. Nothing is computed before somebody asks.
class MachineShape final : public ShapePort {
 public:
  /// This mechanism is in force from now on, nullptr: none, with these kinematics. `cycle`: the last whose sample may
  /// be of the one before.
  void mechanism_changed(const sdk::DeviceObject* device, std::shared_ptr<const Kinematics> kinematics,
                         std::int64_t cycle);

  void set_bodies(MachineBodies bodies) override;
  [[nodiscard]] std::shared_ptr<const MachineDrawing> drawing() const override;
  /// Never null.
  [[nodiscard]] std::shared_ptr<const MachineBodies> bodies() const;

 private:
  [[nodiscard]] MachineDrawing draw() const;

  mutable std::mutex lock_;  ///< of all that follows
  std::int64_t number_ = 0, cycle_ = 0;
  std::string machine_;
  std::vector<JointLimits> joints_;
  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const MachineBodies> bodies_ = std::make_shared<const MachineBodies>();
  mutable std::shared_ptr<const MachineDrawing> drawing_;  ///< null: not asked for yet
};

}  // namespace rmac::gateway
