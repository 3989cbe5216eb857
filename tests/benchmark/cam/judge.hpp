#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "../motion/drive.hpp"
#include "../motion/limit_check.hpp"
#include "program.hpp"

namespace rmac::bench {

/// Runs what is queued on its drive, from rest to rest, and sees what the machine does meanwhile.
class Judge {
 public:
  Judge(const PlannerModel& model, const std::vector<double>& start_joints);

  /// The message where it never ends. The deviation is for others to tell, who see the joints.
  [[nodiscard]] tl::expected<Machined, std::string> run();

  Drive drive;
  /// Called with the joints of every cycle in motion.
  std::function<void(std::span<const double>)> on_joints;

 private:
  static constexpr std::int64_t kMostCycles = 3'000'000;
  LimitCheck check_;
  double period_s_;
  std::size_t joint_count_;
  std::int64_t cycles_ = 0;
  bool moving_ = false;
  int stops_ = 0;
};

}  // namespace rmac::bench
