#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "gateway/controller/controller.hpp"
#include "gateway/dynamics/axis_dynamics.hpp"
#include "gateway/rmac/simulator/collision_watch.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// Has the axes of a simulated machine do what its servo loops and motors make of the setpoints, with the tool pushed
/// by what it cuts.
class DynamicsWatch {
 public:
  /// `machine` as for `Simulation::open`; `cuts` tells the forces and outlives this, or is null: nothing pushes.
  [[nodiscard]] static Result<std::unique_ptr<DynamicsWatch>> open(const std::string& machine,
                                                                   const std::filesystem::path& device_tree,
                                                                   double period_s, const CollisionWatch* cuts);

  void tool_may_have_changed() noexcept { look_at_tool_ = true; }
  /// The same cycle with its joints, and they alone, where they truly are. As planned before the first motion, for
  /// another machine, and once a fault stopped this one.
  [[nodiscard]] gateway::CycleSample cycle(const gateway::CycleSample& planned, int line,
                                           gateway::Controller& controller);
  /// The run is over.
  void finish() { axes_->finish(); }

  [[nodiscard]] const gateway::AxisDynamics& axes() const noexcept { return *axes_; }
  /// What it does not tell of, a sentence each; empty: it tells of all.
  [[nodiscard]] const std::set<std::string>& not_told() const noexcept { return not_told_; }

 private:
  DynamicsWatch(std::string machine, std::unique_ptr<gateway::AxisDynamics> axes, const CollisionWatch* cuts)
      : machine_(std::move(machine)), axes_(std::move(axes)), cuts_(cuts) {}
  /// On the tool, in the frame of the link that holds the part. As a mean over a turn it takes a turn to change.
  void take_force(const gateway::CycleSample& planned);

  std::string machine_;
  std::unique_ptr<gateway::AxisDynamics> axes_;
  const CollisionWatch* cuts_;
  std::set<std::string> not_told_;
  Frame tool_;
  double told_s_ = 0;  ///< when there was a force last
  Eigen::Vector3d force_n_{0, 0, 0};
  bool look_at_tool_ = true, begun_ = false;
};

/// A failure where the machine stops, leaves its path, or a motor grows too hot, or not all is told.
[[nodiscard]] Result<> verdict(const DynamicsWatch& watch);

}  // namespace rmac::cli
