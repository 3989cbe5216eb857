#pragma once

#include <random>
#include <vector>

#include "rmac/fieldbus/can/can_port.hpp"

namespace rmac::fieldbus::test {

/// A bus on which every frame that is sent draws a few that are noise: with the identifier of its answer mostly, often
/// a first byte of `answers`, sometimes the object that was asked for. Time passes only when someone waits.
class NoisyPort final : public CanPort {
 public:
  NoisyPort(unsigned seed, std::vector<std::uint8_t> answers) : random_(seed), answers_(std::move(answers)) {}

  bool send(const CanFrame& frame) noexcept override {
    asked_ = frame;
    frames_ = random_() % 4;
    return random_() % 64 != 0;
  }
  bool receive(CanFrame& frame) noexcept override {
    if (frames_ == 0) return false;
    --frames_;
    frame.id = random_() % 8 == 0 ? static_cast<std::uint16_t>(random_() % 0x800) : answer_id();
    frame.size = static_cast<std::uint8_t>(random_() % 4 == 0 ? random_() % 9 : 8);
    for (auto& byte : frame.data) byte = static_cast<std::uint8_t>(random_());
    if (random_() % 2 == 0) frame.data[0] = answers_[random_() % answers_.size()];
    if (random_() % 2 == 0) std::copy_n(asked_.data.begin() + 1, 3, frame.data.begin() + 1);
    return true;
  }
  void wait(std::chrono::nanoseconds at_most) noexcept override {
    now_ += std::max<std::chrono::nanoseconds>(at_most, std::chrono::microseconds(100));
  }
  [[nodiscard]] std::chrono::nanoseconds now() const noexcept override { return now_; }
  [[nodiscard]] CanHealth health() const noexcept override { return {}; }

 private:
  /// Where SDO and LSS answer; to NMT, some node's heartbeat.
  [[nodiscard]] std::uint16_t answer_id() noexcept {
    if (asked_.id == 0x7E5) return 0x7E4;
    if (asked_.id > 0x600 && asked_.id < 0x680) return static_cast<std::uint16_t>(asked_.id - 0x80);
    return static_cast<std::uint16_t>(0x701 + random_() % 0x7F);
  }

  std::mt19937 random_;
  std::vector<std::uint8_t> answers_;
  CanFrame asked_;
  unsigned long frames_ = 0;
  std::chrono::nanoseconds now_{0};
};

/// First bytes of an SDO server's answers (CiA 301, 7.2.4.3).
inline const std::vector<std::uint8_t> kSdoAnswers{0x43, 0x4B, 0x4F, 0x41, 0x40, 0x60, 0x20, 0x30, 0x00, 0x10,
                                                   0x01, 0x81, 0xC0, 0xC6, 0xC1, 0xA0, 0xA1, 0xA2, 0xA4, 0x80};

}  // namespace rmac::fieldbus::test
