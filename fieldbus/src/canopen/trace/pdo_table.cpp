#include "canopen/trace/pdo_table.hpp"

#include <fmt/format.h>

#include "canopen/boot_plan.hpp"
#include "rmac/fieldbus/canopen/object_meaning.hpp"

namespace rmac::fieldbus::canopen {
namespace {

/// "TPDO1" for 181h to 1FFh, "RPDO1" for 201h to 27Fh, and so on in turns.
std::string name_of(std::uint16_t id) {
  const unsigned place = (id - 0x180U) / 0x80U;
  return fmt::format("{}PDO{}", place % 2 == 0 ? 'T' : 'R', place / 2 + 1);
}

}  // namespace

PdoTable::PdoTable(const CanopenConfig* config) {
  if (config == nullptr) return;
  for (const AxisConfig& axis : config->axes) {
    add(axis, setpoint_id(axis), axis.setpoints);
    if (!axis.more_setpoints.empty()) add(axis, more_setpoints_id(axis), axis.more_setpoints);
    add(axis, answer_id(axis), axis.answers);
    if (!axis.more_answers.empty()) add(axis, more_answers_id(axis), axis.more_answers);
  }
}

void PdoTable::add(const AxisConfig& axis, std::uint16_t id, const std::vector<MappedObject>& mapped) {
  Contents contents;
  for (const MappedObject& entry : mapped) {
    const auto offset = static_cast<std::uint16_t>(axis.axis_in_node * kAxisOffset);
    contents.push_back({of_axis(entry.object, offset), entry.bits, axis.description});
  }
  contents_[id].push_back(std::move(contents));
}

DecodedFrame PdoTable::decode(const CanFrame& frame) const {
  DecodedFrame decoded;
  decoded.kind = FrameKind::Pdo;
  decoded.node = static_cast<std::uint8_t>(frame.id & 0x7FU);
  const auto found = contents_.find(frame.id);
  bool is_short = false;
  std::string words;
  if (found != contents_.end()) {
    for (const Contents& contents : found->second) {
      std::size_t at = 0;
      for (const Content& content : contents) {
        const std::size_t bytes = content.bits / 8U;
        is_short = is_short || at + bytes > frame.size;
        if (is_short) break;
        const std::span<const std::uint8_t> value(&frame.data.at(at), bytes);
        at += bytes;
        if (content.object.index < 0x1000) continue;  // a data type, which fills room
        const ObjectMeaning meaning = meaning_of(content.object, content.sheet.get());
        const std::string text = value_text(content.object, meaning, value);
        const std::string name = meaning.name.empty() ? to_string(content.object) : meaning.name;
        words += fmt::format("{}{} {}", words.empty() ? "" : ", ", name, text);
        decoded.values.push_back({content.object, meaning.name, value_of(meaning, value), text});
      }
    }
  }
  decoded.text = fmt::format("{} node {}: ", name_of(frame.id), *decoded.node);
  if (is_short) {
    decoded.values.clear();
    decoded.text += fmt::format("shorter than what is mapped, {} bytes", frame.size);
  } else if (found == contents_.end()) {
    decoded.text += fmt::format("{} bytes, by a mapping that is not known", frame.size);
  } else {
    decoded.text += words;
  }
  return decoded;
}

}  // namespace rmac::fieldbus::canopen
