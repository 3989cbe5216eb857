#include "rmac/fieldbus/canopen/canopen_config.hpp"

#include <gtest/gtest.h>

#include <random>

#include "rmac/fieldbus/can/can_load.hpp"
#include "rmac/fieldbus/canopen/bus_load.hpp"
#include "unit/fieldbus/canopen/canopen_bench.hpp"

namespace {

using namespace rmac;
using namespace rmac::fieldbus;
using namespace rmac::fieldbus::canopen;
using rmac::fieldbus::test::CanopenBench;
using rmac::fieldbus::test::Numbers;
using rmac::fieldbus::test::Texts;

std::string refusal(const Numbers& numbers, const Texts& texts = {}) {
  const auto config = read_canopen_config("can0", numbers, texts, 0.001);
  return config ? "accepted" : config.error().message;
}

TEST(CanopenConfig, SaysWhichParameterIsWrongAndWhatIsAllowed) {
  const std::string at = "CANopenInterface, bus can0: ";
  EXPECT_EQ(refusal({}), at + "node is missing; it lists the node id of each axis, for example [1, 2, 3]");
  EXPECT_EQ(refusal({{"node", {0}}}), at + "node is 0; allowed is a whole number from 1 to 127");
  EXPECT_EQ(refusal({{"node", {1, 1}}}),
            at + "node 1 stands twice with axis_in_node 0; each drive needs a node id of its own, and each axis of a "
                 "drive a number of its own");
  EXPECT_EQ(refusal({{"node", {127}}}), at + "node 127 is the master's own id; give master_node or that drive another");
  EXPECT_EQ(refusal({{"node", {1, 2, 3}}, {"mode", {8, 9}}}),
            at + "mode has 2 values for 3 axes; it takes one for all axes or one for each");
  EXPECT_EQ(refusal({{"node", {1}}, {"mode", {2}}}),
            at +
                "mode is 2 for axis 0; allowed are 1, 3 and 4 (profile position, velocity and torque), 7 (interpolated "
                "position), 8, 9 and 10 (cyclic synchronous position, velocity and torque)");
  EXPECT_EQ(refusal({{"node", {1}}}, {{"sync", "never"}}),
            at + "sync is \"never\"; allowed are \"first\", \"last\" and \"external\"");
  EXPECT_EQ(refusal({{"node", {1}}}, {{"rpdo", "6040/16"}}),
            at + "rpdo: \"6040/16\" is no object; write index:sub/bits, whole bytes of 32 bits at most, for example "
                 "6040:00/16");
  EXPECT_EQ(refusal({{"node", {1}}}, {{"rpdo", "6040:00/16 6081:00/32"}}),
            at + "rpdo: 6081h:00 has no value that the master could send");
  EXPECT_EQ(refusal({{"node", {1}}}, {{"rpdo", "6071:00/16"}}), at + "rpdo: 6040h:00 is missing");
  EXPECT_EQ(refusal({{"node", {1}}}, {{"tpdo", "6041:00/16 6064:00/16"}}), at + "tpdo: 6064h:00 has 32 bits, not 16");
  EXPECT_EQ(refusal({{"node", {1}}}, {{"tpdo_0", "6041:00/16 6064:00/32 60FD:00/32"}}),
            at + "tpdo: 10 bytes are mapped; a PDO holds 8");
  EXPECT_EQ(refusal({{"node", {1}}}, {{"setup", "6085:00/8=300"}}),
            at + "setup: \"6085:00/8=300\" is no value to write; write index:sub/bits=value, the value fitting the "
                 "bits, for example 6085:00/32=100000");
  EXPECT_TRUE(
      refusal({{"node", {1}}, {"nod", {1}}}).starts_with(at + "parameter \"nod\" is not understood; there are "));
}

TEST(CanopenConfig, HasASecondPdoOfAnswersThatCounts) {
  const Texts more{{"second_tpdo", "60FD:00/32 60BA:00/32"}};
  const auto config = read_canopen_config("can0", {{"node", {1}}}, more, 0.001);
  ASSERT_TRUE(config) << config.error().message;
  const auto without = read_canopen_config("can0", {{"node", {1}}}, {}, 0.001);
  EXPECT_EQ(bus_load(*config).answer_bits, bus_load(*without).answer_bits + worst_frame_bits(0x281, 8));
  const std::string at = "CANopenInterface, bus can0: ";
  EXPECT_EQ(refusal({{"node", {1}}}, {{"second_tpdo", "60FD:00/32 6064:00/32"}}),
            at + "second_tpdo: 6064h:00 is mapped twice");
  EXPECT_EQ(refusal({{"node", {1}}}, {{"sensor", "6401:01/16"}}),
            at + "sensor of axis 0 is \"6401:01/16\"; it names one object, as it stands in that axis's tpdo or "
                 "second_tpdo, for example 6401:01/16");
  EXPECT_EQ(refusal({{"node", {1}}}, {{"second_tpdo", "60FD:00/16"}}),
            at + "second_tpdo: 60FDh:00 has 32 bits, not 16");
  EXPECT_EQ(refusal({{"node", {1, 1}}, {"axis_in_node", {0, 1}}}, more),
            at + "node 1 has several axes and a second_tpdo, whose identifier is that of the second axis; map all that "
                 "is needed in tpdo");
}

TEST(CanopenConfig, HasASecondPdoOfSetpointsThatCounts) {
  const Texts more{{"second_rpdo", "60B1:00/32 60B2:00/16"}};
  const auto config = read_canopen_config("can0", {{"node", {1}}}, more, 0.001);
  ASSERT_TRUE(config) << config.error().message;
  const auto without = read_canopen_config("can0", {{"node", {1}}}, {}, 0.001);
  EXPECT_EQ(bus_load(*config).setpoint_bits, bus_load(*without).setpoint_bits + worst_frame_bits(0x301, 6));
  EXPECT_EQ(frames_of_cycle(*config), frames_of_cycle(*without) + 1);
  const std::string at = "CANopenInterface, bus can0: ";
  EXPECT_EQ(refusal({{"node", {1}}}, {{"second_rpdo", "6040:00/16"}}), at + "second_rpdo: 6040h:00 is mapped twice");
  EXPECT_EQ(refusal({{"node", {1}}}, {{"second_rpdo", "6081:00/32"}}),
            at + "second_rpdo: 6081h:00 has no value that the master could send");
  const auto fits = [](std::vector<double> nodes, double period_s) {
    const Texts both{{"rpdo", "6040:00/16 607A:00/32"}, {"second_rpdo", "60B1:00/32 60B2:00/16"}};
    const auto bus = read_canopen_config("can0", {{"node", std::move(nodes)}, {"mode", {8}}}, both, period_s);
    return bus && check_bus_load(*bus).has_value();
  };
  EXPECT_TRUE(fits({1, 2}, 0.001));
  EXPECT_FALSE(fits({1, 2, 3}, 0.001));
  EXPECT_TRUE(fits({1, 2, 3, 4}, 0.002));
  EXPECT_FALSE(fits({1, 2, 3, 4, 5}, 0.002));
  const std::string several =
      at +
      "node 1 has several axes and a second_rpdo, whose identifier is that of the second axis; map all that is "
      "needed in rpdo";
  EXPECT_EQ(refusal({{"node", {1, 1}}, {"axis_in_node", {0, 1}}}, more), several);
  EXPECT_EQ(refusal({{"node", {1}}, {"axis_in_node", {1}}}, more), several);
}

TEST(CanopenConfig, HasDrivesThatHomeTellTheirModeAndWritesHowTheyDo) {
  const auto config = read_canopen_config("can0",
                                          {{"node", {1, 2}},
                                           {"homing_method", {-3, 0}},
                                           {"homing_speed", {70000}},
                                           {"homing_speed_slow", {500}},
                                           {"homing_acceleration", {100000}},
                                           {"home_offset", {-2}}},
                                          {{"setup", "6085:00/32=1"}}, 0.001);
  ASSERT_TRUE(config) << config.error().message;
  const AxisConfig& homes = config->axes[0];
  EXPECT_TRUE(homes.homes);
  EXPECT_EQ(homes.setpoints[1].object.index, 0x6060);
  EXPECT_EQ(homes.answers[1].object.index, 0x6061);
  ASSERT_EQ(homes.setup.size(), 6U);
  const auto written = [&](std::size_t i, std::uint16_t index, std::uint8_t sub, std::vector<std::uint8_t> bytes) {
    EXPECT_EQ(homes.setup[i].object.index, index);
    EXPECT_EQ(homes.setup[i].object.sub, sub);
    EXPECT_EQ(homes.setup[i].bytes, bytes);
  };
  written(0, 0x6098, 0, {0xFD});
  written(1, 0x6099, 1, {0x70, 0x11, 1, 0});
  written(2, 0x6099, 2, {0xF4, 1, 0, 0});
  written(3, 0x609A, 0, {0xA0, 0x86, 1, 0});
  written(4, 0x607C, 0, {0xFE, 0xFF, 0xFF, 0xFF});
  written(5, 0x6085, 0, {1, 0, 0, 0});
  EXPECT_FALSE(config->axes[1].homes);
  EXPECT_EQ(config->axes[1].setup.size(), 1U);
  EXPECT_EQ(config->axes[1].setpoints.size(), 2U);
}

TEST(CanopenConfig, WaitsForAnSdoAnswerAsLongAsTheSlowestAxisOfANodeTakes) {
  const auto config = read_canopen_config(
      "can0", {{"node", {1, 1, 2}}, {"axis_in_node", {0, 1, 0}}, {"sdo_timeout_ms", {700, 900, 30}}}, {}, 0.004);
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(patience_with(*config, 1, nullptr).sdo_timeout.count(), 900);
  EXPECT_EQ(patience_with(*config, 2, nullptr).sdo_timeout.count(), 30);
  EXPECT_EQ(patience_with(*read_canopen_config("can0", {{"node", {1}}}, {}, 0.001), 1, nullptr).sdo_timeout.count(),
            500);
  EXPECT_EQ(refusal({{"node", {1}}, {"sdo_timeout_ms", {5}}}),
            "CANopenInterface, bus can0: sdo_timeout_ms is 5; allowed is a whole number from 10 to 60000");
}

TEST(CanopenConfig, CountsAnRpdoThatTwoDrivesShareOnce) {
  const Texts halves{{"rpdo_0", "6040:00/16 6071:00/16 0007:00/32"},
                     {"rpdo_1", "0007:00/32 6040:00/16 6071:00/16"},
                     {"rpdo_2", "6040:00/16 6071:00/16 0007:00/32"},
                     {"rpdo_3", "0007:00/32 6040:00/16 6071:00/16"},
                     {"tpdo", "6041:00/16 6064:00/32"}};
  const auto shared = read_canopen_config("can0", {{"node", {1, 2, 3, 4}}, {"rpdo_node", {1, 1, 3, 3}}}, halves, 0.001);
  ASSERT_TRUE(shared) << shared.error().message;
  EXPECT_EQ(bus_load(*shared).setpoint_bits, worst_frame_bits(0x201, 8) + worst_frame_bits(0x203, 8));
  EXPECT_TRUE(check_bus_load(*shared)) << "four axes at 1 kHz";
  const auto apart = read_canopen_config("can0", {{"node", {1, 2, 3, 4}}}, halves, 0.001);
  ASSERT_TRUE(apart) << apart.error().message;
  EXPECT_FALSE(check_bus_load(*apart));
}

TEST(CanopenConfig, RefusesAnRpdoThatIsSharedWrongly) {
  const std::string at = "CANopenInterface, bus can0: ";
  EXPECT_EQ(refusal({{"node", {1, 2}}, {"rpdo_node", {1, 3}}}),
            at + "rpdo_node is 3 for node 2, and no drive of this bus has that id");
  EXPECT_EQ(
      refusal({{"node", {1, 2}}, {"rpdo_node", {1, 1}}}),
      at + "nodes 1 and 2 share an RPDO, and both map some of its bytes; where one maps a setpoint the other needs "
           "the dummies 0005:00/8, 0006:00/16 or 0007:00/32");
  EXPECT_EQ(refusal({{"node", {1, 2}}, {"rpdo_node", {1, 1}}}, {{"rpdo_1", "0007:00/32 6040:00/16 6071:00/16"}}),
            at + "nodes 1 and 2 share an RPDO, and map 4 and 8 bytes of it; fill it up with the dummies 0005:00/8, "
                 "0006:00/16 and 0007:00/32");
}

TEST(CanopenConfig, RefusesHomingThatCouldNotBeTold) {
  const std::string at = "CANopenInterface, bus can0: ";
  EXPECT_EQ(refusal({{"node", {1}}, {"homing_method", {17}}}, {{"rpdo", "6040:00/16 6071:00/16"}}),
            at + "axis 0 has a homing_method, so rpdo must hold 6060:00/8 and tpdo 6061:00/8, or neither be given");
  EXPECT_EQ(refusal({{"node", {1}}, {"homing_method", {17}}, {"mode", {3}}}),
            at + "homing_method is 17 for axis 0, which does not move a joint");
  EXPECT_EQ(refusal({{"node", {1}}, {"homing_method", {38}}}),
            at + "homing_method is 38; allowed is a whole number from -128 to 37");
}

TEST(CanopenConfig, TakesWhatIsSaidOfItsBusAlone) {
  const Numbers numbers{{"can0.node", {1, 2}}, {"can1.node", {3}}, {"heartbeat_ms", {20}}, {"can1.heartbeat_ms", {40}}};
  const auto first = read_canopen_config("can0", numbers, {}, 0.001);
  const auto second = read_canopen_config("can1", numbers, {}, 0.001);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->axes.size(), 2U);
  EXPECT_EQ(first->heartbeat.count(), 20);
  EXPECT_EQ(second->axes.at(0).node, 3);
  EXPECT_EQ(second->heartbeat.count(), 40);
}

TEST(CanopenConfig, MapsByTextForAllAxesOrOne) {
  const auto config = read_canopen_config(
      "can0", {{"node", {1, 2}}},
      {{"tpdo", "6041:00/16 6064:00/32"}, {"tpdo_1", "6041:00/16"}, {"setup_1", "2000:01/16=-1"}}, 0.001);
  ASSERT_TRUE(config.has_value());
  EXPECT_EQ(mapped_bytes(config->axes[0].answers), 6U);
  EXPECT_EQ(mapped_bytes(config->axes[1].answers), 2U);
  EXPECT_TRUE(config->axes[0].setup.empty());
  EXPECT_EQ(config->axes[1].setup.at(0).bytes, (std::vector<std::uint8_t>{0xFF, 0xFF}));
}

/// As many axes as the load check accepts.
std::size_t most_axes(const std::string& rpdo, const std::string& tpdo, double period_s) {
  Numbers numbers{{"node", {}}};
  for (int node = 1;; ++node) {
    numbers["node"].push_back(node);
    const auto config = read_canopen_config("can0", numbers, {{"rpdo", rpdo}, {"tpdo", tpdo}}, period_s);
    if (!config || !check_bus_load(*config)) return static_cast<std::size_t>(node) - 1;
  }
}

TEST(BusLoad, CountsAFrameAtItsLongest) {
  EXPECT_EQ(worst_frame_bits(0), 55U);
  EXPECT_EQ(worst_frame_bits(1), 65U);
  EXPECT_EQ(worst_frame_bits(6), 115U);
  EXPECT_EQ(worst_frame_bits(8), 135U);
}

TEST(BusLoad, AcceptsAsManyAxesAsTheBusCarries) {
  const std::string eight = "6040:00/16 607A:00/32 6071:00/16";
  const std::string eight_back = "6041:00/16 6064:00/32 6077:00/16";
  const std::string six = "6040:00/16 607A:00/32";
  const std::string six_back = "6041:00/16 6064:00/32";
  EXPECT_EQ(most_axes(eight, eight_back, 0.001), 2U);
  EXPECT_EQ(most_axes(eight, eight_back, 0.002), 5U);
  EXPECT_EQ(most_axes(eight, eight_back, 0.004), 11U);
  EXPECT_EQ(most_axes(six, six_back, 0.001), 3U);
  EXPECT_EQ(most_axes(six, six_back, 0.002), 6U);
  EXPECT_EQ(most_axes(six, six_back, 0.004), 14U);
}

TEST(BusLoad, RefusesAMachineAboveItsShareNamingAxesCycleAndBus) {
  const auto config = read_canopen_config("can0", {{"node", {1, 2, 3, 4}}}, {}, 0.001);
  ASSERT_TRUE(config.has_value());
  const auto checked = check_bus_load(*config);
  ASSERT_FALSE(checked.has_value());
  EXPECT_EQ(
      checked.error().message,
      "bus can0: 4 axes in a cycle of 1 ms need 951 bits, 95.1 % of the 1000 that 1000000 bit/s give; its share is "
      "80 %. Take a cycle of 1.19 ms or more, spread the axes over several buses, or map less");
}

/// Bits of a frame on the wire, stuffed as ISO 11898-1 says, interframe space included.
std::uint32_t counted_bits(const CanFrame& frame) {
  std::vector<int> bits{0};  // start of frame
  const auto add = [&](std::uint32_t value, int count) {
    for (int i = count - 1; i >= 0; --i) bits.push_back(static_cast<int>(value >> i & 1U));
  };
  add(frame.id, 11);
  add(0, 3);  // no remote request, base format, reserved
  add(frame.size, 4);
  for (std::size_t i = 0; i < frame.size; ++i) add(frame.data[i], 8);
  std::uint32_t crc = 0;
  for (const int bit : bits) {
    const bool invert = (static_cast<std::uint32_t>(bit) ^ (crc >> 14 & 1U)) != 0;
    crc = (crc << 1 & 0x7FFF) ^ (invert ? 0x4599U : 0U);
  }
  add(crc, 15);
  std::uint32_t stuffed = 0;
  int run = 0;
  int last = -1;
  for (const int bit : bits) {
    run = bit == last ? run + 1 : 1;
    last = bit;
    if (run == 5) {
      ++stuffed;
      last = 1 - bit;
      run = 1;
    }
  }
  constexpr std::uint32_t kAfterCrc = 10;
  constexpr std::uint32_t kInterframe = 3;
  return static_cast<std::uint32_t>(bits.size()) + stuffed + kAfterCrc + kInterframe;
}

TEST(BusLoad, IsNeverBelowWhatAFrameTakes) {
  std::mt19937 random(11898);
  for (std::uint8_t size = 0; size <= 8; ++size) {
    std::uint32_t most = 0;
    for (int i = 0; i < 20000; ++i) {
      CanFrame frame{.id = static_cast<std::uint16_t>(random() & 0x7FF), .size = size};
      // Long runs of equal bits are what is stuffed most.
      constexpr std::uint8_t kPatterns[] = {0x00, 0xFF, 0xF0, 0x0F, 0x87, 0x78, 0xC3, 0x3C, 0xE1, 0x1E};
      frame.data.fill(kPatterns[random() % std::size(kPatterns)]);
      const bool mixed = random() % 2 == 0;
      for (auto& byte : frame.data) byte = mixed ? kPatterns[random() % std::size(kPatterns)] : byte;
      const std::uint32_t bits = counted_bits(frame);
      ASSERT_LE(bits, worst_frame_bits(frame.id, size)) << std::hex << frame.id;
      ASSERT_LE(worst_frame_bits(frame.id, size), worst_frame_bits(size)) << std::hex << frame.id;
      ASSERT_GE(bits, least_frame_bits(size));
      most = std::max(most, bits);
    }
    EXPECT_GE(most, worst_frame_bits(size) * 90 / 100) << int{size};
  }
}

TEST_F(CanopenBench, SendsNoMoreBitsThanPredicted) {
  std::mt19937 random(200);
  for (int run = 0; run < 200; ++run) {
    master_.reset();
    wire_ = {};
    Numbers numbers{{"node", {}}, {"mode", {}}, {"load_share", {100}}, {"bit_rate", {1e6}}};
    const int axes = 1 + static_cast<int>(random() % 3);
    for (int i = 0; i < axes; ++i) {
      const auto node = static_cast<std::uint8_t>(1 + i * 3 + static_cast<int>(random() % 3));
      constexpr double kModes[] = {3, 8, 9, 10};
      numbers["node"].push_back(node);
      numbers["mode"].push_back(kModes[random() % 4]);
      wire_.add(node);
    }
    const Texts texts{{"tpdo", random() % 2 == 0 ? "6041:00/16 6064:00/32" : "6041:00/16 6064:00/32 6077:00/16"}};
    make(numbers, texts);
    start();
    enable_all();
    std::uint32_t counted = 0;
    wire_.listen = [&](const CanFrame& frame) { counted += frame.id < 0x580 ? counted_bits(frame) : 0; };
    constexpr int kCycles = 20;
    for (int i = 0; i < kCycles; ++i) {
      for (DriveCommand& command : commands_) {
        command.target_position_counts = static_cast<std::int32_t>(random());
        command.target_velocity_rpm = static_cast<std::int32_t>(random() % 6000);
        command.target_torque_permille = static_cast<std::int16_t>(random());
      }
      cycle(DriveWish::Operational);
    }
    wire_.listen = nullptr;
    const auto config = read_canopen_config("can0", numbers, texts, kPeriodS);
    ASSERT_TRUE(config.has_value());
    ASSERT_LE(counted, kCycles * bus_load(*config).cyclic_bits());
  }
}

}  // namespace
