#include "gateway/rmac/commands/commission/experiment.hpp"

#include <fmt/format.h>

#include "gateway/rmac/records/flight_records.hpp"
#include "gateway/rmac/wire/authority.hpp"
#include "gateway/rmac/wire/fault_watch.hpp"
#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

Result<> commission(Connection& connection, const std::function<Result<>(const std::string& fault)>& work) {
  FaultWatch faults(connection, FaultWatch::HearsOf::Faults);
  return with_authority(connection, [&]() -> Result<> {
    const auto begin = ask_state(connection);
    if (!begin) return tl::unexpected(begin.error());
    if (begin->faulted())
      return fail("the machine is faulted; remove the cause, then reset: " + begin->last_stop.message);
    if (auto heard = faults.begin(); !heard) return heard;
    auto worked = work(faults.failure());
    if (worked) return worked;
    static_cast<void>(stop_now(connection));
    // What stopped the machine says more than what it then refused.
    const auto state = ask_state(connection);
    const bool stopped = state && state->faulted() && !state->last_stop.message.empty();
    return stopped ? fail(state->last_stop.message) : worked;
  });
}

Result<> keep_record(Connection& connection, const TemporaryFile& file) {
  const auto made = record_flight(connection);
  if (!made) return tl::unexpected(made.error());
  const auto text = fetch_flight_record(connection, made->record);
  return text ? write_file(file.path(), *text) : tl::unexpected(text.error());
}

Result<nlohmann::json> plot_answer(const std::string& program, const std::vector<std::string>& arguments) {
  const auto printed = run_plot(program, arguments);
  if (!printed) return tl::unexpected(printed.error());
  auto answer = nlohmann::json::parse(*printed, nullptr, false);
  if (answer.is_discarded()) return fail(program + ": it printed no JSON");
  return answer;
}

std::string list_text(const nlohmann::json& numbers) {
  std::string text;
  for (const auto& number : numbers) text += fmt::format("{}{:.5g}", text.empty() ? "" : ", ", number.get<double>());
  return "[" + text + "]";
}

}  // namespace rmac::cli
