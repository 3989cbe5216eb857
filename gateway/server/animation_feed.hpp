#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/animation/machine_drawing.hpp"
#include "gateway/server/telemetry.hpp"
#include "gateway/state/cycle_sample.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::gateway {

/// What an animation shows beside the samples: the machine as it is now.
struct Scene {
  std::shared_ptr<const MachineDrawing> drawing;
  bool virtual_mode = false;
  std::optional<int> tool{};  ///< none: not known
  Frames frames{};            ///< in force
};

/// The topic `animation` of one connection: its pace, and what was collected for the next notifications. Poses are
/// computed here, and only of samples that are due.
class AnimationFeed {
 public:
  using Look = std::function<Scene()>;

  explicit AnimationFeed(Look look) : look_(std::move(look)) {}

  [[nodiscard]] TopicPace& pace() noexcept { return pace_; }
  [[nodiscard]] const TopicPace& pace() const noexcept { return pace_; }
  /// From the first sample after cycle `since` on; what is missing of the machine is told anew.
  void start(double every_cycles, std::int64_t since) noexcept;

  void take(const CycleSample& sample);
  [[nodiscard]] std::size_t bytes() const noexcept { return samples_.size(); }
  /// Moves what was collected out, a line a notification.
  void take_out(std::vector<std::string>& lines);

 private:
  /// Ends the notification that is being collected.
  void close();

  Look look_;
  TopicPace pace_;
  std::string head_, samples_;      ///< of the notification that is being collected
  std::vector<std::string> lines_;  ///< whole ones
  std::int64_t told_ = -1;          ///< number of the machine of which there is nothing but what is missing to tell
};

}  // namespace rmac::gateway
