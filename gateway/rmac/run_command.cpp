#include <fmt/format.h>
#include <unistd.h>

#include "gateway/rmac/commands.hpp"
#include "gateway/rmac/program.hpp"
#include "gateway/rmac/table.hpp"

namespace rmac::cli {

Result<> run_program(Connection& connection, const std::string& file, const RunOptions& options, bool json) {
  const auto program = read_program(file);
  if (!program) {
    return tl::unexpected(program.error());
  }
  auto shown = options;
  shown.show_progress = !json && isatty(STDERR_FILENO) == 1;
  Runner runner(connection, shown);
  const auto report = runner.run(*program);
  connection.on_notification({});
  connection.on_entered_line({});
  if (!report) {
    return tl::unexpected(report.error());
  }
  if (json) {
    const nlohmann::json line{{"ok", true},
                              {"requests", report->requests},
                              {"moves", report->moves},
                              {"cycle_time_s", report->cycle_time_s},
                              {"wall_time_s", report->wall_time_s},
                              {"following_error", report->following_error},
                              {"following_error_of_every_cycle", report->every_cycle_seen},
                              {"record_rows", report->record_rows},
                              {"record_files", report->record_files}};
    fmt::print("{}\n", line.dump());
    return {};
  }
  std::vector<std::vector<std::string>> rows{{"requests", std::to_string(report->requests), ""},
                                             {"moves", std::to_string(report->moves), ""},
                                             {"cycle time", number(report->cycle_time_s), "s"},
                                             {"took", number(report->wall_time_s), "s"}};
  const std::string of = report->every_cycle_seen ? "" : ", of samples";
  for (std::size_t joint = 0; joint < report->following_error.size(); ++joint) {
    rows.push_back(
        {fmt::format("following error, joint {}", joint), number(report->following_error[joint], 6), "mm or deg" + of});
  }
  for (const auto& record : report->record_files) {
    rows.push_back({"record", record, fmt::format("{} rows in all", report->record_rows)});
  }
  fmt::print("{}", table({"", "", ""}, rows));
  return {};
}

}  // namespace rmac::cli
