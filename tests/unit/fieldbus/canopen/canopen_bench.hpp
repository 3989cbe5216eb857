#pragma once

#include <gtest/gtest.h>

#include "rmac/fieldbus/canopen/canopen_interface.hpp"
#include "rmac/motion/drive_power.hpp"
#include "unit/fieldbus/canopen/can_wire.hpp"

namespace rmac::fieldbus::test {

using Numbers = std::map<std::string, std::vector<double>>;
using Texts = std::map<std::string, std::string>;

/// Virtual drives on a wire and a master over them, stepped cycle by cycle.
class CanopenBench : public testing::Test {
 protected:
  static constexpr double kPeriodS = 0.001;

  /// The master stops only after the test's body, whose variables a listener or a gateway may use.
  void TearDown() override {
    wire_.listen = nullptr;
    wire_.gateway = nullptr;
  }

  void make(const Numbers& numbers, const Texts& texts = {}) {
    auto config = canopen::read_canopen_config("can0", numbers, texts, kPeriodS);
    ASSERT_TRUE(config.has_value()) << config.error().message;
    make_from(*config);
  }
  void make_from(const canopen::CanopenConfig& config) {
    master_ = std::make_unique<canopen::CanopenInterface>(config, [this](std::span<const std::uint16_t>, std::size_t) {
      return Expected<std::unique_ptr<CanPort>>(wire_.open());
    });
    commands_.assign(master_->axis_count(), {});
    feedback_.assign(master_->axis_count(), {});
  }
  void start() {
    const auto started = master_->start();
    ASSERT_TRUE(started.has_value()) << started.error().message;
    cycle();
  }
  [[nodiscard]] std::string start_error() {
    const auto started = master_->start();
    return started ? "it started" : started.error().message;
  }

  /// One cycle with every axis wanted as `wish`.
  void cycle(DriveWish wish = DriveWish::Off, bool reset = false) {
    for (std::size_t i = 0; i < commands_.size(); ++i) {
      DriveCommand& command = commands_[i];
      command.controlword = next_controlword(feedback_[i].statusword, wish, reset, command.controlword);
    }
    sound_ = master_->exchange(commands_, feedback_);
    wire_.pass(std::chrono::milliseconds(1));
  }
  void cycles(int count, DriveWish wish) {
    for (int i = 0; i < count; ++i) cycle(wish);
  }
  void enable_all() {
    for (int i = 0; i < 20; ++i) cycle(DriveWish::Operational);
    for (const DriveFeedback& words : feedback_) {
      ASSERT_TRUE(words.online);
      ASSERT_EQ(drive_state(words.statusword), DriveState::OperationEnabled);
    }
  }

  CanWire wire_;
  std::unique_ptr<canopen::CanopenInterface> master_;
  std::vector<DriveCommand> commands_;
  std::vector<DriveFeedback> feedback_;
  bool sound_ = false;
};

}  // namespace rmac::fieldbus::test
