#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "rmac/motion/error.hpp"
#include "rmac/motion/follower/path_departure.hpp"
#include "rmac/motion/interruption.hpp"
#include "rmac/motion/path_segment.hpp"
#include "rmac/motion/plan_channel.hpp"
#include "rmac/motion/planner_model.hpp"
#include "rmac/motion/ports/path_gate.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac {

/// What the servo loop tells the planner: read from its snapshot.
struct ServoProgress {
  std::int64_t cycle = 0;           ///< the cycle that is being executed
  std::uint64_t accepted_plan = 0;  ///< `PlanFollower::accepted_plan`
  std::uint64_t last_refused = 0;   ///< `PlanFollower::last_refused`
  PathDeparture departure{};        ///< `PlanFollower::departure`
};

/// A place on the path, within one of the client's moves.
struct PathPlace {
  std::int64_t move_id = 0;
  double s_mm = 0;  ///< along the move
  ToolPose pose;    ///< part frame
  std::vector<double> joints;
};

/// How the machine is to treat its path.
enum class PathCommand {
  Stop,     ///< come to rest on the path as soon as the limits allow, and stay
  RunOne,   ///< run one move, then stop
  Run,      ///< run what is queued, and what comes
  Retrace,  ///< run back what `turn_back` readied, then stay; Run and RunOne go forward again from where that stopped
};

/// The motion planner: path segments in, plans out. One thread at a time (the caller locks); never the servo thread.
class Planner {
 public:
  Planner(PlannerModel model, PlanChannel& channel);
  ~Planner();
  Planner(const Planner&) = delete;
  Planner& operator=(const Planner&) = delete;

  void add(PathSegments segments);
  /// Drops everything that is not yet travelled. Only at rest.
  void clear();
  /// Readies the way back along up to `distance_mm` of what was travelled, for `PathCommand::Retrace`. Its length; 0
  /// when nothing is remembered, which is so after `clear`. Only at rest, where `joints` are: from beside the path
  /// (`off_path`) the way to it comes first, as of `rejoin`. An error leaves everything as it was.
  [[nodiscard]] Expected<double> turn_back(double distance_mm, std::span<const double> joints);
  /// The machine rests at the end of a retrace.
  [[nodiscard]] bool retraced(const ServoProgress& progress) const noexcept;
  /// Joints were braked beside the path (`PathDeparture`): nothing is planned until `rejoin` or `clear`.
  [[nodiscard]] bool off_path() const noexcept;
  /// How far joints that rest beside the path are from where they left it, joint by joint, mm or degrees: the largest.
  [[nodiscard]] double distance_to_path(std::span<const double> joints) const;
  /// Has joints that rest beside the path go back to where they left it, all together on the straight line through the
  /// joints' space at `kRejoinSpeed` of their speeds, as soon as the path is commanded to run; from there it goes on.
  /// An error leaves everything as it was.
  [[nodiscard]] Expected<> rejoin(std::span<const double> joints);
  static constexpr double kRejoinSpeed = 0.1;
  void command(PathCommand command) noexcept;
  /// A step ends early, without a plan, while somebody waits there to command something; what it was about is done by a
  /// later one. Null: nobody does. It must outlive the planner, or be taken away.
  void give_way_to(const Interruption* interruption) noexcept;
  /// The queue's path grows by what passes this gate alone, from now on; null: there is none. With an empty queue, at
  /// rest. A retrace goes over what has passed; the way back to a path that was left is no part of it. It must outlive
  /// the planner, or be taken away.
  void set_gate(PathGate* gate) noexcept;
  /// What is queued is not planned to its end because the gate lets no more through.
  [[nodiscard]] bool blocked() const noexcept;
  /// The last step waited for the gate.
  [[nodiscard]] bool waits_for_gate() const noexcept;
  /// 0 to 200 percent of the programmed feed, from as soon as the limits allow.
  void set_override(double percent) noexcept;

  /// Behind what was added comes something that needs the machine at rest: `Horizon` tells of it.
  void rest_follows(bool follows) noexcept;

  /// Takes note of where the machine is, so that `moves_left` and `farthest_place` tell of then; plans nothing.
  void follow(const ServoProgress& progress);
  /// As `follow`; and does one bounded piece of work if there is any: plans a window, or the way to a stop. True when
  /// it published something.
  bool step(const ServoProgress& progress);
  /// Nothing to do until something is added, commanded, or the servo loop goes on.
  [[nodiscard]] bool idle(const ServoProgress& progress) const noexcept;
  /// The machine has come, or comes, to rest at the end of what is published by this cycle.
  [[nodiscard]] bool at_rest(const ServoProgress& progress) const noexcept;
  /// All that was added is published, and nothing leads elsewhere: a retrace, or a way back to the path. At rest then,
  /// the machine stands where the path ends.
  [[nodiscard]] bool at_end() const noexcept;
  /// Moves added and not yet done.
  [[nodiscard]] std::size_t moves_left() const noexcept;
  /// Lines shorter than half of their tolerance that became part of the one behind them, since the planner was made.
  [[nodiscard]] std::uint64_t lines_merged() const noexcept;
  /// The farthest place that the tool has come to, at rest: where the first move goes on that is not done. Nothing when
  /// none was begun.
  [[nodiscard]] std::optional<PathPlace> farthest_place() const;
  /// Free segments and moves still to come before `add` should wait.
  static constexpr std::size_t kQueueCapacity = 10000;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rmac
