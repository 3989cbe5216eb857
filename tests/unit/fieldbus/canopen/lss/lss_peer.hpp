#pragma once

#include <array>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "rmac/fieldbus/can/can_port.hpp"

namespace rmac::fieldbus::test {

/// A slave of CiA 305 as small stacks have it (CANopenNode among them). In the waiting state it does as the standard
/// says. While it configures it answers every frame of a fast scan, whoever is looked for, and takes no selection. It
/// answers from its main loop, one request at a time: what comes before its answer went out is lost.
class LssPeer {
 public:
  using Time = std::chrono::nanoseconds;
  using Identity = std::array<std::uint32_t, 4>;
  static constexpr std::uint8_t kUnconfigured = 0xFF;

  struct Habits {
    Time answers_after = std::chrono::milliseconds(2);
    Time stores_for = std::chrono::milliseconds(0);  ///< beside that: its memory is slow
    bool always_answers_begin = false;               ///< to the beginning of a fast scan, whatever its state and id
    bool ignores_switches = false;                   ///< it stays where it is
    bool knows_inquiry = true;
    bool boots = true;  ///< with the id that it was given
  };
  LssPeer(const Identity& identity, const Habits& habits, std::uint8_t node = kUnconfigured)
      : identity_(identity), habits_(habits), active_(node), pending_(node) {}

  void receive(const CanFrame& frame, Time now);
  /// What it says by now.
  std::optional<CanFrame> take(Time now);
  [[nodiscard]] std::uint8_t node() const { return active_; }
  [[nodiscard]] bool configures() const { return configures_; }
  void leave_configuring() { configures_ = true; }  ///< as a master that was killed did
  [[nodiscard]] int stored() const { return stored_; }

 private:
  void while_waiting(const CanFrame& frame, Time now);
  void while_configuring(const CanFrame& frame, Time now);
  [[nodiscard]] bool fits(const CanFrame& frame);
  void answer(Time at, std::uint8_t command, std::uint32_t number = 0);

  Identity identity_;
  Habits habits_;
  std::uint8_t active_, pending_;
  bool configures_ = false;
  Identity selected_{};
  std::uint8_t scan_part_ = 0;
  int stored_ = 0;
  Time answers_at_{0};
  std::optional<CanFrame> answer_;
};

/// Such slaves at one end of a wire, on a clock of their own.
class LssWire final : public CanPort {
 public:
  LssPeer& add(const LssPeer::Identity& identity) { return add(identity, {}); }
  LssPeer& add(const LssPeer::Identity& identity, const LssPeer::Habits& habits,
               std::uint8_t node = LssPeer::kUnconfigured) {
    return *peers_.emplace_back(std::make_unique<LssPeer>(identity, habits, node));
  }
  bool send(const CanFrame& frame) noexcept override;
  [[nodiscard]] bool receive(CanFrame& frame) noexcept override;
  void wait(std::chrono::nanoseconds at_most) noexcept override;
  [[nodiscard]] std::chrono::nanoseconds now() const noexcept override { return now_; }
  [[nodiscard]] CanHealth health() const noexcept override { return {}; }

  std::function<void(const CanFrame&)> listen;  ///< what the master sends
  bool cut = false;                             ///< and whether it does not arrive

 private:
  std::vector<std::unique_ptr<LssPeer>> peers_;
  std::deque<CanFrame> received_;
  std::chrono::nanoseconds now_{0};
};

}  // namespace rmac::fieldbus::test
