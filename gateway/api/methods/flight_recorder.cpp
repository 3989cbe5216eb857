// Methods of the flight recorder: the last seconds of every servo cycle, as files.
#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"

namespace rmac::gateway {

void add_flight_recorder_methods(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  add(method("FlightRecorder.Record",
             "Has the last seconds of every servo cycle written to a file, and gives its name. An event tells "
             "when it is there (FlightRecord), or why not (FlightRecordFailed).")
          .gives(WireType::String)
          .extension()
          .does([](Call& call) { return call.machine.record_flight(); }));
  add(method("FlightRecorder.List",
             "The flight records that there are, as `records`, oldest first; of each `name`, `cause` (fault, demand), "
             "`message`, `cycle`, `t_s`, `utc`, `mechanism`, `joints`, `first_cycle`, `last_cycle`, `bytes`.")
          .gives(WireType::Object)
          .extension()
          .does([](Call& call) {
            const FlightFolder* folder = call.machine.flight_records();
            return nlohmann::json{{"records", folder == nullptr ? nlohmann::json::array() : folder->list()}};
          }));
  add(method("FlightRecorder.Read",
             "A part of a flight record's text: `text`, `next_offset` to go on with (null at the end), and `bytes`, "
             "the size of the whole. The first line is a JSON object, the rest CSV.")
          .takes(text("Name"), integer("Offset", "bytes").at_least(0).optional().noted("0 when left out"))
          .gives(WireType::Object)
          .extension()
          .does(
              [](Call& call, const std::string& name, std::optional<std::int64_t> offset) -> Expected<nlohmann::json> {
                const FlightFolder* folder = call.machine.flight_records();
                if (folder == nullptr) {
                  return failure(MinorCode::Other,
                                 "no flight records are made; give flight_recorder seconds above 0 in rmacd.json");
                }
                return folder->read(name, offset.value_or(0));
              }));
}

}  // namespace rmac::gateway
