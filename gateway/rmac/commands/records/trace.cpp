#include <fmt/format.h>

#include "gateway/rmac/commands/records/registrations.hpp"
#include "gateway/rmac/plots/plot_program.hpp"
#include "gateway/rmac/records/flight_records.hpp"
#include "gateway/rmac/terminal/table.hpp"

namespace rmac::cli {

namespace {

Result<nlohmann::json> records_of(Connection& connection) {
  auto answer = connection.call("FlightRecorder.List");
  if (!answer) return tl::unexpected(answer.error());
  return answer->value("records", nlohmann::json::array());
}

Result<std::string> name_or_newest(Connection& connection, const std::string& name) {
  if (!name.empty()) return name;
  auto records = records_of(connection);
  if (!records) return tl::unexpected(records.error());
  if (records->empty()) {
    return fail("there is no flight record yet; a fault makes one, and so does `rmac trace record`");
  }
  return records->back().value("name", "");
}

Result<> list_records(Connection& connection, bool json) {
  auto records = records_of(connection);
  if (!records) return tl::unexpected(records.error());
  if (json) {
    fmt::print("{}\n", records->dump());
    return {};
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& record : *records) {
    rows.push_back({record.value("name", ""), record.value("mechanism", ""),
                    std::to_string(record.value("cycle", std::int64_t{0})), record.value("message", "")});
  }
  if (rows.empty()) {
    fmt::print("no flight records\n");
    return {};
  }
  fmt::print("{}", table({"name", "machine", "cycle", "what happened"}, rows));
  return {};
}

Result<> make_record(Connection& connection, bool json) {
  const auto made = record_flight(connection);
  if (!made) return tl::unexpected(made.error());
  fmt::print("{}\n", json ? nlohmann::json{{"name", made->record}}.dump() : made->message);
  return {};
}

struct Options {
  std::string name;  ///< empty: the newest one
  std::string file;  ///< empty: named after the record, in this folder
};

/// Writes a record's cycles; `-` is standard output.
Result<> export_record(Connection& connection, const Options& options) {
  const auto chosen = name_or_newest(connection, options.name);
  if (!chosen) return tl::unexpected(chosen.error());
  const auto text = fetch_flight_record(connection, *chosen);
  if (!text) return tl::unexpected(text.error());
  // The first line says what the record is of; the rest is CSV as other records are.
  const std::string target = options.file.empty() ? *chosen + ".csv" : options.file;
  const auto written =
      write_file(target, std::string_view(*text).substr(std::min(text->find('\n'), text->size() - 1) + 1));
  if (written && target != "-") fmt::print("{}\n", target);
  return written;
}

Result<> plot_record(Connection& connection, const Options& options) {
  const auto chosen = name_or_newest(connection, options.name);
  if (!chosen) return tl::unexpected(chosen.error());
  const std::string target = options.file.empty() ? *chosen + ".png" : options.file;
  if (auto fine = check_picture(target); !fine) return fine;
  const auto text = fetch_flight_record(connection, *chosen);
  if (!text) return tl::unexpected(text.error());
  const TemporaryFile record;
  if (auto written = write_file(record.path(), *text); !written) return written;
  const auto drawn = run_plot("plot_flight_record.py", {record.path(), target});
  if (!drawn) return tl::unexpected(drawn.error());
  fmt::print("{}\n", target);
  return {};
}

void add_list(Command& trace) {
  Command list = trace.add("list", "the records that there are, oldest first; what `rmac trace` alone does");
  list.does(with_appliance(list_records));
}

void add_record(Command& trace) {
  Command record = trace.add("record", "have the last seconds written now, and wait for it");
  record.does(with_appliance(make_record));
}

void add(Command& trace, const char* name, const char* meaning, Result<> (*work)(Connection&, const Options&)) {
  const auto options = std::make_shared<Options>();
  Command command = trace.add(name, meaning);
  command.option("NAME", &options->name, "as `rmac trace list` shows it; the newest one unless given");
  command.option("-o,--output", &options->file, "the file to write; NAME.csv or NAME.png here unless given");
  command.does(with_appliance([options, work](Connection& appliance, bool) { return work(appliance, *options); }));
}

}  // namespace

void add_trace(Command& rmac) {
  Command trace = rmac.add("trace", "the flight records: what every cycle did before a fault, or up to now");
  trace.may_have_command();
  trace.does(with_appliance(list_records));
  for (const Registration add_one : {add_list, add_record}) add_one(trace);
  add(trace, "export", "write a record as CSV, one row a cycle", export_record);
  add(trace, "plot", "draw a record; needs python3-matplotlib", plot_record);
}

}  // namespace rmac::cli
