#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>

#include "rmac/motion/ports/digital_io_interface.hpp"

namespace rmac::conformance {

/// The device's side of an input and an output, and what passes between two cycles.
struct IoTerminals {
  std::size_t input = 0;
  std::size_t output = 0;
  std::function<void(bool on)> turn_input;
  std::function<bool()> output_is_on;
  std::function<void()> pass = [] {};
};

/// What every digital I/O interface must keep: it has what it says it has, begins with its outputs off, carries bits
/// both ways and no others, leaves its outputs off whatever it is told after `stop`, and can be started again.
class DigitalIoConformance {
 public:
  DigitalIoConformance(DigitalIoInterface& io, IoTerminals terminals) : io_(io), at_(std::move(terminals)) {}

  void check() {
    EXPECT_NE(io_.input_bits() & bit(at_.input), 0U);
    EXPECT_NE(io_.output_bits() & bit(at_.output), 0U);
    for (int start = 0; start < 2 && !testing::Test::HasFailure(); ++start) check_run();
  }

 private:
  static std::uint64_t bit(std::size_t number) { return std::uint64_t{1} << number; }

  void check_run() {
    at_.turn_input(false);
    const auto started = io_.start();
    ASSERT_TRUE(started.has_value()) << started.error().message;
    EXPECT_FALSE(at_.output_is_on()) << "before anybody asked for it";
    const std::uint64_t others = ~(bit(at_.input));
    cycle_until(
        0, [&] { return !input_is_on(); }, "the input is off");
    const std::uint64_t rest = inputs_ & others;
    for (int turn = 0; turn < 3; ++turn) {
      at_.turn_input(true);
      cycle_until(
          0, [&] { return input_is_on(); }, "the input comes on");
      EXPECT_EQ(inputs_ & others, rest) << "no other input follows";
      EXPECT_FALSE(at_.output_is_on()) << "an input is no output";
      cycle_until(bit(at_.output), at_.output_is_on, "the output comes on");
      at_.turn_input(false);
      cycle_until(
          bit(at_.output), [&] { return !input_is_on(); }, "the input goes off");
      EXPECT_TRUE(at_.output_is_on());
      cycle_until(
          0, [&] { return !at_.output_is_on(); }, "the output goes off");
    }
    cycle_until(bit(at_.output), at_.output_is_on, "the output comes on before the end");
    io_.stop();
    EXPECT_FALSE(at_.output_is_on()) << "after the end";
  }
  [[nodiscard]] bool input_is_on() const { return (inputs_ & bit(at_.input)) != 0; }

  /// A device may take its time, and may have none left for an answer that is not old; not for ever.
  void cycle_until(std::uint64_t outputs, const std::function<bool()>& reached, const char* what) {
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!io_.exchange(outputs, inputs_) || !reached()) {
      ASSERT_LT(std::chrono::steady_clock::now(), give_up) << what;
      at_.pass();
    }
  }

  DigitalIoInterface& io_;
  IoTerminals at_;
  std::uint64_t inputs_ = 0;
};

}  // namespace rmac::conformance
