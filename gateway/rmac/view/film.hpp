#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "gateway/rmac/simulator/collision_watch.hpp"
#include "gateway/rmac/simulator/cycle_listener.hpp"
#include "gateway/rmac/simulator/shaped_machine.hpp"
#include "gateway/rmac/view/drawn_bodies.hpp"
#include "gateway/rmac/view/dynamics_plots.hpp"
#include "gateway/rmac/view/link_tracks.hpp"
#include "gateway/rmac/view/plot_tracks.hpp"
#include "gateway/rmac/view/step_track.hpp"
#include "gateway/rmac/view/stock_frames.hpp"

namespace rmac::cli {

/// Keeps what a page shows of a simulated program, from its first motion on: sixty looks a second, and each cycle of
/// what axes do, of which those stay that are needed.
class Film : public CycleListener {
 public:
  static constexpr double kLooks_per_s = 60;

  /// `watch` and `axes` may be null; what there is lives as long as this, and the axes tell it of their tip.
  Film(const ShapedMachine& machine, const CollisionWatch* watch, gateway::AxisDynamics* axes, DrawnBodies drawn);

  void cycle(const gateway::CycleSample& planned, const Now& now) override;
  void tool_may_have_changed() noexcept override { look_at_tool_ = true; }
  /// The run is over.
  void end();

  /// The program moved nothing of the machine.
  [[nodiscard]] bool empty() const noexcept { return !begun_; }
  [[nodiscard]] double within_mm() const noexcept { return links_.within_mm(); }
  /// Of a run that is over: all that was kept, with the bodies that it moves.
  [[nodiscard]] nlohmann::json to_json() const;

 private:
  static constexpr std::size_t kMostSteps = 200'000;
  enum Plot : std::size_t { Feed, Spindle, Force, Torque, Power };

  void look(double t_s, const gateway::CycleSample& planned, const Now& now);
  void take_tool(double t_s, gateway::Controller& controller);

  const ShapedMachine& machine_;
  const CollisionWatch* watch_;
  DrawnBodies drawn_;
  LinkTracks links_;
  StockFrames stocks_;
  PlotTracks plots_;
  std::optional<DynamicsPlots> dynamics_;  ///< its plots are among those
  StepTrack lines_{kMostSteps};
  NamedSteps limits_{kMostSteps}, tools_{kMostSteps};  ///< tools as JSON
  std::set<std::string> not_shown_;
  bool begun_ = false, look_at_tool_ = true;
  std::vector<double> joints_;  ///< of the last cycle, where they truly were
  double now_s_ = 0;            ///< likewise
  double from_s_ = 0, to_s_ = 0, next_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace rmac::cli
