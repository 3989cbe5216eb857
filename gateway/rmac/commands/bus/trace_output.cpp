#include "gateway/rmac/commands/bus/trace_output.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/rmac/commands/bus/machine_bus.hpp"

namespace rmac::cli {
namespace {

using fieldbus::CanFrame;
using fieldbus::LoggedFrame;
using fieldbus::canopen::DecodedFrame;
using fieldbus::canopen::DecodedValue;
using fieldbus::canopen::FrameDecoder;
using fieldbus::canopen::FrameKind;

nlohmann::json decoded_json(const DecodedValue& value) {
  nlohmann::json told{{"index", value.object.index}, {"sub", value.object.sub}, {"text", value.text}};
  std::visit([&](const auto& held) { told["value"] = held; }, value.value);
  if (!value.name.empty()) told["name"] = value.name;
  return told;
}

nlohmann::json decoded_json(const LoggedFrame& logged, const DecodedFrame& decoded) {
  const CanFrame& frame = logged.frame;
  nlohmann::json told{{"time", std::chrono::duration<double>(frame.stamp).count()},
                      {"interface", logged.interface},
                      {"kind", to_text(decoded.kind)},
                      {"text", decoded.text}};
  if (logged.kind == LoggedFrame::Kind::Data) {
    told["id"] = frame.id;
    told["data"] = std::vector<std::uint8_t>(frame.data.begin(), frame.data.begin() + frame.size);
  }
  if (decoded.node) told["node"] = *decoded.node;
  if (decoded.abort_code) told["abort_code"] = *decoded.abort_code;
  if (decoded.error_code) told["error_code"] = *decoded.error_code;
  for (const DecodedValue& value : decoded.values) told["values"].push_back(decoded_json(value));
  return told;
}

}  // namespace

void TraceOutput::show(const LoggedFrame& logged) {
  auto decoder = decoders_.find(logged.interface);
  if (decoder == decoders_.end()) {
    decoder = decoders_.emplace(logged.interface, FrameDecoder(bus_of_interface(buses_, logged.interface))).first;
  }
  DecodedFrame decoded;
  if (logged.kind == LoggedFrame::Kind::Data) {
    decoded = decoder->second.decode(logged.frame);
  } else {
    decoded.text = foreign_frame_text(logged);
  }
  if (hides(decoded)) return;
  if (view_.json) {
    fmt::print("{}\n", decoded_json(logged, decoded).dump());
  } else if (logged.kind == LoggedFrame::Kind::Data) {
    fmt::print("{}  {}\n", to_log_line(logged), decoded.text);
  } else {
    fmt::print("{}  {}\n", log_line_head(logged), decoded.text);
  }
}

bool TraceOutput::hides(const DecodedFrame& decoded) const {
  const bool cyclic = decoded.kind == FrameKind::Sync || decoded.kind == FrameKind::Pdo;
  const bool of_another = view_.node != 0 && decoded.node && *decoded.node != view_.node;
  return (view_.without_cyclic && cyclic) || of_another;
}

}  // namespace rmac::cli
