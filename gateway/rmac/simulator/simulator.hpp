#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gateway/rmac/program/program.hpp"
#include "gateway/rmac/program/record.hpp"
#include "gateway/rmac/program/request_order.hpp"
#include "gateway/rmac/program/unfinished_moves.hpp"
#include "gateway/rmac/simulator/collision_watch.hpp"
#include "gateway/rmac/simulator/cycle_listener.hpp"
#include "gateway/rmac/simulator/dynamics_watch.hpp"
#include "gateway/simulation/motion_account.hpp"
#include "gateway/simulation/simulation.hpp"

namespace rmac::cli {

/// The limit that ruled a move for the longest time, as MotionAccount names it; empty where it did not move.
struct MoveLimit {
  std::int64_t move_id = 0;
  std::string limit;
};

struct SimulationReport {
  std::size_t moves = 0;
  std::size_t tool_changes = 0;  ///< a person takes no time here, nor at a stop
  double cycle_time_s = 0;       ///< from the first move's start to the last one's end, as `rmac run` counts it
  double length_mm = 0;
  std::vector<gateway::MotionAccount::Joint> joints;
  std::vector<gateway::MotionAccount::Share> limited_by;
  std::vector<MoveLimit> move_limits;  ///< in the order in which moves were done
  std::size_t record_rows = 0;
  std::vector<std::string> record_files;
};

/// Plans one program on a simulated appliance as `rmac run` would have it machined: moves are queued as far as the
/// queue has room, and what acts on the machine waits until all before it is done.
class Simulator {
 public:
  /// `record_file`: of the setpoints; empty: none. The others outlive the simulator.
  Simulator(gateway::Simulation& simulation, const Program& program, const std::string& record_file);

  /// Has every cycle watched for collisions, from before `run` on; the watch outlives the simulator. With `first` the
  /// run ends at the first that is certain, and what it reports is of the way to there.
  void watch_collisions(CollisionWatch& watch, bool first) noexcept { watch_ = &watch, ends_at_first_ = first; }

  /// Has the axes go as the machine's do, from before `run` on; what is watched is then where they truly are. The run
  /// ends where the machine stops, and with `first` where it leaves its path. `dynamics` outlives the simulator.
  void go_by(DynamicsWatch& dynamics, bool first) noexcept { dynamics_ = &dynamics, ends_off_path_ = first; }

  /// Tells of every cycle, from before `run` on; the listener outlives the simulator.
  void listen(CycleListener& listener) noexcept { listener_ = &listener; }

  /// Once. An error names the program's line.
  [[nodiscard]] Result<SimulationReport> run();

 private:
  [[nodiscard]] Result<> play();
  [[nodiscard]] Result<> submit(const Request& request);
  [[nodiscard]] Result<> make_room(const Request& request);
  [[nodiscard]] Result<> start_cycle_of_moves();
  [[nodiscard]] Result<> settle();
  /// Lets machine time go on until `reached`; an error when nothing moves any more before it is.
  [[nodiscard]] Result<> run_until(const std::function<bool()>& reached);
  [[nodiscard]] Result<> call(const std::string& method, nlohmann::json params);
  /// By what the axes do.
  [[nodiscard]] bool ends_early() const;
  [[nodiscard]] bool at_rest();
  [[nodiscard]] bool dwells();
  [[nodiscard]] std::string stuck();
  [[nodiscard]] tl::unexpected<Failure> fail_at(int line, const std::string& message) const;

  void take(const gateway::CycleSample& sample);
  void take(const gateway::Event& event);
  void tool_may_have_changed();

  gateway::Simulation& simulation_;
  const Program& program_;
  gateway::MotionAccount account_;
  std::vector<MoveLimit> move_limits_;
  std::optional<Record> record_;
  RequestOrder order_;
  UnfinishedMoves moves_;
  int line_ = 0;  ///< of the request under way
  std::string failure_;
  CollisionWatch* watch_ = nullptr;
  DynamicsWatch* dynamics_ = nullptr;
  CycleListener* listener_ = nullptr;
  bool ends_at_first_ = false, ends_off_path_ = false, ended_ = false;
  bool moving_ = false;
  bool tool_asked_for_ = false;
  bool stopped_ = false;  ///< at a stop of the program
};

}  // namespace rmac::cli
