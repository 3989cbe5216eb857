#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "unit/fieldbus/canopen/virtual_drive.hpp"

namespace rmac::fieldbus::test {

/// A CAN bus inside the process: virtual drives at one end, ports for masters at the other. Its clock moves when a port
/// waits, or when a test lets time pass.
class CanWire {
 public:
  using Time = std::chrono::nanoseconds;

  VirtualDrive& add(std::uint8_t node, int axes = 1) {
    drives_.push_back(std::make_unique<VirtualDrive>(node, axes));
    drives_.back()->power_on(now_);
    deliver();
    return *drives_.back();
  }
  [[nodiscard]] std::unique_ptr<CanPort> open() { return std::make_unique<Port>(*this); }

  void pass(Time time) {
    constexpr Time kStep = std::chrono::microseconds(250);
    for (const Time end = now_ + time; now_ < end;) {
      now_ = std::min(now_ + kStep, end);
      for (auto& drive : drives_) drive->poll(now_);
      deliver();
      for (auto due = delayed_.begin(); due != delayed_.end() && due->first <= now_; due = delayed_.erase(due)) {
        received_.push_back(due->second);
      }
    }
  }
  [[nodiscard]] Time now() const { return now_; }
  /// A frame from nobody.
  void inject(const CanFrame& frame) { received_.push_back(frame); }
  /// A frame of another master, which the drives obey.
  void intrude(const CanFrame& frame) {
    received_.push_back(frame);
    for (auto& drive : drives_) drive->receive(frame, now_);
    deliver();
  }

  bool full = false;                            ///< the transmit queue takes nothing
  bool cut = false;                             ///< nothing passes either way
  bool bus_off = false;                         ///< so the master's controller says
  bool link_down = false;                       ///< the master's interface
  CanController controller;                     ///< how the master's is
  std::function<void(const CanFrame&)> listen;  ///< everything that passes
  /// A gateway on the way from the drives: what it makes of a frame, and after which times it hands it on, once for
  /// each. None: there is no gateway.
  std::function<std::vector<Time>(CanFrame&)> gateway;

 private:
  class Port final : public CanPort {
   public:
    explicit Port(CanWire& wire) : wire_(wire) { wire_.received_.clear(); }
    bool send(const CanFrame& frame) noexcept override {
      if (wire_.full) {
        ++health_.queue_full;
        return false;
      }
      if (wire_.link_down) {
        ++health_.send_failures;
        return false;
      }
      ++health_.sent;
      if (wire_.cut) return true;
      if (wire_.listen) wire_.listen(frame);
      for (auto& drive : wire_.drives_) drive->receive(frame, wire_.now_);
      wire_.deliver();
      return true;
    }
    bool receive(CanFrame& frame) noexcept override {
      if (wire_.received_.empty()) return false;
      frame = wire_.received_.front();
      wire_.received_.pop_front();
      ++health_.received;
      return true;
    }
    void wait(Time at_most) noexcept override { wire_.pass(at_most); }
    [[nodiscard]] Time now() const noexcept override { return wire_.now_; }
    [[nodiscard]] CanHealth health() const noexcept override {
      CanHealth health = health_;
      health.bus_off = wire_.bus_off;
      health.link_down = wire_.link_down;
      return health;
    }
    [[nodiscard]] CanController controller() const noexcept override { return wire_.controller; }

   private:
    CanWire& wire_;
    CanHealth health_;
  };

  void deliver() {
    for (auto& drive : drives_) {
      for (CanFrame& frame : drive->take_output()) {
        if (cut) continue;
        if (listen) listen(frame);
        if (!gateway) {
          received_.push_back(frame);
          continue;
        }
        for (const Time delay : gateway(frame)) {
          if (delay.count() <= 0) {
            received_.push_back(frame);
          } else {
            delayed_.emplace(now_ + delay, frame);
          }
        }
      }
    }
  }

  std::vector<std::unique_ptr<VirtualDrive>> drives_;
  std::deque<CanFrame> received_;
  std::multimap<Time, CanFrame> delayed_;
  Time now_{std::chrono::seconds(1)};
};

}  // namespace rmac::fieldbus::test
