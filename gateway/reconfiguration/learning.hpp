#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "gateway/learning/learning_port.hpp"
#include "gateway/reconfiguration/mechanism_slot.hpp"

namespace rmac::gateway {

/// What was learned of a program, handed to the servo thread between two cycles. It ends with the configuration that it
/// was learned with. Gateway thread.
class Learning final : public LearningPort {
 public:
  Learning(MechanismSlot& slot, ServoRequests& servo, MotionSupervisor& supervisor)
      : slot_(slot), servo_(servo), supervisor_(supervisor) {}

  Expected<> set_learned(const nlohmann::json& learned) override;
  [[nodiscard]] Expected<nlohmann::json> learned() const override;
  void forget() override;

 private:
  [[nodiscard]] Expected<std::shared_ptr<const LearnedPath>> read(const nlohmann::json& learned) const;
  [[nodiscard]] Expected<> check_joints(const LearnedPath& path) const;
  [[nodiscard]] std::string configuration() const;

  MechanismSlot& slot_;
  ServoRequests& servo_;
  MotionSupervisor& supervisor_;
  /// In force; atomic, as a lease may end while another thread puts in a machine.
  std::atomic<std::size_t> moves_{0}, knots_{0};
};

}  // namespace rmac::gateway
