#pragma once

#include <cstddef>
#include <vector>

#include "gateway/rmac/simulator/dynamics_watch.hpp"
#include "gateway/rmac/view/plot_tracks.hpp"

namespace rmac::cli {

/// Plots of what a machine's axes do, cycle by cycle: how far the tip is beside its path, what motors give, and how far
/// joints are off their setpoints.
class DynamicsPlots {
 public:
  /// What is in a plot lies so near to it, unless it is too long.
  static constexpr double kWithin = 0.0002;  ///< mm, and degrees
  static constexpr double kWithinOfRated = 0.01;
  static constexpr std::size_t kMostKeys = 30'000;  ///< of a motor or a joint: 0.5 MB of the page

  /// Before the run. Both outlive this, and the axes the run: they tell it of the tip.
  DynamicsPlots(gateway::AxisDynamics& axes, PlotTracks& plots);
  DynamicsPlots(const DynamicsPlots&) = delete;
  DynamicsPlots& operator=(const DynamicsPlots&) = delete;

  /// After the axes have gone through this one.
  void cycle(const gateway::CycleSample& planned);

 private:
  void start_motors();
  void start_joints();

  gateway::AxisDynamics& axes_;
  PlotTracks& plots_;
  std::vector<double> rated_nm_;
  std::size_t first_motor_ = 0, first_joint_ = 0;  ///< of the plots
  bool over_ = false;                              ///< a fault stopped the machine
};

}  // namespace rmac::cli
