#pragma once

#include <chrono>
#include <functional>
#include <set>
#include <vector>

#include "gateway/simulators/vdrive/axis/power_states.hpp"
#include "unit/fieldbus/canopen/object_bank.hpp"

namespace rmac::fieldbus::test {

using vdrive::PowerStates;

/// A quick stop stays until it is left by command, and nothing slows down first.
inline constexpr vdrive::OptionCodes kOptions{.quick_stop = 6, .disable_operation = 0};

/// A CANopen node with one or more CiA 402 axes: object dictionary, SDO server, PDOs as its dictionary says, NMT,
/// heartbeat produced and watched, EMCY, and an axis that moves. It shares no protocol code with the master.
class VirtualDrive {
 public:
  using Time = std::chrono::nanoseconds;

  explicit VirtualDrive(std::uint8_t node, int axes = 1);

  void receive(const CanFrame& frame, Time now);
  /// Lets time pass: heartbeats, moving axes.
  void poll(Time now);
  /// What it wants to send, in order.
  [[nodiscard]] std::vector<CanFrame> take_output();

  void power_on(Time now);  ///< sends its boot-up message
  void power_off() { powered_ = false; }
  void trip(std::uint16_t error_code);

  [[nodiscard]] std::uint8_t node() const { return node_; }
  [[nodiscard]] PowerStates::State state(int axis = 0) const {
    return axes_.at(static_cast<std::size_t>(axis)).power.state();
  }
  [[nodiscard]] double position(int axis = 0) const { return axes_.at(static_cast<std::size_t>(axis)).position; }
  [[nodiscard]] double velocity(int axis = 0) const { return axes_.at(static_cast<std::size_t>(axis)).velocity; }
  [[nodiscard]] bool operational() const { return nmt_ == 5; }
  [[nodiscard]] std::uint32_t value(std::uint16_t index, std::uint8_t sub) const;
  void set(std::uint16_t index, std::uint8_t sub, std::uint32_t value, int bytes);
  /// Also from the next reset on, while it is without power.
  void set_bytes(Object object, const Bytes& bytes) { dictionary_[object] = defaults_[object] = bytes; }
  void remove(std::uint16_t index);
  void remove(std::uint16_t index, std::uint8_t sub);
  void refuse_reading(Object object, std::uint32_t abort_code) { bank_.unreadable[object] = abort_code; }
  /// It refuses it no more.
  void allow(Object object) {
    bank_.unreadable.erase(object);
    bank_.unwritable.erase(object);
  }
  void refuse_writing(Object object, std::uint32_t abort_code) { bank_.unwritable[object] = abort_code; }
  /// The shaft, at rest.
  void put_at(double counts, int axis = 0) {
    axes_.at(static_cast<std::size_t>(axis)).position = counts;
    axes_.at(static_cast<std::size_t>(axis)).velocity = 0;
  }

  vdrive::SdoServer& server() { return server_; }
  double acceleration_counts_s2 = 2e6;  ///< at rated torque, and while braking
  bool answers_sdo = true;
  bool answers_sync = true;
  bool sends_heartbeats = true;
  bool repeats_toggle = false;          ///< of its answers to guarding
  bool lives_from_writing = false;      ///< its life guarding begins when 100Dh is written, not with the first question
  unsigned quick_stop_mask = 0;         ///< bits of its statusword that are the other way round
  bool stores = false;                  ///< 1010h: what it is told stays beyond a reset
  bool maps_by_memory = false;          ///< its PDOs have the contents that it stored, whatever it is told
  bool event_driven = false;            ///< keeps its TPDOs at 255, and sends them by the clock, too
  int boot_ups = 1;                     ///< messages of each boot, the later ones
  Time boot_up_gap{0};                  ///< so long after one another
  Time boot_time{0};                    ///< from a reset to the first of them
  Time sdo_after{0};                    ///< its boot-up message: questions before are passed over
  Time sdo_time{0};                     ///< for an answer; an abort meanwhile ends its work on it
  Time writable_after{0};               ///< its boot-up message: its state forbids to write before
  std::set<Object> silent;              ///< what is asked of these is passed over
  int deaf_to_resets = 0;               ///< so many more it does not obey
  std::uint32_t heartbeat_step = 1;     ///< ms: 1017h keeps multiples of it
  std::uint8_t tpdo_length_change = 0;  ///< bytes that its TPDOs are too short by
  std::function<void(Object, const Bytes&)> on_write;

 private:
  struct Axis {
    PowerStates power;
    double position = 0;  ///< counts
    double velocity = 0;  ///< counts/s
  };

  void reset(Time now);
  void boot_up(Time now);
  void map_by_memory();
  void emergency(std::uint16_t code);
  void sync(Time now);
  void answer_sdo(const CanFrame& frame, Time now);
  void give_answers(Time now);
  /// Of its RPDOs: two of each axis.
  [[nodiscard]] std::vector<std::uint16_t> rpdo_numbers() const;
  void act_on(const CanFrame& frame);
  void move(Time now);
  void publish();
  void abort_connection();
  void watch_master(Time now);
  [[nodiscard]] std::uint32_t check_write(Object object, const Bytes& bytes);
  void send(std::uint16_t id, std::vector<std::uint8_t> data);

  std::uint8_t node_;
  std::vector<Axis> axes_;
  ObjectDictionary dictionary_;
  ObjectDictionary defaults_;
  ObjectBank bank_{dictionary_};
  vdrive::SdoServer server_;
  std::vector<CanFrame> output_;
  std::vector<CanFrame> answers_;  ///< to SDOs, for `answer_at_`
  Time answer_at_{0};
  Time booted_{0};
  std::vector<CanFrame> waiting_;  ///< setpoints for the next SYNC
  int nmt_ = 0;
  bool powered_ = false;
  Time moved_{0};
  int boot_ups_left_ = 0;
  Time next_boot_up_{0};
  Time next_event_{0};
  Time next_heartbeat_{0};
  Time master_heard_{0};
  bool watches_ = false;
  bool toggle_ = false;
};

}  // namespace rmac::fieldbus::test
