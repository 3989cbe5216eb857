#include "gateway/simulators/vmodbus/device.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "gateway/buses/register_map_file.hpp"

namespace rmac::vmodbus {

Bytes Device::answer(std::span<const std::uint8_t> request) {
  unasked_s = 0;
  if (manners.busy && !request.empty()) return exception_answer(request[0], Exception::DeviceBusy);
  std::vector<Tables::Write> writes;
  Bytes answered = tables_.answer(request, writes);
  for (const Tables::Write& write : writes) take(write);
  if (!writes.empty()) show();
  return answered;
}

Expected<std::unique_ptr<Device>> make_device(const std::string& map_file, const SpindleOptions& options) {
  std::ifstream text(map_file);
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const bool io = json.is_object() && json.value("Kind", nlohmann::json()) == "RemoteIO";
  if (io) return gateway::read_io_map(map_file).map([](auto map) { return make_remote_io(std::move(map)); });
  return gateway::read_spindle_map(map_file).map([&](auto map) { return make_spindle(std::move(map), options); });
}

}  // namespace rmac::vmodbus
