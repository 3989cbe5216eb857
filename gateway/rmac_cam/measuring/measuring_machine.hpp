#pragma once

#include <functional>
#include <optional>

#include "gateway/rmac_cam/cam.hpp"
#include "gateway/rmac_cam/measuring/hit_finder.hpp"
#include "rmac/sdk/measuring.hpp"

namespace rmac::gateway {

/// The measuring part of RMAC_CAM. The motion supervisor stops a search where the probe touches, on its own thread;
/// what follows at rest, the position of the hit and the way back, is done here. Gateway thread only.
class MeasuringMachine final : public sdk::Measuring {
 public:
  /// `assumes_part`: nothing can touch, and every part is where it is looked for: `rmac simulate`.
  MeasuringMachine(MotionSupervisor& supervisor, ServoLink& link, Cam& cam, bool assumes_part);

  /// Everything starts anew with another mechanism; the same one configured anew keeps its settings.
  void mechanism_changed(const sdk::DeviceObject* device, bool fresh);
  /// Every cycle's sample, in order; `tell` hears of hits.
  void read(const CycleSample& sample, const std::function<void(Event)>& tell);
  /// Goes on with what is under way; every few ms.
  void advance();

  Expected<> auto_measure(std::int64_t id, const Vector& point, double speed) override;
  Expected<> manual_measure() override;
  Expected<> spin_probe(double rpm, double seconds) override;
  Expected<> simulate_probe(std::vector<double> joints, bool touching) override;
  Expected<> set_calibrated_part_frame() override;
  Expected<sdk::Hit> last_hit() override;
  [[nodiscard]] bool new_hit() const override { return new_hit_; }
  [[nodiscard]] bool probe_active() const override;
  [[nodiscard]] sdk::ControlMode control_mode() const override;
  Expected<> set_control_mode(sdk::ControlMode mode) override;
  [[nodiscard]] double parameter(sdk::MeasureParameter number) const override;
  Expected<> set_parameter(sdk::MeasureParameter number, double value) override;

 private:
  [[nodiscard]] Expected<> require_probe(const char* function) const;
  [[nodiscard]] Expected<> require_settled_probe(const char* function) const;
  /// Readies the queue's end; where it is, in the part frame.
  [[nodiscard]] Expected<ToolPose> queue_end();
  void take(const HitFinder::Found& found);
  void assume_hit(const CycleSample& sample);

  MotionSupervisor& supervisor_;
  ServoLink& link_;
  Cam& cam_;
  ToolPlace tool_;
  bool assumes_part_;
  const sdk::DeviceObject* device_ = nullptr;
  sdk::Probing settings_;
  sdk::ControlMode mode_ = sdk::ControlMode::AutomaticMove;  ///< asked for; a measurement under way shows beside it

  HitFinder finder_;
  std::optional<sdk::Hit> last_hit_;
  bool new_hit_ = false;
  std::vector<sdk::Hit> untold_;  ///< hits without a sample: simulated ones

  /// The point that is being measured.
  struct Point {
    std::int64_t id = 0;
    Vector from{}, direction{};  ///< part frame; where the approach began, and the way of the search
    double speed = 0;
    double length_mm = 0;  ///< from there to the point
    std::optional<sdk::Hit> hit{};

    /// How far `tip` lies along the way of the search, in mm.
    [[nodiscard]] double way_to(const Vector& tip) const;
  };
  Point point_;
  std::optional<double> spins_until_s_;
};

}  // namespace rmac::gateway
