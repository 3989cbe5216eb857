#include "rmac/fieldbus/canopen/frame_decoder.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "canopen/trace/lss_text.hpp"
#include "canopen/trace/pdo_table.hpp"
#include "canopen/trace/sdo_dialogue.hpp"
#include "rmac/fieldbus/canopen/emergency.hpp"
#include "rmac/fieldbus/canopen/nmt.hpp"
#include "rmac/fieldbus/canopen/object_meaning.hpp"

namespace rmac::fieldbus::canopen {
namespace {

constexpr std::uint16_t kFirstPdo = 0x180, kEndOfPdos = 0x580, kSdoQuestionId = 0x600, kFunction = 0x780;

std::string octets(std::span<const std::uint8_t> bytes) {
  return fmt::format("{:02X}", fmt::join(bytes, " "));
}

DecodedFrame text_of(FrameKind kind, std::optional<std::uint8_t> node, std::string text) {
  DecodedFrame decoded;
  decoded.kind = kind;
  decoded.node = node;
  decoded.text = std::move(text);
  return decoded;
}

DecodedFrame decode_nmt(const CanFrame& frame) {
  if (frame.size != 2) return text_of(FrameKind::Nmt, {}, fmt::format("NMT of {} bytes", frame.size));
  const std::uint8_t node = frame.data[1];
  const std::string whom = node == 0 ? "all nodes" : fmt::format("node {}", node);
  return text_of(FrameKind::Nmt, node == 0 ? std::nullopt : std::optional(node),
                 fmt::format("NMT {} {}", to_text(static_cast<NmtCommand>(frame.data[0])), whom));
}

DecodedFrame decode_emergency(const CanFrame& frame, std::uint8_t node) {
  constexpr std::size_t kCodeAndRegister = 3;
  if (frame.size < kCodeAndRegister) {
    return text_of(FrameKind::Emergency, node, fmt::format("EMCY node {} of {} bytes", node, frame.size));
  }
  const std::uint16_t code = word_at(frame.data.data());
  std::string text = fmt::format("EMCY node {}: {:04X}h ({}), error register {:02X}h", node, code, emergency_text(code),
                                 frame.data[2]);
  const std::span own(&frame.data[kCodeAndRegister], frame.size - kCodeAndRegister);
  if (std::any_of(own.begin(), own.end(), [](std::uint8_t byte) { return byte != 0; })) {
    text += fmt::format(", of the maker {}", octets(own));
  }
  DecodedFrame decoded = text_of(FrameKind::Emergency, node, std::move(text));
  decoded.error_code = code;
  return decoded;
}

DecodedFrame decode_heartbeat(const CanFrame& frame, std::uint8_t node) {
  if (frame.size != 1) {
    return text_of(FrameKind::Heartbeat, node, fmt::format("heartbeat node {} of {} bytes", node, frame.size));
  }
  const NmtState state = heartbeat_state(frame);
  return text_of(FrameKind::Heartbeat, node,
                 state == NmtState::BootUp ? fmt::format("boot-up node {}", node)
                                           : fmt::format("heartbeat node {}: {}", node, to_text(state)));
}

DecodedFrame decode_time(const CanFrame& frame) {
  const auto time = time_of(frame);
  if (!time) return text_of(FrameKind::Time, {}, fmt::format("TIME of {} bytes", frame.size));
  const auto second = std::chrono::floor<std::chrono::seconds>(*time);
  return text_of(FrameKind::Time, {},
                 fmt::format("TIME {:%Y-%m-%d %H:%M:%S}.{:03} UTC", second, (*time - second).count()));
}

DecodedFrame decode_sync(const CanFrame& frame) {
  return text_of(FrameKind::Sync, {}, frame.size == 0 ? "SYNC" : fmt::format("SYNC {}", frame.data[0]));
}

}  // namespace

class FrameDecoder::Impl {
 public:
  explicit Impl(const CanopenConfig* config) : pdos_(config) {
    if (config == nullptr) return;
    for (const AxisConfig& axis : config->axes) {
      if (axis.description) sheets_[axis.node] = axis.description;
    }
  }

  DecodedFrame decode(const CanFrame& frame) {
    const auto node = static_cast<std::uint8_t>(frame.id & 0x7FU);
    if (frame.id == 0) return decode_nmt(frame);
    if (frame.id == kSyncId) return decode_sync(frame);
    if (frame.id == kTimeId) return decode_time(frame);
    if (frame.id == kLssRequestId || frame.id == kLssAnswerId) return text_of(FrameKind::Lss, {}, lss_text(frame));
    if (node != 0) {
      if (frame.id >= kFirstPdo && frame.id < kEndOfPdos) return pdos_.decode(frame);
      switch (frame.id & kFunction) {
        case kEmergencyId:
          return decode_emergency(frame, node);
        case kSdoQuestionId:
        case kSdoAnswerId:
          return decode_sdo(frame, node);
        case kHeartbeatId:
          return decode_heartbeat(frame, node);
        default:
          break;
      }
    }
    return text_of(FrameKind::Other, {}, "outside the predefined connection set");
  }

 private:
  using Kind = SdoRemark::Kind;

  DecodedFrame decode_sdo(const CanFrame& frame, std::uint8_t node) {
    const bool asks = (frame.id & kFunction) == kSdoQuestionId;
    const std::string who = fmt::format("SDO {} node {}: ", asks ? "to" : "from", node);
    if (frame.size != SdoBytes().size()) {
      return text_of(FrameKind::Sdo, node, who + fmt::format("{} bytes, and it has 8", frame.size));
    }
    SdoDialogue& dialogue = dialogues_[node];
    const SdoRemark remark = asks ? dialogue.from_client(frame.data) : dialogue.from_server(frame.data);
    DecodedFrame decoded = text_of(FrameKind::Sdo, node, who);
    if (!remark.object) {
      decoded.text += "of a transfer that began before, or of none";
      return decoded;
    }
    const auto sheet = sheets_.find(node);
    const ObjectMeaning meaning = meaning_of(*remark.object, sheet == sheets_.end() ? nullptr : sheet->second.get());
    const std::string object = object_text(*remark.object, meaning);
    const std::string value = value_text(*remark.object, meaning, remark.bytes);
    const bool has_value = remark.kind == Kind::Read || remark.kind == Kind::Written ||
                           (remark.kind == Kind::Writes && !remark.bytes.empty());
    if (has_value) {
      decoded.values.push_back({*remark.object, meaning.name, value_of(meaning, remark.bytes), value});
    }
    if (remark.kind == Kind::Aborted) decoded.abort_code = remark.abort_code;
    decoded.text += words_of(remark, object, value);
    return decoded;
  }

  static std::string words_of(const SdoRemark& remark, const std::string& object, const std::string& value) {
    switch (remark.kind) {
      case Kind::Reads:
        return "read " + object;
      case Kind::Writes:
        return remark.bytes.empty() ? "write " + object : fmt::format("write {} = {}", object, value);
      case Kind::Read:
        return fmt::format("{} = {}", object, value);
      case Kind::Written:
        return fmt::format("written {} = {}", object, value);
      case Kind::Aborted:
        return fmt::format("abort {}: {} ({:08X}h)", object, sdo_abort_text(remark.abort_code), remark.abort_code);
      default:
        return object + " goes on";
    }
  }

  PdoTable pdos_;
  std::map<std::uint8_t, std::shared_ptr<const eds::DeviceDescription>> sheets_;
  std::map<std::uint8_t, SdoDialogue> dialogues_;
};

FrameDecoder::FrameDecoder(const CanopenConfig* config) : impl_(std::make_unique<Impl>(config)) {}
FrameDecoder::~FrameDecoder() = default;
FrameDecoder::FrameDecoder(FrameDecoder&&) noexcept = default;
FrameDecoder& FrameDecoder::operator=(FrameDecoder&&) noexcept = default;

DecodedFrame FrameDecoder::decode(const CanFrame& frame) {
  return impl_->decode(frame);
}

const char* to_text(FrameKind kind) noexcept {
  constexpr std::array kNames{"nmt", "sync", "time", "emcy", "pdo", "sdo", "heartbeat", "lss", "other"};
  return kNames.at(static_cast<std::size_t>(kind));
}

}  // namespace rmac::fieldbus::canopen
