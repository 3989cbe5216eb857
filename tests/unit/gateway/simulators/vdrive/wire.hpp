#pragma once

#include <deque>

#include "rmac/fieldbus/can/can_port.hpp"
#include "unit/gateway/simulators/vdrive/node_bench.hpp"

namespace rmac::vdrive::test {

/// Nodes at one end of a wire inside the process, the master's port at the other.
class Wire {
 public:
  Node& add(std::uint8_t id, std::optional<std::uint32_t> serial_number = std::nullopt) {
    nodes_.push_back(std::make_unique<Node>(sheet(), id, fieldbus::AxisPlantParameters(), serial_number));
    nodes_.back()->power_on(now_);
    return *nodes_.back();
  }
  std::unique_ptr<fieldbus::CanPort> open() { return std::make_unique<Port>(*this); }
  void pass(Time time) {
    for (const Time end = now_ + time; now_ < end;) {
      now_ = std::min(now_ + Time(std::chrono::microseconds(250)), end);
      for (auto& node : nodes_) node->poll(now_);
      deliver();
    }
  }

 private:
  class Port final : public fieldbus::CanPort {
   public:
    explicit Port(Wire& wire) : wire_(wire) { wire_.received_.clear(); }
    bool send(const CanFrame& frame) noexcept override {
      for (auto& node : wire_.nodes_) node->receive(frame, wire_.now_);
      wire_.deliver();
      return true;
    }
    bool receive(CanFrame& frame) noexcept override {
      if (wire_.received_.empty()) return false;
      frame = wire_.received_.front();
      wire_.received_.pop_front();
      return true;
    }
    void wait(Time at_most) noexcept override { wire_.pass(at_most); }
    [[nodiscard]] Time now() const noexcept override { return wire_.now_; }
    [[nodiscard]] fieldbus::CanHealth health() const noexcept override { return {}; }

   private:
    Wire& wire_;
  };
  void deliver() {
    for (auto& node : nodes_) {
      for (const CanFrame& frame : node->take_output(now_)) received_.push_back(frame);
    }
  }

  std::vector<std::unique_ptr<Node>> nodes_;
  std::deque<CanFrame> received_;
  Time now_{std::chrono::seconds(1)};
};

}  // namespace rmac::vdrive::test
