#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "gateway/simulators/vdrive/node.hpp"
#include "gateway/simulators/vdrive/sheet.hpp"

namespace rmac::vdrive::test {

inline const fieldbus::eds::DeviceDescription& sheet() {
  static const auto kRead = fieldbus::eds::parse_device_description(sheet_text(), "rmac-vdrive.eds");
  return kRead.value();
}

inline Bytes little_endian(std::int64_t value, std::size_t size) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i)
    bytes[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
  return bytes;
}

inline CanFrame frame(std::uint16_t id, const Bytes& data) {
  CanFrame made;
  made.id = id;
  made.size = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), made.data.begin());
  return made;
}

/// One node, asked frame by frame as anyone on the bus could; its clock is the test's.
class NodeBench : public testing::Test {
 protected:
  static constexpr std::uint8_t kId = 5;

  NodeBench() { node_.power_on(now_); }

  void receive(std::uint16_t id, const Bytes& data) {
    node_.receive(frame(id, data), now_);
    collect();
  }
  void pass(double seconds) {
    for (const Time end = now_ + std::chrono::duration_cast<Time>(std::chrono::duration<double>(seconds));
         now_ < end;) {
      now_ += std::chrono::microseconds(500);
      node_.poll(now_);
      collect();
    }
  }
  void nmt(std::uint8_t command) { receive(0, {command, kId}); }
  void sync() { receive(0x80, {}); }

  /// An expedited download; the abort code, or 0.
  std::uint32_t write(std::uint16_t index, std::uint8_t sub, std::int64_t value, std::size_t size) {
    Bytes request{static_cast<std::uint8_t>(0x23 | (4 - size) << 2), static_cast<std::uint8_t>(index),
                  static_cast<std::uint8_t>(index >> 8), sub};
    const Bytes bytes = little_endian(value, 4);
    request.insert(request.end(), bytes.begin(), bytes.end());
    receive(0x600 + kId, request);
    const CanFrame answer = last(0x580 + kId);
    return answer.data[0] == 0x60 ? 0 : number(answer, 4, 4);
  }
  std::int64_t read(std::uint16_t index, std::uint8_t sub = 0) {
    receive(0x600 + kId,
            {0x40, static_cast<std::uint8_t>(index), static_cast<std::uint8_t>(index >> 8), sub, 0, 0, 0, 0});
    const CanFrame answer = last(0x580 + kId);
    EXPECT_EQ(answer.data[0] & 0xE3, 0x43) << std::hex << index << ": " << number(answer, 4, 4);
    const unsigned size = 4U - (answer.data[0] >> 2 & 3U);
    const std::uint32_t raw = number(answer, 4, size);
    const unsigned unused = 32 - 8 * size;
    return static_cast<std::int32_t>(raw << unused) >> unused;
  }
  std::uint16_t status() { return static_cast<std::uint16_t>(read(0x6041)); }
  /// The state's bits of the statusword.
  std::uint16_t state() { return status() & 0x6F; }
  void control(std::uint16_t word) {
    EXPECT_EQ(write(0x6040, 0, word, 2), 0U);
    pass(0.001);
  }
  void enable(int mode) {
    EXPECT_EQ(write(0x6060, 0, mode, 1), 0U);
    for (const int word : {0x06, 0x07, 0x0F}) control(static_cast<std::uint16_t>(word));
    ASSERT_EQ(state(), 0x27);
  }

  [[nodiscard]] static std::uint32_t number(const CanFrame& of, unsigned at, unsigned bytes) {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < bytes; ++i) value |= static_cast<std::uint32_t>(of.data.at(at + i)) << (8 * i);
    return value;
  }
  /// The latest frame of `id`; of size 0 and identifier 0 where there was none.
  [[nodiscard]] CanFrame last(std::uint16_t id) const {
    for (auto at = sent_.rbegin(); at != sent_.rend(); ++at) {
      if (at->id == id) return *at;
    }
    return {};
  }
  [[nodiscard]] std::size_t count(std::uint16_t id) const {
    return static_cast<std::size_t>(
        std::count_if(sent_.begin(), sent_.end(), [&](const CanFrame& f) { return f.id == id; }));
  }
  void collect() {
    for (const CanFrame& out : node_.take_output(now_)) sent_.push_back(out);
  }

  Node node_{sheet(), kId, fieldbus::AxisPlantParameters()};
  Time now_{std::chrono::seconds(1)};
  std::vector<CanFrame> sent_;
};

}  // namespace rmac::vdrive::test
