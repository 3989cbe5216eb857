#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "gateway/reconfiguration/mechanism_slot.hpp"
#include "gateway/tools/tool_rack.hpp"

namespace rmac::gateway {

/// Puts another mechanism in, or the one in force with another configuration: assembled beside it, exchanged between
/// two cycles at rest, so that drives that both have stay enabled. Where it fails the one before is in force again.
/// Gateway thread.
class MechanismChange {
 public:
  /// `simulated`: what happens to tools leaves no trace.
  MechanismChange(MechanismSlot& slot, MotionSupervisor& supervisor, const Assembler& assembler, BusRegistry& registry,
                  MechanismUsers& users, ToolRack& rack, bool simulated);

  /// `fresh`: another mechanism, which begins anew; otherwise the one in force goes on.
  [[nodiscard]] Expected<> put_in(const sdk::DeviceObject& device, const MechanismSource& source, bool fresh);

 private:
  /// The same machine in another role: part and tool are where they were, and what its outputs hold stays held.
  [[nodiscard]] bool takes_role(const sdk::DeviceObject& device) const;
  /// A mechanism that may go in, and whether its joints are known to stand inside their limits.
  struct Candidate {
    std::shared_ptr<Mechanism> mechanism;
    bool standing_checked = false;
  };
  /// Has the mechanism in force give up its buses and interfaces, one of which the other needs with other parameters:
  /// it comes down first then, and is put back where the other cannot come up.
  [[nodiscard]] Expected<> leave_interfaces(const sdk::DeviceObject& device, const MechanismSource& source,
                                            MechanismSlot::Predecessor& before);
  [[nodiscard]] Expected<Candidate> assemble(const sdk::DeviceObject& device, const MechanismSource& source,
                                             bool fresh) const;
  [[nodiscard]] Expected<> put_to_work(Candidate candidate, bool fresh);
  void begin_anew(const std::string& name);
  void adopt_tools(const sdk::DeviceObject& device, ToolTable table, bool virtual_mode);

  MechanismSlot& slot_;
  MotionSupervisor& supervisor_;
  const Assembler& assembler_;
  BusRegistry& registry_;
  MechanismUsers& users_;
  ToolRack& rack_;
  bool simulated_;
};

}  // namespace rmac::gateway
