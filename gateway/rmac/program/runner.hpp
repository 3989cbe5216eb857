#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gateway/rmac/program/joint_watch.hpp"
#include "gateway/rmac/program/open_ends.hpp"
#include "gateway/rmac/program/program.hpp"
#include "gateway/rmac/program/prompt.hpp"
#include "gateway/rmac/program/request_order.hpp"
#include "gateway/rmac/program/unfinished_moves.hpp"
#include "gateway/rmac/terminal/progress.hpp"
#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/notes.hpp"

namespace rmac::cli {

struct RunOptions {
  std::string record_file;  ///< empty: none
  bool virtual_mode = false;
  std::string machine;  ///< loaded before the program; empty: what is loaded
  bool show_progress = false;
  std::function<void(const JointSample&)> on_cycle{};  ///< hears every cycle from the first that moves on
  nlohmann::json learned{};                            ///< of the program, as the appliance takes it; null: nothing
  std::optional<int> terminal;  ///< descriptor that a person's lines come from; none: nobody is there
};

struct RunReport {
  std::size_t requests = 0, moves = 0;
  double cycle_time_s = 0;  ///< the machine's clock, from the first move's start to the last one's end
  double wall_time_s = 0;
  std::vector<double> following_error;  ///< largest seen of each joint, mm or deg
  bool every_cycle_seen = false;        ///< false: the largest of samples, not of all cycles
  std::size_t record_rows = 0;
  std::vector<std::string> record_files;
};

/// Machines one program: streams its requests, keeps as many in flight as the appliance can queue, and waits until the
/// last move is done. Holds motion authority meanwhile. It listens to the connection for as long as it lives.
class Runner {
 public:
  /// All outlive the runner.
  Runner(Connection& connection, const Program& program, RunOptions options);
  ~Runner();
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  /// Once. An error of a request names the program's line.
  [[nodiscard]] Result<RunReport> run();

 private:
  [[nodiscard]] Result<> prepare();
  [[nodiscard]] Result<> acquire();
  /// Loads the machine that the options name, or in virtual mode the one that is loaded.
  [[nodiscard]] Result<> load();
  [[nodiscard]] Result<> teach();
  [[nodiscard]] Result<> stream();
  [[nodiscard]] Result<> submit(const Request& request);
  void send(const Request& request, nlohmann::json params, const OpenEnds::Reach& reach);
  [[nodiscard]] Result<> start_cycle_of_moves();
  [[nodiscard]] Result<> settle();
  /// Waits until all that was sent is answered and all moves are done.
  [[nodiscard]] Result<> wait_for_moves();
  /// Asks the machine itself: home and jog have no MoveID.
  [[nodiscard]] Result<> rest();
  [[nodiscard]] Result<> wait(const std::function<bool()>& done);
  [[nodiscard]] Result<> explain_rest();
  void halt();
  [[nodiscard]] Result<> finish(Result<> done);
  [[nodiscard]] RunReport report(double wall_time_s) const;

  void take(const std::string& topic, const nlohmann::json& params);
  void take(const EventNote& event);
  void fail_with(const std::string& message);

  Connection& connection_;
  const Program& program_;
  RunOptions options_;
  Progress progress_;
  RequestOrder order_;
  UnfinishedMoves moves_;
  OpenEnds ends_;
  Prompt prompt_;
  JointWatch joints_;

  std::size_t window_ = 1;       ///< requests without an answer at one time
  std::size_t queue_bound_ = 0;  ///< moves not done at one time; what the appliance's queue holds
  std::size_t unanswered_ = 0;
  std::string failure_;
  std::chrono::milliseconds renew_every_ = std::chrono::hours(1);  ///< so that waiting is not taken for hanging
  bool leased_ = false;                                            ///< this client holds motion authority
  bool rest_told_ = false;                                         ///< the machine came to rest with moves not done
};

}  // namespace rmac::cli
