#include "gateway/simulators/vdrive/pdo_set.hpp"

#include <algorithm>

namespace rmac::vdrive {
namespace {

constexpr std::uint32_t kInvalid = 0x80000000;
constexpr std::uint32_t kExtended = 0x20000000;
constexpr std::uint32_t kIdMask = 0x7FF;
constexpr std::uint32_t kTooLongForPdo = 0x06040042;
constexpr std::uint32_t kStateForbids = 0x08000022;
constexpr std::uint8_t kLastSyncType = 240;
constexpr std::uint8_t kFirstEventType = 254;
constexpr std::size_t kFrameBytes = 8;

enum class Kind { None, SetpointCommunication, SetpointContents, ToldCommunication, ToldContents };

Kind kind_of(std::uint16_t index) {
  if ((index & 0xFFU) >= PdoSet::kPairs) return Kind::None;
  switch (index & 0xFF00U) {
    case 0x1400:
      return Kind::SetpointCommunication;
    case 0x1600:
      return Kind::SetpointContents;
    case 0x1800:
      return Kind::ToldCommunication;
    case 0x1A00:
      return Kind::ToldContents;
    default:
      return Kind::None;
  }
}

/// Identifiers that CiA 301 keeps from PDOs (7.3.5, table 40).
bool restricted(std::uint32_t id) {
  return id <= 0x07F || (id >= 0x101 && id <= 0x180) || (id >= 0x581 && id <= 0x5FF) || (id >= 0x601 && id <= 0x67F) ||
         (id >= 0x6E0 && id <= 0x6FF) || (id >= 0x701 && id <= 0x77F) || id >= 0x780;
}

}  // namespace

std::uint32_t PdoSet::check_id(std::uint16_t communication, std::uint32_t value) const {
  if ((value & kExtended) != 0) return kBadValue;  // 29 bits
  const auto now = static_cast<std::uint32_t>(dictionary_.number(communication, 1));
  const bool stays_valid = (now & kInvalid) == 0 && (value & kInvalid) == 0;
  if (stays_valid && ((now ^ value) & kIdMask) != 0) return kBadValue;
  return (value & kInvalid) == 0 && restricted(value & kIdMask) ? kBadValue : 0;
}

std::uint32_t PdoSet::check_contents(ObjectAddress object, std::uint32_t value) const {
  const bool setpoint = kind_of(object.index) == Kind::SetpointContents;
  const auto communication = static_cast<std::uint16_t>(object.index - 0x200);
  // The order of 7.5.2.36: the PDO is made invalid, its number of entries 0; then entries, their number, and valid
  // again.
  if ((static_cast<std::uint32_t>(dictionary_.number(communication, 1)) & kInvalid) == 0) return kStateForbids;
  if (object.sub != 0) {
    if (dictionary_.number(object.index, 0) != 0) return kStateForbids;
    return value == 0 ? 0 : dictionary_.check_mapping(value, setpoint);
  }
  if (value > kFrameBytes) return kTooLongForPdo;
  std::uint32_t bits = 0;
  for (std::uint8_t sub = 1; sub <= value; ++sub) {
    const auto entry = static_cast<std::uint32_t>(dictionary_.number(object.index, sub));
    if (const std::uint32_t code = dictionary_.check_mapping(entry, setpoint); code != 0) return code;
    bits += entry & 0xFF;
  }
  return bits > 8 * kFrameBytes ? kTooLongForPdo : 0;
}

std::uint32_t PdoSet::check(ObjectAddress object, std::int64_t value) const {
  const auto raw = static_cast<std::uint32_t>(value);
  const Kind kind = kind_of(object.index);
  if (kind == Kind::SetpointContents || kind == Kind::ToldContents) return check_contents(object, raw);
  if (kind == Kind::None) return 0;
  if (object.sub == 1) return check_id(object.index, raw);
  const bool valid = (static_cast<std::uint32_t>(dictionary_.number(object.index, 1)) & kInvalid) == 0;
  // Remote requests (252, 253) are not served: CiA recommends to do without them (AN 802).
  if (object.sub == 2 && raw > kLastSyncType && raw < kFirstEventType) return kBadValue;
  if (object.sub == 3 && valid) return kStateForbids;  // the inhibit time changes only while the PDO is invalid
  return 0;
}

void PdoSet::load(Pdo& pdo, std::uint16_t communication) const {
  const auto contents = static_cast<std::uint16_t>(communication + 0x200);
  const auto id = static_cast<std::uint32_t>(dictionary_.number(communication, 1));
  pdo.valid = (id & kInvalid) == 0;
  pdo.id = static_cast<std::uint16_t>(id & kIdMask);
  pdo.type = static_cast<std::uint8_t>(dictionary_.number(communication, 2));
  pdo.contents.clear();
  pdo.bytes = 0;
  for (std::uint8_t sub = 1; sub <= dictionary_.number(contents, 0); ++sub) {
    const auto entry = static_cast<std::uint32_t>(dictionary_.number(contents, sub));
    pdo.contents.push_back(
        {{static_cast<std::uint16_t>(entry >> 16), static_cast<std::uint8_t>(entry >> 8)}, (entry & 0xFF) / 8});
    pdo.bytes += pdo.contents.back().bytes;
  }
  if (!pdo.valid) pdo.waits.reset();
}

void PdoSet::reload() {
  for (std::uint16_t i = 0; i < kPairs; ++i) {
    load(setpoints_.at(i), static_cast<std::uint16_t>(0x1400 + i));
    Told& pdo = told_.at(i);
    const auto communication = static_cast<std::uint16_t>(0x1800 + i);
    load(pdo, communication);
    pdo.inhibit = std::chrono::microseconds(100 * dictionary_.number(communication, 3));
    pdo.event_timer = std::chrono::milliseconds(dictionary_.number(communication, 5));
  }
}

PdoSet::Fit PdoSet::receive(const CanFrame& frame) {
  Fit fit = Fit::Fits;
  for (Pdo& pdo : setpoints_) {
    if (!pdo.valid || pdo.id != frame.id) continue;
    if (frame.size < pdo.bytes) {
      fit = Fit::TooShort;
      continue;
    }
    if (frame.size > pdo.bytes) fit = Fit::TooLong;
    if (pdo.type <= kLastSyncType) {
      pdo.waits = frame;
    } else {
      act(pdo, frame);
    }
  }
  return fit;
}

void PdoSet::act(const Pdo& pdo, const CanFrame& frame) {
  std::size_t at = 0;
  for (const Mapped& mapped : pdo.contents) {
    dictionary_.take(mapped.object, &frame.data.at(at));
    at += mapped.bytes;
  }
}

void PdoSet::act_on_sync() {
  for (Pdo& pdo : setpoints_) {
    if (!pdo.waits) continue;
    const CanFrame frame = *pdo.waits;
    pdo.waits.reset();
    act(pdo, frame);
  }
}

CanFrame PdoSet::frame_of(const Told& pdo) const {
  CanFrame frame;
  frame.id = pdo.id;
  for (const Mapped& mapped : pdo.contents) {
    const Bytes* bytes = dictionary_.bytes(mapped.object);
    for (std::size_t i = 0; i < mapped.bytes && frame.size < kFrameBytes; ++i) {
      frame.data.at(frame.size++) = bytes != nullptr && i < bytes->size() ? (*bytes)[i] : std::uint8_t{0};
    }
  }
  frame.size = static_cast<std::uint8_t>(std::clamp(frame.size + length_change, 0, static_cast<int>(kFrameBytes)));
  return frame;
}

void PdoSet::tell_on_sync(std::vector<CanFrame>& output) {
  for (Told& pdo : told_) {
    if (!pdo.valid || pdo.type > kLastSyncType) continue;
    const CanFrame frame = frame_of(pdo);
    // 0: with the SYNC after a change; 1 to 240: with every so manyth.
    const bool due = pdo.type == 0 ? !pdo.last || !(*pdo.last == frame) : ++pdo.syncs >= pdo.type;
    if (!due) continue;
    pdo.syncs = 0;
    pdo.last = frame;
    output.push_back(frame);
  }
}

bool PdoSet::tells_events() const {
  return std::any_of(told_.begin(), told_.end(),
                     [](const Told& pdo) { return pdo.valid && pdo.type >= kFirstEventType; });
}

void PdoSet::tell_events(Time now, std::vector<CanFrame>& output) {
  for (Told& pdo : told_) {
    if (!pdo.valid || pdo.type < kFirstEventType) continue;
    const CanFrame frame = frame_of(pdo);
    const bool changed = !pdo.last || !(*pdo.last == frame);
    const bool timed = pdo.event_timer.count() > 0 && now - pdo.told_at >= pdo.event_timer;
    if ((!changed && !timed) || (pdo.last && now - pdo.told_at < pdo.inhibit)) continue;
    pdo.last = frame;
    pdo.told_at = now;
    output.push_back(frame);
  }
}

void PdoSet::forget_told() {
  for (Told& pdo : told_) pdo.last.reset();
  for (Told& pdo : told_) pdo.syncs = 0;
  for (Pdo& pdo : setpoints_) pdo.waits.reset();
}

}  // namespace rmac::vdrive
