#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "gateway/rmac/simulator/collision_watch.hpp"
#include "gateway/rmac/simulator/cycle_listener.hpp"
#include "gateway/rmac/simulator/shaped_machine.hpp"
#include "gateway/rmac/view/drawn_bodies.hpp"
#include "gateway/rmac/view/link_tracks.hpp"
#include "gateway/rmac/view/step_track.hpp"
#include "gateway/rmac/view/stock_frames.hpp"
#include "gateway/rmac/view/thinned_track.hpp"

namespace rmac::cli {

/// Keeps what a page shows of a simulated program, from its first motion on: sixty looks a second, of which those stay
/// that are needed.
class Film : public CycleListener {
 public:
  static constexpr double kLooks_per_s = 60;

  /// `watch` may be null; what there is lives as long as this.
  Film(const ShapedMachine& machine, const CollisionWatch* watch, DrawnBodies drawn);

  void cycle(const gateway::CycleSample& sample, const Now& now) override;
  void tool_may_have_changed() noexcept override { look_at_tool_ = true; }
  /// The run is over.
  void end();

  /// The program moved nothing of the machine.
  [[nodiscard]] bool empty() const noexcept { return !begun_; }
  [[nodiscard]] double within_mm() const noexcept { return links_.within_mm(); }
  /// Of a run that is over: all that was kept, with the bodies that it moves.
  [[nodiscard]] nlohmann::json to_json() const;

 private:
  static constexpr std::size_t kMostOfPlot = 100'000, kMostSteps = 200'000;
  enum Plot : std::size_t { Feed, Spindle, Force, Torque, Power };
  struct Plotted {
    ThinnedTrack<double, NumberWay> track;
    bool any = false;  ///< it was not 0 all the time
  };

  void look(double t_s, const gateway::CycleSample& sample, const Now& now);
  void take_tool(double t_s, gateway::Controller& controller);
  void plot(Plot which, double t_s, double value);

  const ShapedMachine& machine_;
  const CollisionWatch* watch_;
  DrawnBodies drawn_;
  LinkTracks links_;
  StockFrames stocks_;
  std::vector<Plotted> plots_;
  StepTrack lines_{kMostSteps}, limits_{kMostSteps}, tool_at_{kMostSteps};
  std::vector<std::string> limit_names_;
  nlohmann::json tools_ = nlohmann::json::array();
  std::vector<std::string> tools_known_;  ///< the same, as text
  std::set<std::string> not_shown_;
  bool begun_ = false, look_at_tool_ = true;
  std::vector<double> joints_;  ///< of the last cycle
  double now_s_ = 0;            ///< likewise
  double from_s_ = 0, to_s_ = 0, next_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace rmac::cli
