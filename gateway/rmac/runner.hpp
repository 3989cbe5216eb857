#pragma once

#include <chrono>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "gateway/rmac/connection.hpp"
#include "gateway/rmac/notes.hpp"
#include "gateway/rmac/program.hpp"
#include "gateway/rmac/progress.hpp"
#include "gateway/rmac/record.hpp"

namespace rmac::cli {

struct RunOptions {
  std::string record_file;  ///< empty: none
  bool virtual_mode = false;
  std::string machine;  ///< loaded before the program; empty: what is loaded
  bool show_progress = false;
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
/// last move is done. Holds motion authority meanwhile.
class Runner {
 public:
  Runner(Connection& connection, RunOptions options);

  [[nodiscard]] Result<RunReport> run(const Program& program);

 private:
  [[nodiscard]] Result<> prepare(const Program& program);
  [[nodiscard]] Result<> stream(const Program& program);
  [[nodiscard]] Result<> submit(const Program& program, const Request& request);
  [[nodiscard]] Result<> before_move(const Program& program);
  [[nodiscard]] Result<> start_cycle();
  [[nodiscard]] Result<> settle();
  [[nodiscard]] Result<> rest();
  [[nodiscard]] Result<> watch_joints();
  [[nodiscard]] Result<> wait(const std::function<bool()>& done);
  [[nodiscard]] Result<> explain_rest();
  void halt();
  /// A line from the terminal: nothing goes on after a hold, a number of mm runs back along the path, p parks.
  void obey(const std::string& line);
  /// Sets the program aside, and gives the machine free for others.
  void park();
  void take_up();

  void take(const std::string& topic, const nlohmann::json& params);
  void take(const EventNote& event);
  void take(const JointSample& sample);
  void fail_with(const std::string& message);

  Connection& connection_;
  RunOptions options_;
  Progress progress_;
  std::string note_;  ///< what was wrong with the last line from the terminal
  std::optional<Record> record_;
  RunReport report_;

  std::size_t window_ = 1;       ///< requests without an answer at one time
  std::size_t queue_bound_ = 0;  ///< moves not done at one time; what the appliance's queue holds
  std::size_t unanswered_ = 0;
  /// Ids of moves sent and not done, in order; none stands for a tool change.
  std::deque<std::optional<std::int64_t>> unfinished_;
  std::optional<double> first_start_s_;
  std::optional<StateNote> state_;
  std::string failure_;
  std::size_t total_moves_ = 0;
  double last_done_s_ = 0, last_sample_s_ = 0;
  std::chrono::milliseconds renew_every_ = std::chrono::hours(1);  ///< so that waiting is not taken for hanging
  bool leased_ = false;                                            ///< this client holds motion authority
  bool parked_ = false;                                            ///< nothing is sent meanwhile
  bool started_ = false;    ///< the program's cycle was started, so moves become done
  bool unsettled_ = true;   ///< something acted on the machine since the last move: its rest must be looked at
  bool measuring_ = false;  ///< the last request measures a point
  bool watching_ = false;
  bool rest_told_ = false;  ///< the machine came to rest with moves not done
};

}  // namespace rmac::cli
