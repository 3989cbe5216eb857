#include "gateway/simulators/vdrive/node.hpp"

#include <algorithm>
#include <utility>

namespace rmac::vdrive {
namespace {

// Emergency error codes (CiA 301, 7.2.7.1, table 26)
constexpr std::uint16_t kHeartbeatError = 0x8130;
constexpr std::uint16_t kPdoTooShort = 0x8210;
constexpr std::uint16_t kPdoTooLong = 0x8220;

constexpr std::uint32_t kIncompatible = 0x06040043;
constexpr std::uint32_t kCannotStore = 0x08000020;
constexpr std::int64_t kSave = 0x65766173;  // "save"
constexpr std::int64_t kLoad = 0x64616F6C;  // "load"

}  // namespace

Node::Node(const fieldbus::eds::DeviceDescription& sheet, std::uint8_t id, const fieldbus::AxisPlantParameters& plant,
           std::optional<std::uint32_t> serial_number)
    : sheet_(sheet),
      id_(id),
      lss_(id),
      dictionary_(sheet, id, serial_number),
      pdos_(dictionary_),
      server_(std::in_place, id, dictionary_),
      errors_(dictionary_),
      axis_(dictionary_, plant, [this](std::uint16_t code) {
        dictionary_.set(0x603F, code);
        emergency(code);
      }) {
  attach();
}

void Node::attach() {
  dictionary_.before_write = [this](ObjectAddress object, std::int64_t value) { return check_write(object, value); };
  dictionary_.after_write = [this](ObjectAddress object) { take_write(object); };
  dictionary_.before_read = [this](ObjectAddress) { axis_.publish(); };
}

/// Identifiers follow the node's id, and so do the values that the sheet has for it.
void Node::renumber(std::uint8_t id) {
  if (id == id_) return;
  id_ = id;
  const auto serial_number = static_cast<std::uint32_t>(dictionary_.number(0x1018, 4));
  dictionary_ = Dictionary(sheet_, id, serial_number);
  attach();
  server_.emplace(id, dictionary_);
}

void Node::power_on(Time now) {
  powered_ = true;
  now_ = now;
  lss_.power_on();
  renumber(lss_.node());
  if (has_id()) reset_application(now);
}

void Node::power_off() {
  powered_ = false;
  nmt_ = NmtState::Initialising;
  outlet_.clear();
}

void Node::reset_application(Time now) {
  dictionary_.restore(false);
  axis_.reset();
  axis_.take({0x6060, 0});  // a mode that was stored
  reset_communication(now);
}

void Node::reset_communication(Time now) {
  dictionary_.restore(true);
  errors_.reset_communication(axis_.state() == PowerStates::Fault || axis_.state() == PowerStates::FaultReaction);
  server_->reset();
  pdos_.reload();
  for (std::uint8_t sub = 1; sub <= HeartbeatWatch::kWatched; ++sub) take_write({0x1016, sub});
  next_heartbeat_ = now;
  nmt_ = NmtState::Initialising;
  outlet_.send(static_cast<std::uint16_t>(0x700 + id_), {0});
  enter(NmtState::PreOperational);
}

void Node::enter(NmtState state) {
  if (state == NmtState::Operational && nmt_ != state) pdos_.forget_told();
  nmt_ = state;
}

void Node::command(std::uint8_t command, Time now) {
  switch (command) {
    case 1:
      return enter(NmtState::Operational);
    case 2:
      axis_.abort_connection();
      return enter(NmtState::Stopped);
    case 128:
      return enter(NmtState::PreOperational);
    case 129:
      renumber(lss_.adopt());
      return reset_application(now);
    case 130:
      axis_.abort_connection();
      renumber(lss_.adopt());
      return reset_communication(now);
    default:
      return;
  }
}

/// Layer setting is for nodes that are not at work (CiA 305, 3.1).
void Node::hear_lss(const CanFrame& frame, Time now) {
  if (nmt_ == NmtState::Operational) return;
  LssSlave::Identity identity{};
  for (std::uint8_t part = 0; part < identity.size(); ++part) {
    identity.at(part) = static_cast<std::uint32_t>(dictionary_.number(0x1018, static_cast<std::uint8_t>(part + 1)));
  }
  if (const auto answer = lss_.receive(frame, identity, now)) outlet_.send(*answer);
  if (!lss_.may_begin()) return;
  renumber(lss_.adopt());
  reset_application(now);
}

void Node::receive(const CanFrame& frame, Time now) {
  if (!powered_ || lss_.silent(now)) return;
  if (frame.id == LssSlave::kMasterId) return hear_lss(frame, now);
  if (!has_id()) return;
  if (frame.id == 0) {
    if (frame.size == 2 && (frame.data[1] == 0 || frame.data[1] == id_)) {
      move(now);
      command(frame.data[0], now);
    }
    return;
  }
  if (frame.id == 0x600 + id_) {
    if (nmt_ == NmtState::Stopped) return;
    move(now);
    for (const CanFrame& reply : server_->receive(frame)) outlet_.send(reply);
    return;
  }
  if (frame.id > 0x700 && frame.id < 0x780) return heartbeats_.hear(frame, now);
  if (nmt_ != NmtState::Operational) return;
  if (frame.id == (dictionary_.number(0x1005) & 0x7FF)) return sync(now);
  const PdoSet::Fit fit = pdos_.receive(frame);
  if (fit == PdoSet::Fit::TooShort) emergency(kPdoTooShort);
  if (fit == PdoSet::Fit::TooLong) emergency(kPdoTooLong);
}

void Node::sync(Time now) {
  move(now);
  pdos_.act_on_sync();
  axis_.publish();
  pdos_.tell_on_sync(outlet_.frames());
}

void Node::watch_heartbeats(Time now) {
  for (int lost = heartbeats_.lost(now); lost > 0; --lost) {
    emergency(kHeartbeatError);
    axis_.abort_connection();
    // Error behavior (1029h): 0 to Pre-operational, if it was Operational; 1 stays; 2 to Stopped.
    const std::int64_t behavior = dictionary_.number(0x1029, 1);
    if (behavior == 0 && nmt_ == NmtState::Operational) enter(NmtState::PreOperational);
    if (behavior == 2) enter(NmtState::Stopped);
  }
}

void Node::move(Time now) {
  axis_.advance(std::chrono::duration<double>(now - now_).count());
  now_ = std::max(now, now_);
}

void Node::poll(Time now) {
  if (!powered_ || !has_id()) return;
  // With SYNC the axis moves anyway; a poll between two of them is not worth the steps.
  constexpr Time kWorthMoving = std::chrono::microseconds(400);
  if (now - now_ >= kWorthMoving) move(now);
  watch_heartbeats(now);
  if (nmt_ == NmtState::Operational && pdos_.tells_events()) {
    axis_.publish();
    pdos_.tell_events(now, outlet_.frames());
  }
  const Time interval = std::chrono::milliseconds(dictionary_.number(0x1017));
  if (interval.count() == 0 || now < next_heartbeat_ || lss_.silent(now)) return;
  outlet_.send(static_cast<std::uint16_t>(0x700 + id_), {static_cast<std::uint8_t>(nmt_)});
  next_heartbeat_ = std::max(next_heartbeat_ + interval, now);
}

std::uint32_t Node::check_write(ObjectAddress object, std::int64_t value) const {
  switch (object.index) {
    case 0x1003:
      return value == 0 ? 0 : kBadValue;
    case 0x1005:
    case 0x1014:
      // Identifiers of 11 bits; this node makes no SYNC (bit 30).
      return (value & 0x60000000) == 0 ? 0 : kBadValue;
    case 0x1010:
      return value == kSave ? 0 : kCannotStore;
    case 0x1011:
      return value == kLoad ? 0 : kCannotStore;
    case 0x1016: {
      const std::int64_t node = value >> 16 & 0xFF;
      const bool used = node != 0 && (value & 0xFFFF) != 0;
      const std::uint8_t other = object.sub == 1 ? 2 : 1;
      const std::int64_t others = dictionary_.number(0x1016, other);
      if (used && (others >> 16 & 0xFF) == node && (others & 0xFFFF) != 0) return kIncompatible;
      return node <= 127 ? 0 : kBadValue;
    }
    case 0x6060:
      return value == 0 || (value > 0 && value <= 32 && (dictionary_.number(0x6502) >> (value - 1) & 1) != 0)
                 ? 0
                 : kBadValue;
    case 0x60B8:
      return TouchProbe::knows(value & 0xFF) && TouchProbe::knows(value >> 8 & 0xFF) ? 0 : kBadValue;
    case 0x6098:
      return value == 0 || Homing::knows(static_cast<int>(value)) ? 0 : kBadValue;
    default:
      return pdos_.check(object, value);
  }
}

void Node::take_write(ObjectAddress object) {
  switch (object.index) {
    case 0x1003:
      errors_.clear_list();
      break;
    case 0x1010:
      dictionary_.set({0x1010, 1}, 1);
      dictionary_.store();
      break;
    case 0x1011:
      dictionary_.set({0x1011, 1}, 1);
      dictionary_.forget();
      break;
    case 0x1016:
      heartbeats_.configure(object.sub, dictionary_.number(0x1016, object.sub));
      break;
    case 0x1017:
      next_heartbeat_ = now_;
      break;
    default:
      if (object.index >= 0x1400 && object.index < 0x1C00) pdos_.reload();
      axis_.take(object);
      break;
  }
}

void Node::emergency(std::uint16_t code) {
  errors_.note(code);
  const std::int64_t id = dictionary_.number(0x1014);
  if ((id & 0x80000000) != 0 || nmt_ == NmtState::Stopped || nmt_ == NmtState::Initialising) return;
  outlet_.send(static_cast<std::uint16_t>(id & 0x7FF), errors_.emergency(code));
}

}  // namespace rmac::vdrive
