#pragma once

#include <span>

#include "gateway/controller/controller.hpp"
#include "gateway/simulation/motion_account.hpp"
#include "gateway/state/cycle_sample.hpp"

namespace rmac::cli {

/// Hears of every cycle of a simulated program, after the collision watch has.
class CycleListener {
 public:
  /// As it is once the cycle is over.
  struct Now {
    int line = 0;                    ///< of the program
    std::span<const double> joints;  ///< where they truly are; where nobody asked that, where they are to be
    const gateway::MotionAccount& account;
    gateway::Controller& controller;
  };
  virtual ~CycleListener() = default;
  virtual void cycle(const gateway::CycleSample& planned, const Now& now) = 0;
  /// The tool in the spindle, its number and what the table says of it, may be another.
  virtual void tool_may_have_changed() noexcept = 0;
};

}  // namespace rmac::cli
