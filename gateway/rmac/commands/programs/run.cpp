#include <fmt/format.h>
#include <unistd.h>

#include "gateway/rmac/commands/programs/learn.hpp"
#include "gateway/rmac/commands/programs/registrations.hpp"
#include "gateway/rmac/commands/programs/source.hpp"
#include "gateway/rmac/program/runner.hpp"
#include "gateway/rmac/terminal/table.hpp"

namespace rmac::cli {

namespace {

struct RunCommand {
  Source source;
  RunOptions run;
  LearnOptions learn;
};

void print_run_json(const RunReport& report) {
  const nlohmann::json line{{"ok", true},
                            {"requests", report.requests},
                            {"moves", report.moves},
                            {"cycle_time_s", report.cycle_time_s},
                            {"wall_time_s", report.wall_time_s},
                            {"following_error", report.following_error},
                            {"following_error_of_every_cycle", report.every_cycle_seen},
                            {"record_rows", report.record_rows},
                            {"record_files", report.record_files}};
  fmt::print("{}\n", line.dump());
}

void print_run_table(const RunReport& report) {
  std::vector<std::vector<std::string>> rows{{"requests", std::to_string(report.requests), ""},
                                             {"moves", std::to_string(report.moves), ""},
                                             {"cycle time", number(report.cycle_time_s), "s"},
                                             {"took", number(report.wall_time_s), "s"}};
  const std::string of = report.every_cycle_seen ? "" : ", of samples";
  for (std::size_t joint = 0; joint < report.following_error.size(); ++joint) {
    rows.push_back(
        {fmt::format("following error, joint {}", joint), number(report.following_error[joint], 6), "mm or deg" + of});
  }
  for (const auto& record : report.record_files) {
    rows.push_back({"record", record, fmt::format("{} rows in all", report.record_rows)});
  }
  fmt::print("{}", table({"", "", ""}, rows));
}

Result<> run_program(Connection& connection, const RunCommand& options, bool json) {
  const auto program = read_source(options.source);
  if (!program) return tl::unexpected(program.error());
  RunOptions run = options.run;
  run.show_progress = !json && isatty(STDERR_FILENO) == 1;
  if (isatty(STDIN_FILENO) == 1) run.terminal = STDIN_FILENO;
  if (options.learn.passes > 0) return learn_program(connection, *program, run, options.learn, json);
  if (options.learn.use) {
    auto learned = learned_of(*program, options.learn);
    if (!learned) return tl::unexpected(learned.error());
    run.learned = std::move(*learned);
  }
  const auto report = Runner(connection, *program, run).run();
  if (!report) return tl::unexpected(report.error());
  (json ? print_run_json : print_run_table)(*report);
  return {};
}

}  // namespace

void add_run(Command& rmac) {
  const auto options = std::make_shared<RunCommand>();
  Command run = rmac.add("run",
                         "machine a program, one JSON-RPC request a line; at the terminal, h holds, 50% sets the feed "
                         "override; when held, Enter goes on, a distance in mm runs back, p parks it");
  declare_source(run, options->source);
  run.flag("--virtual", &options->run.virtual_mode, "in virtual mode: drives stay untouched");
  run.option("--record", &options->run.record_file, "write every cycle's setpoints and measured joints to this CSV");
  run.option("--machine", &options->run.machine, "load this machine first");
  run.option("--learn", &options->learn.passes,
             "run it so many times, learn from each pass for the next one what the joints do wrong, and write that "
             "beside the program")
      .within(2, 100)
      .excludes({"--virtual", "--record"});
  run.option("--bandwidth", &options->learn.bandwidth_hz,
             "Hz up to which --learn learns: from half the bandwidth of the slowest servo loop to all of it; what a "
             "loop does wrong faster stays")
      .within(1.0, 200.0)
      .shows_default();
  run.flag("--learned", &options->learn.use, "make good what was learned of this program, with this machine")
      .excludes({"--learn", "--virtual"});
  run.option("--offsets", &options->learn.file,
             "where that is written to, and read from; the program's name with .learned behind it unless given");
  run.does(
      with_appliance([options](Connection& appliance, bool json) { return run_program(appliance, *options, json); }));
}

}  // namespace rmac::cli
