#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <thread>

#include "rmac/fieldbus/can/socket_can_port.hpp"
#include "rmac/fieldbus/canopen/canopen_interface.hpp"
#include "rmac/motion/drive_power.hpp"
#include "unit/fieldbus/canopen/virtual_drive.hpp"

// The CANopen master on a real CAN interface of the kernel, against virtual drives on another socket. Interfaces go
// down and up, so it wants a virtual one, and the right to do that. Cycles keep real time.
namespace rmac::bench {

using namespace rmac::fieldbus;
using rmac::fieldbus::test::PowerStates;
using rmac::fieldbus::test::VirtualDrive;
using std::chrono::milliseconds;

inline std::string interface_name() {
  const char* name = std::getenv("RMAC_CAN_INTERFACE");
  return name != nullptr ? name : "vcan0";
}

inline void set_link(const char* state) {
  const std::string command = "ip link set " + interface_name() + " " + state;
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

inline std::unique_ptr<SocketCanPort> open_port(std::span<const std::uint16_t> wanted = {}) {
  auto port = SocketCanPort::open(interface_name(), wanted, 1);
  EXPECT_TRUE(port.has_value()) << port.error().message;
  return port ? std::move(*port) : nullptr;
}

/// Drives on a thread and a socket of their own.
class Drives {
 public:
  explicit Drives(const std::vector<std::uint8_t>& nodes) : port_(open_port()) {
    for (const std::uint8_t node : nodes) drives_.push_back(std::make_unique<VirtualDrive>(node));
    for (auto& drive : drives_) drive->power_on(port_->now());
    thread_ = std::thread([this] { run(); });
  }
  ~Drives() {
    ends_ = true;
    thread_.join();
  }
  template <typename Look>
  auto look(std::size_t drive, Look&& at) {
    const std::lock_guard lock(mutex_);
    return at(*drives_.at(drive));
  }
  /// Whether they are off the bus: they hear nothing and send nothing.
  void set_off_bus(bool off) { off_bus_ = off; }
  [[nodiscard]] PowerStates::State state(std::size_t drive) {
    return look(drive, [](VirtualDrive& d) { return d.state(); });
  }

 private:
  void run() {
    while (!ends_) {
      port_->wait(milliseconds(1));
      const std::lock_guard lock(mutex_);
      CanFrame frame;
      while (port_->receive(frame)) {
        if (off_bus_) continue;
        for (auto& drive : drives_) drive->receive(frame, port_->now());
        send();
      }
      for (auto& drive : drives_) drive->poll(port_->now());
      send();
    }
  }
  void send() {
    for (auto& drive : drives_) {
      for (const CanFrame& frame : drive->take_output()) {
        if (!off_bus_) port_->send(frame);
      }
    }
  }

  std::unique_ptr<SocketCanPort> port_;
  std::vector<std::unique_ptr<VirtualDrive>> drives_;
  std::mutex mutex_;
  std::atomic<bool> ends_{false};
  std::atomic<bool> off_bus_{false};
  std::thread thread_;
};

/// A master whose cycles keep real time.
class Master final : public DigitalControlInterface {
 public:
  explicit Master(std::map<std::string, std::vector<double>> numbers) {
    auto config = canopen::read_canopen_config(interface_name(), numbers, {}, 0.001);
    EXPECT_TRUE(config.has_value()) << config.error().message;
    bus_ = canopen::make_socketcan_interface(std::move(*config));
    commands.resize(bus_->axis_count());
    feedback.resize(bus_->axis_count());
  }
  std::size_t axis_count() const noexcept override { return bus_->axis_count(); }
  Expected<> start() override {
    return bus_->start().map([this] {
      clock_gettime(CLOCK_MONOTONIC, &due_);
      EXPECT_TRUE(exchange(commands, feedback));
    });
  }
  void stop() noexcept override { bus_->stop(); }
  [[nodiscard]] bool receive(std::span<DriveFeedback> in) noexcept override { return bus_->receive(in); }
  bool send(std::span<const DriveCommand> out) noexcept override {
    const bool sound = bus_->send(out);
    constexpr long kPeriodNs = 1'000'000;
    constexpr long kSecondNs = 1'000'000'000;
    due_.tv_nsec += kPeriodNs;
    if (due_.tv_nsec >= kSecondNs) {
      due_.tv_nsec -= kSecondNs;
      ++due_.tv_sec;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due_, nullptr);
    return sound;
  }
  bool cycle(DriveWish wish) {
    for (std::size_t i = 0; i < commands.size(); ++i) {
      commands[i].controlword = next_controlword(feedback[i].statusword, wish, false, commands[i].controlword);
    }
    return exchange(commands, feedback);
  }
  void enable_all() {
    for (int i = 0; i < 50; ++i) cycle(DriveWish::Operational);
    for (const DriveFeedback& words : feedback) {
      ASSERT_EQ(drive_state(words.statusword), DriveState::OperationEnabled);
    }
  }
  [[nodiscard]] bool all_online() const {
    return std::all_of(feedback.begin(), feedback.end(), [](const DriveFeedback& words) { return words.online; });
  }
  [[nodiscard]] const canopen::CanopenCounters& counters() const { return bus_->counters(); }

  std::vector<DriveCommand> commands;
  std::vector<DriveFeedback> feedback;

 private:
  std::shared_ptr<canopen::CanopenInterface> bus_;
  timespec due_{};
};

}  // namespace rmac::bench
