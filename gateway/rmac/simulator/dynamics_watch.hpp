#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "gateway/chatter/chatter_watch.hpp"
#include "gateway/chatter/tool_bending.hpp"
#include "gateway/controller/controller.hpp"
#include "gateway/dynamics/axis_dynamics.hpp"
#include "gateway/rmac/simulator/collision_watch.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// A cycle as the machine makes it.
struct TrueCycle {
  gateway::CycleSample sample;       ///< as planned, but its joints, and they alone, where they truly are
  Eigen::Vector3d bend_mm{0, 0, 0};  ///< of the tool's tip, part frame
};

/// Has the axes of a simulated machine do what its servo loops and motors make of the setpoints, with the tool pushed
/// and bent by what it cuts, and tells where that chatters.
class DynamicsWatch : gateway::EngagedListener {
 public:
  /// `machine` as for `Simulation::open`; `cuts` tells the forces and outlives this, or is null: nothing pushes.
  [[nodiscard]] static Result<std::unique_ptr<DynamicsWatch>> open(const std::string& machine,
                                                                   const std::filesystem::path& device_tree,
                                                                   double period_s, CollisionWatch* cuts);

  void tool_may_have_changed() noexcept { look_at_tool_ = true; }
  void configuration_may_have_changed() noexcept { look_at_configuration_ = true; }
  /// As planned before the first motion and for another machine; where it was when a fault stopped this one.
  [[nodiscard]] TrueCycle cycle(const gateway::CycleSample& planned, int line, gateway::Controller& controller);
  /// The run is over.
  void finish();

  [[nodiscard]] const gateway::AxisDynamics& axes() const noexcept { return *axes_; }
  [[nodiscard]] const gateway::ChatterWatch& chatter() const noexcept { return chatter_; }
  [[nodiscard]] gateway::AxisDynamics& axes() noexcept { return *axes_; }
  /// What it does not tell of, a sentence each; empty: it tells of all.
  [[nodiscard]] const std::set<std::string>& not_told() const noexcept { return not_told_; }

 private:
  DynamicsWatch(const sdk::DeviceObject& device, std::unique_ptr<gateway::AxisDynamics> axes, CollisionWatch* cuts);
  /// On the tool, part frame. As a mean over a turn it takes a turn to change.
  void take_force(const gateway::CycleSample& planned, int line);
  void take_tool(const gateway::Tool& tool);
  [[nodiscard]] double most_rpm() const noexcept;
  void engaged(const gateway::EngagedTool& tool) override;

  /// Tells where the machine in force is not the one that was opened.
  void check_configuration(const sdk::DeviceObject& device);

  std::string machine_;
  nlohmann::json configured_;  ///< what its axes go by
  std::unique_ptr<gateway::AxisDynamics> axes_;
  const CollisionWatch* cuts_;
  gateway::ChatterWatch chatter_;
  std::set<std::string> not_told_;
  struct Mounted {
    int number = gateway::kNoTool;
    Frame tip;
    gateway::ToolBending bending;  ///< stiff where nobody knows
    std::string no_bending;        ///< why that is not known
    double most_bend_mm = 0;       ///< beyond it the tool would break
    double most_rpm = 0;           ///< 0: not known
  };
  Mounted tool_;
  std::set<int> broken_;                                   ///< tools that would
  double spindle_most_rpm_ = 0;                            ///< 0: not known
  Eigen::Matrix3d to_link_ = Eigen::Matrix3d::Identity();  ///< from the part frame to the frame of its link
  double told_s_ = 0;                                      ///< when there was a force last
  Eigen::Vector3d force_n_{0, 0, 0}, bend_mm_{0, 0, 0};
  bool look_at_tool_ = true, look_at_configuration_ = true, begun_ = false;
};

/// "in line 7", or that it was before.
[[nodiscard]] std::string where(const gateway::StoppedByFault& stopped);

/// A failure where the machine stops, leaves its path, or a motor grows too hot: what a slower feed may mend.
[[nodiscard]] Result<> keeps_to_program(const DynamicsWatch& watch);
/// So, or a cut chatters, or not all is told.
[[nodiscard]] Result<> verdict(const DynamicsWatch& watch);

}  // namespace rmac::cli
