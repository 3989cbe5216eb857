#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gateway/record/flight_recorder.hpp"
#include "gateway/state/event.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// Has flight records made of what happens, and makes events of what became of them. Gateway thread.
class FlightReporter {
 public:
  /// `buses_now` tells what a record keeps of them (`FlightHead::buses`); none: nothing.
  FlightReporter(const FlightRecorderOptions& options, double period_s, CycleHistory& history,
                 std::function<nlohmann::json()> buses_now = nullptr);

  /// Has the cycles up to that of `event` written; the name of the record. `device`: the mechanism that they are of, or
  /// nullptr. Refused where no records are made.
  [[nodiscard]] Expected<std::string> record(FlightCause cause, const Event& event, const sdk::DeviceObject* device);
  /// Records a fault, and adds the record's name to its event, or why there is none.
  void annotate(Event& event, const sdk::DeviceObject* device);
  /// An event for each record that was written, or could not be, since the last call.
  [[nodiscard]] std::vector<Event> take_events();
  /// The records that there are; nullptr where none are made.
  [[nodiscard]] const FlightFolder* folder() const noexcept { return recorder_ ? &recorder_->folder() : nullptr; }

 private:
  std::function<nlohmann::json()> buses_now_;
  std::unique_ptr<FlightRecorder> recorder_;  ///< none where none is wanted
};

}  // namespace rmac::gateway
