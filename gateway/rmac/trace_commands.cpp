// The flight records of the appliance: list, make, fetch, draw.
#include <fmt/format.h>

#include "gateway/rmac/commands.hpp"
#include "gateway/rmac/flight_records.hpp"
#include "gateway/rmac/helper_program.hpp"
#include "gateway/rmac/table.hpp"

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

}  // namespace

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

Result<> export_record(Connection& connection, const std::string& name, const std::string& file) {
  const auto chosen = name_or_newest(connection, name);
  if (!chosen) return tl::unexpected(chosen.error());
  const auto text = fetch_flight_record(connection, *chosen);
  if (!text) return tl::unexpected(text.error());
  // The first line says what the record is of; the rest is CSV as other records are.
  const std::string target = file.empty() ? *chosen + ".csv" : file;
  const auto written =
      write_file(target, std::string_view(*text).substr(std::min(text->find('\n'), text->size() - 1) + 1));
  if (written && target != "-") fmt::print("{}\n", target);
  return written;
}

Result<> plot_record(Connection& connection, const std::string& name, const std::string& file) {
  const auto chosen = name_or_newest(connection, name);
  if (!chosen) return tl::unexpected(chosen.error());
  const std::string target = file.empty() ? *chosen + ".png" : file;
  if (auto fine = check_picture(target); !fine) return fine;
  const auto text = fetch_flight_record(connection, *chosen);
  if (!text) return tl::unexpected(text.error());
  const TemporaryFile record;
  if (auto written = write_file(record.path(), *text); !written) return written;
  const auto drawn = run_helper("plot_flight_record.py", {record.path(), target});
  if (!drawn) return tl::unexpected(drawn.error());
  fmt::print("{}\n", target);
  return {};
}

}  // namespace rmac::cli
