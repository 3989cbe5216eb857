#pragma once

#include <functional>
#include <optional>
#include <variant>

#include "gateway/rmac_cam/settings/move_maker.hpp"
#include "gateway/rmac_cam/settings/tool_place.hpp"
#include "rmac/sdk/cam/positioning.hpp"

namespace rmac::gateway {

/// Jogs, and the ways to known places. Gateway thread only.
class CamPositioning final : public sdk::Positioning {
 public:
  CamPositioning(const DeviceInForce& device, MotionSupervisor& supervisor, const ServoLink& link,
                 const CamPathSettings& path, const MoveMaker& maker)
      : device_(device), supervisor_(supervisor), link_(link), path_(path), maker_(maker), tool_(supervisor, link) {}

  Expected<> jog_joint(int joint, double distance) override;
  Expected<> jog_joint_at(int joint, double velocity) override;
  Expected<> jog_path(const sdk::JogDirection& direction, double distance_mm) override;
  Expected<> jog_path_at(const sdk::JogDirection& direction, double velocity_mm_s) override;
  Expected<> home() override;
  Expected<> move_to_reference_point() override;
  [[nodiscard]] Expected<std::vector<double>> current_position() const override;

 private:
  /// What a jog by velocity moves, and at what speed when it is not slowed down.
  struct Jog {
    std::variant<int, sdk::JogDirection> what;
    bool positive = true;
    double fastest = 0;
  };
  /// Goes on with the jog under way if it is this one, or starts it with the move that `begin` makes.
  [[nodiscard]] Expected<> jog_at(const char* function, const Jog& jog, double velocity,
                                  const std::function<Expected<Move>()>& begin);
  /// All joints where they are meant to be now.
  [[nodiscard]] JointTargetGeometry joints_now() const;
  /// To where a joint's travel ends on one side.
  [[nodiscard]] Expected<Move> move_to_end(std::size_t joint, bool positive) const;
  /// As a unit vector in the part frame.
  [[nodiscard]] Expected<Vector> part_direction(const sdk::JogDirection& direction) const;
  /// The tool tip straight from `from` by so much.
  [[nodiscard]] Move move_by(const ToolPose& from, const Vector& direction, double mm) const;
  /// Refuses a jog towards a limit switch that is on.
  [[nodiscard]] Expected<> check_limit_switches(std::size_t joint, bool positive) const;
  /// How far a move can go from where the machine stands, to where a joint's travel ends or a little before the poses
  /// end; `move_by` makes it so long.
  [[nodiscard]] Expected<double> reach_of(const std::function<Move(double)>& move_by, double most) const;

  const DeviceInForce& device_;
  MotionSupervisor& supervisor_;
  const ServoLink& link_;
  const CamPathSettings& path_;
  const MoveMaker& maker_;
  ToolPlace tool_;
  std::optional<Jog> jog_;  ///< by velocity, begun last
};

}  // namespace rmac::gateway
