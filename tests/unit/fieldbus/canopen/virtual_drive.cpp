#include "unit/fieldbus/canopen/virtual_drive.hpp"

#include <algorithm>
#include <cmath>

namespace rmac::fieldbus::test {
namespace {

constexpr int kPreOperational = 127;
constexpr int kOperational = 5;
constexpr int kStopped = 4;

std::uint16_t profile(int axis, int index) {
  return static_cast<std::uint16_t>(index + 0x800 * axis);
}
std::uint16_t pdo(int axis, int index) {
  return static_cast<std::uint16_t>(index + 0x40 * axis);
}

}  // namespace

VirtualDrive::VirtualDrive(std::uint8_t node, int axes)
    : node_(node), axes_(static_cast<std::size_t>(axes)), server_(node, bank_) {
  set(0x1000, 0, 0x00020192, 4);
  set(0x1001, 0, 0, 1);
  set(0x1014, 0, 0x80U + node, 4);
  set(0x1016, 0, 1, 1);
  set(0x1016, 1, 0, 4);
  set(0x1017, 0, 0, 2);
  set(0x1018, 0, 4, 1);
  for (std::uint8_t i = 1; i <= 4; ++i) set(0x1018, i, 0x100U * i + node, 4);
  for (int a = 0; a < axes; ++a) {
    for (std::uint8_t n = 0; n < 4; ++n) {
      const auto number = static_cast<std::uint16_t>(pdo(a, 0) + n);
      const bool enabled = a == 0 && n < 2;  // as drives come: two of each at work
      for (const auto& [communication, id] : {std::pair(0x1400, 0x200), std::pair(0x1800, 0x180)}) {
        const auto index = static_cast<std::uint16_t>(communication + number);
        set(index, 0, 2, 1);
        set(index, 1, static_cast<std::uint32_t>(id + 0x100 * n + node) | (enabled ? 0 : 0x80000000U), 4);
        set(index, 2, 255, 1);
        set(static_cast<std::uint16_t>(index + 0x200), 0, 0, 1);
        for (std::uint8_t sub = 1; sub <= 8; ++sub) set(static_cast<std::uint16_t>(index + 0x200), sub, 0, 4);
      }
    }
    set(profile(a, 0x603F), 0, 0, 2);
    set(profile(a, 0x6007), 0, 1, 2);
    set(profile(a, 0x6040), 0, 0, 2);
    set(profile(a, 0x6041), 0, 0, 2);
    set(profile(a, 0x6060), 0, 0, 1);
    set(profile(a, 0x6064), 0, 0, 4);
    set(profile(a, 0x606C), 0, 0, 4);
    set(profile(a, 0x6071), 0, 0, 2);
    set(profile(a, 0x6077), 0, 0, 2);
    set(profile(a, 0x607A), 0, 0, 4);
    set(profile(a, 0x6085), 0, 1000, 4);
    set(profile(a, 0x60FF), 0, 0, 4);
    set(profile(a, 0x6502), 0, 0x3A5, 4);  // pp, pv, hm, csp, csv, cst
  }
  defaults_ = dictionary_;
  bank_.write_check = [this](Object object, const Bytes& bytes) { return check_write(object, bytes); };
}

void VirtualDrive::set(std::uint16_t index, std::uint8_t sub, std::uint32_t number, int bytes) {
  Bytes& entry = dictionary_[{index, sub}];
  entry.clear();
  for (int i = 0; i < bytes; ++i) entry.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
  if (!powered_) defaults_[{index, sub}] = entry;
}

std::uint32_t VirtualDrive::value(std::uint16_t index, std::uint8_t sub) const {
  const auto entry = dictionary_.find({index, sub});
  std::uint32_t number = 0;
  if (entry == dictionary_.end()) return 0;
  for (std::size_t i = 0; i < entry->second.size() && i < 4; ++i) number |= std::uint32_t{entry->second[i]} << (8 * i);
  return number;
}

void VirtualDrive::remove(std::uint16_t index) {
  for (ObjectDictionary* book : {&dictionary_, &defaults_}) {
    std::erase_if(*book, [index](const auto& entry) { return entry.first.index == index; });
  }
}

void VirtualDrive::remove(std::uint16_t index, std::uint8_t sub) {
  dictionary_.erase({index, sub});
  defaults_.erase({index, sub});
}

std::uint32_t VirtualDrive::check_write(Object object, const Bytes& bytes) {
  if (on_write) on_write(object, bytes);
  const auto [index, sub] = object;
  if (moved_ < booted_ + writable_after) return 0x08000022;
  if (stores && object == Object{0x1010, 1}) {
    if (bytes != Bytes{'s', 'a', 'v', 'e'}) return 0x08000020;
    defaults_ = dictionary_;
    return 0;
  }
  if (bytes.size() != dictionary_.at(object).size()) return 0x06070010;
  if (lives_from_writing && object == Object{0x100D, 0} && bytes[0] != 0) {
    watches_ = true;
    master_heard_ = moved_;
  }
  const bool communication = (index & 0xFE00) == 0x1400 || (index & 0xFE00) == 0x1800;
  const bool contents = (index & 0xFE00) == 0x1600 || (index & 0xFE00) == 0x1A00;
  if (communication && sub == 1) {
    const std::uint32_t now = value(index, 1);
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < 4; ++i) next |= std::uint32_t{bytes[i]} << (8 * i);
    const bool valid = (now & 0x80000000U) == 0 && (next & 0x80000000U) == 0;
    if (valid && ((now ^ next) & 0x1FFFFFFF) != 0) return 0x06090030;
  }
  if (contents) {
    const auto of = static_cast<std::uint16_t>(index - 0x200);
    if ((value(of, 1) & 0x80000000U) == 0) return 0x08000022;  // the PDO is in use
    if (sub != 0 && value(index, 0) != 0) return 0x08000022;   // entries change only while there are none
    if (sub == 0) {
      std::uint32_t bits = 0;
      for (std::uint8_t i = 1; i <= bytes[0]; ++i) {
        const std::uint32_t entry = value(index, i);
        const auto found =
            dictionary_.find({static_cast<std::uint16_t>(entry >> 16), static_cast<std::uint8_t>(entry >> 8)});
        const bool dummy = entry >> 16 < 8;
        if (!dummy && (found == dictionary_.end() || found->second.size() * 8 != (entry & 0xFF))) return 0x06040041;
        bits += entry & 0xFF;
      }
      if (bits > 64) return 0x06040042;
    }
  }
  return 0;
}

void VirtualDrive::send(std::uint16_t id, std::vector<std::uint8_t> data) {
  CanFrame frame;
  frame.id = id;
  frame.size = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), frame.data.begin());
  output_.push_back(frame);
}

std::vector<CanFrame> VirtualDrive::take_output() {
  return std::exchange(output_, {});
}

void VirtualDrive::power_on(Time now) {
  powered_ = true;
  for (Axis& axis : axes_) {
    axis.power = PowerStates();
    axis.power.proceed(true, kOptions);
  }
  reset(now);
}

void VirtualDrive::reset(Time now) {
  dictionary_ = defaults_;
  waiting_.clear();
  answers_.clear();
  watches_ = toggle_ = false;
  moved_ = now;
  nmt_ = 0;
  boot_ups_left_ = boot_ups;
  next_boot_up_ = now + boot_time;
  boot_up(now);
}

void VirtualDrive::map_by_memory() {
  for (auto& [object, bytes] : dictionary_) {
    const bool contents = (object.index & 0xFE00) == 0x1600 || (object.index & 0xFE00) == 0x1A00;
    if (contents) bytes = defaults_.at(object);
  }
}

void VirtualDrive::boot_up(Time now) {
  while (boot_ups_left_ > 0 && now >= next_boot_up_) {
    if (nmt_ == 0) {
      nmt_ = kPreOperational;
      booted_ = now;
    }
    send(static_cast<std::uint16_t>(0x700 + node_), {0});
    --boot_ups_left_;
    next_boot_up_ = now + boot_up_gap;
  }
}

void VirtualDrive::emergency(std::uint16_t code) {
  set(0x603F, 0, code, 2);
  send(static_cast<std::uint16_t>(0x80 + node_),
       {static_cast<std::uint8_t>(code), static_cast<std::uint8_t>(code >> 8), 1, 0, 0, 0, 0, 0});
}

void VirtualDrive::trip(std::uint16_t error_code) {
  for (Axis& axis : axes_) axis.power.raise_fault(kOptions);
  emergency(error_code);
}

void VirtualDrive::receive(const CanFrame& frame, Time now) {
  if (!powered_) return;
  if (frame.remote) {
    if (frame.id != 0x700 + node_ || nmt_ == 0 || !sends_heartbeats) return;
    send(frame.id, {static_cast<std::uint8_t>(nmt_ | (toggle_ ? 0x80 : 0))});
    if (!repeats_toggle) toggle_ = !toggle_;
    master_heard_ = now;
    watches_ = value(0x100C, 0) * value(0x100D, 0) != 0;
    return;
  }
  if (frame.id == 0 && frame.size == 2 && (frame.data[1] == 0 || frame.data[1] == node_)) {
    switch (frame.data[0]) {
      case 1:
        nmt_ = kOperational;
        if (maps_by_memory) map_by_memory();
        break;
      case 2:
        nmt_ = kStopped;
        break;
      case 128:
        nmt_ = kPreOperational;
        break;
      case 129:
      case 130:
        if (deaf_to_resets > 0) {
          --deaf_to_resets;
          break;
        }
        abort_connection();
        reset(now);
        break;
      default:
        break;
    }
    return;
  }
  if (frame.id == 0x600 + node_ && nmt_ != kStopped && nmt_ != 0) {
    return answer_sdo(frame, now);
  }
  if (frame.id > 0x700 && frame.id < 0x780 && frame.size == 1 && frame.id - 0x700U == (value(0x1016, 1) >> 16 & 0x7F)) {
    master_heard_ = now;
    watches_ = (value(0x1016, 1) & 0xFFFF) != 0;
    return;
  }
  if (nmt_ != kOperational) return;
  if (frame.id == 0x80) return sync(now);
  act_on(frame);
}

void VirtualDrive::answer_sdo(const CanFrame& frame, Time now) {
  if (!answers_sdo || now < booted_ + sdo_after) return;
  if (silent.contains({static_cast<std::uint16_t>(frame.data[1] | frame.data[2] << 8), frame.data[3]})) return;
  answers_ = server_.receive(frame);
  answer_at_ = now + sdo_time;
  give_answers(now);
  if (event_driven) set(0x1800, 2, 255, 1);
  set(0x1017, 0, value(0x1017, 0) / heartbeat_step * heartbeat_step, 2);
}

void VirtualDrive::give_answers(Time now) {
  if (now < answer_at_) return;
  output_.insert(output_.end(), answers_.begin(), answers_.end());
  answers_.clear();
}

std::vector<std::uint16_t> VirtualDrive::rpdo_numbers() const {
  std::vector<std::uint16_t> numbers;
  for (int a = 0; a < static_cast<int>(axes_.size()); ++a) {
    for (int n = 0; n < 2; ++n) numbers.push_back(static_cast<std::uint16_t>(pdo(a, 0) + n));
  }
  return numbers;
}

void VirtualDrive::act_on(const CanFrame& frame) {
  for (const std::uint16_t number : rpdo_numbers()) {
    if (value(static_cast<std::uint16_t>(0x1400 + number), 1) != frame.id) continue;
    const auto contents = static_cast<std::uint16_t>(0x1600 + number);
    std::uint32_t bits = 0;
    for (std::uint8_t i = 1; i <= value(contents, 0); ++i) bits += value(contents, i) & 0xFF;
    if (frame.size * 8U < bits) return emergency(0x8210);
    std::erase_if(waiting_, [&](const CanFrame& old) { return old.id == frame.id; });
    waiting_.push_back(frame);
  }
}

void VirtualDrive::sync(Time now) {
  move(now);
  for (const CanFrame& frame : waiting_) {
    for (const std::uint16_t number : rpdo_numbers()) {
      if (value(static_cast<std::uint16_t>(0x1400 + number), 1) != frame.id) continue;
      const auto contents = static_cast<std::uint16_t>(0x1600 + number);
      std::size_t at = 0;
      for (std::uint8_t i = 1; i <= value(contents, 0); ++i) {
        const std::uint32_t entry = value(contents, i);
        const std::size_t bytes = (entry & 0xFF) / 8;
        const auto object =
            dictionary_.find({static_cast<std::uint16_t>(entry >> 16), static_cast<std::uint8_t>(entry >> 8)});
        if (object != dictionary_.end()) {
          object->second.assign(frame.data.begin() + static_cast<std::ptrdiff_t>(at),
                                frame.data.begin() + static_cast<std::ptrdiff_t>(at + bytes));
        }
        at += bytes;
      }
      const int a = number / 0x40;
      axes_[static_cast<std::size_t>(a)].power.control(static_cast<std::uint16_t>(value(profile(a, 0x6040), 0)),
                                                       kOptions);
    }
  }
  waiting_.clear();
  for (Axis& axis : axes_) axis.power.proceed(true, kOptions);
  publish();
}

void VirtualDrive::publish() {
  for (int a = 0; a < static_cast<int>(axes_.size()); ++a) {
    const Axis& axis = axes_[static_cast<std::size_t>(a)];
    const unsigned status = axis.power.statusword() ^ quick_stop_mask;
    dictionary_[{profile(a, 0x6041), 0}] = {static_cast<std::uint8_t>(status), static_cast<std::uint8_t>(status >> 8)};
    const auto counts = static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(axis.position)));
    const auto speed = static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(axis.velocity)));
    for (unsigned i = 0; i < 4; ++i) {
      dictionary_[{profile(a, 0x6064), 0}][i] = static_cast<std::uint8_t>(counts >> (8 * i));
      dictionary_[{profile(a, 0x606C), 0}][i] = static_cast<std::uint8_t>(speed >> (8 * i));
    }
    const std::uint32_t id = value(pdo(a, 0x1800), 1);
    if ((id & 0x80000000U) != 0 || (value(pdo(a, 0x1800), 2) != 1 && !event_driven) || !answers_sync) continue;
    std::vector<std::uint8_t> data;
    for (std::uint8_t i = 1; i <= value(pdo(a, 0x1A00), 0); ++i) {
      const std::uint32_t entry = value(pdo(a, 0x1A00), i);
      const Bytes& bytes =
          dictionary_.at({static_cast<std::uint16_t>(entry >> 16), static_cast<std::uint8_t>(entry >> 8)});
      data.insert(data.end(), bytes.begin(), bytes.end());
    }
    const auto kept = data.size() - std::min<std::size_t>(tpdo_length_change, data.size());
    data.erase(data.begin() + static_cast<std::ptrdiff_t>(kept), data.end());
    send(static_cast<std::uint16_t>(id & 0x7FF), data);
  }
}

void VirtualDrive::move(Time now) {
  const double dt = std::chrono::duration<double>(now - moved_).count();
  moved_ = now;
  for (int a = 0; a < static_cast<int>(axes_.size()); ++a) {
    Axis& axis = axes_[static_cast<std::size_t>(a)];
    const auto mode = static_cast<std::int8_t>(value(profile(a, 0x6060), 0));
    if (axis.power.operating()) {
      const double before = axis.position;
      if (mode == 10) {
        const auto torque = static_cast<std::int16_t>(value(profile(a, 0x6071), 0));
        axis.velocity += torque / 1000.0 * acceleration_counts_s2 * dt;
        axis.position += axis.velocity * dt;
      } else if (mode == 8) {
        axis.position = static_cast<std::int32_t>(value(profile(a, 0x607A), 0));
        axis.velocity = dt > 0 ? (axis.position - before) / dt : 0;
      } else if (mode == 9 || mode == 3) {
        axis.velocity = static_cast<std::int32_t>(value(profile(a, 0x60FF), 0));
        axis.position += axis.velocity * dt;
      }
    } else {  // brakes: on the quick stop ramp, or with the brake closed
      const double brake = acceleration_counts_s2 * dt;
      axis.velocity = std::abs(axis.velocity) <= brake ? 0 : axis.velocity - std::copysign(brake, axis.velocity);
      axis.position += axis.velocity * dt;
    }
  }
}

void VirtualDrive::abort_connection() {
  for (int a = 0; a < static_cast<int>(axes_.size()); ++a) {
    const auto option = static_cast<int>(value(profile(a, 0x6007), 0));
    axes_[static_cast<std::size_t>(a)].power.abort_connection(option, kOptions);
  }
}

void VirtualDrive::watch_master(Time now) {
  const std::uint32_t guarded_ms = value(0x100C, 0) * value(0x100D, 0);
  const Time limit = std::chrono::milliseconds(guarded_ms != 0 ? guarded_ms : value(0x1016, 1) & 0xFFFF);
  if (!watches_ || now - master_heard_ <= limit) return;
  watches_ = false;
  nmt_ = kPreOperational;  // 1029h at its default
  abort_connection();
  emergency(0x8130);
}

void VirtualDrive::poll(Time now) {
  if (!powered_) return;
  boot_up(now);
  give_answers(now);
  move(now);
  if (event_driven && nmt_ == kOperational && now >= next_event_) {
    publish();
    next_event_ = now + std::chrono::microseconds(700);
  }
  watch_master(now);
  const Time interval = std::chrono::milliseconds(value(0x1017, 0));
  if (interval.count() > 0 && now >= next_heartbeat_) {
    if (sends_heartbeats) send(static_cast<std::uint16_t>(0x700 + node_), {static_cast<std::uint8_t>(nmt_)});
    next_heartbeat_ = now + interval;
  }
}

}  // namespace rmac::fieldbus::test
