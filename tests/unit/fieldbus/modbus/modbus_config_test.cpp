#include "rmac/fieldbus/modbus/modbus_config.hpp"

#include <gmock/gmock.h>

namespace rmac::fieldbus::modbus {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

const Texts kTcp{{"address", "127.0.0.1"}, {"map", "a map"}};
const Texts kSerial{{"device", "/dev/ttyS0"}, {"map", "a map"}};

Expected<SpindleMap> spindle_map_named(const std::string& name) {
  if (name == "none") return failure(MinorCode::InvalidParameterValue, "there is none");
  SpindleMap made;
  made.name = name;
  if (name == "parts") made.speed_command_unit = SpindleMap::Unit::OfMaximum;
  return made;
}

Expected<SpindleLineConfig> read(const Numbers& numbers, const Texts& texts = kTcp) {
  return read_spindle_line("spindle0", numbers, texts, spindle_map_named);
}

std::string said(const Numbers& numbers, const Texts& texts = kTcp) {
  const auto made = read(numbers, texts);
  return made ? "fine" : made.error().message;
}

Expected<IoLineConfig> read_io(const Numbers& numbers, const Texts& texts = kTcp) {
  return read_io_line(numbers, texts, [](const std::string& name) -> Expected<IoMap> {
    if (name == "none") return failure(MinorCode::InvalidParameterValue, "there is none");
    IoMap made;
    made.name = name;
    return made;
  });
}

std::string io_said(const Numbers& numbers, const Texts& texts = kTcp) {
  const auto made = read_io(numbers, texts);
  return made ? "fine" : made.error().message;
}

TEST(ModbusConfig, HasTheDefaultsOfItsDocumentation) {
  const auto made = read({{"slave", {1}}});
  ASSERT_TRUE(made) << made.error().message;
  const auto& tcp = std::get<TcpEndpoint>(made->line.endpoint);
  EXPECT_EQ(tcp.address, "127.0.0.1");
  EXPECT_EQ(tcp.port, 502);
  EXPECT_EQ(made->line.deadline, 200ms);
  EXPECT_EQ(made->line.period, 50ms);
  EXPECT_EQ(made->line.first_pause, 100ms);
  EXPECT_EQ(made->line.longest_pause, 5s);
  EXPECT_EQ(made->stale, 1s);
  EXPECT_EQ(made->busy, 3s);
  EXPECT_EQ(made->boot_timeout, 5s);
  ASSERT_EQ(made->axes.size(), 1U);
  EXPECT_EQ(made->axes[0].slave, 1);
  EXPECT_EQ(made->axes[0].rpm_per_hz, 60);
  EXPECT_EQ(made->axes[0].maximum_hz, 0);
  EXPECT_EQ(made->axes[0].map.name, "a map");
  const auto serial = read({{"slave", {1}}}, kSerial);
  ASSERT_TRUE(serial) << serial.error().message;
  const auto& rtu = std::get<RtuEndpoint>(serial->line.endpoint);
  EXPECT_EQ(rtu.device, "/dev/ttyS0");
  EXPECT_EQ(rtu.bit_rate, 9600);
  EXPECT_EQ(rtu.parity, 'N');
  EXPECT_EQ(rtu.stop_bits, 1);
}

TEST(ModbusConfig, TakesWhatIsGiven) {
  const auto made = read({{"slave", {7, 8}},
                          {"tcp_port", {1502}},
                          {"deadline_ms", {20}},
                          {"period_ms", {10}},
                          {"stale_ms", {31}},
                          {"busy_ms", {0}},
                          {"boot_timeout_s", {0.25}},
                          {"rpm_per_hz", {30, 12.5}},
                          {"spindle0.maximum_hz", {400}}},
                         {{"address", "::1"}, {"map", "a map"}, {"map_1", "parts"}});
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(std::get<TcpEndpoint>(made->line.endpoint).port, 1502);
  EXPECT_EQ(made->line.deadline, 20ms);
  EXPECT_EQ(made->line.period, 10ms);
  EXPECT_EQ(made->stale, 31ms);
  EXPECT_EQ(made->busy, 0ms);
  EXPECT_EQ(made->boot_timeout, 250ms);
  ASSERT_EQ(made->axes.size(), 2U);
  EXPECT_EQ(made->axes[0].slave, 7);
  EXPECT_EQ(made->axes[1].slave, 8);
  EXPECT_EQ(made->axes[0].rpm_per_hz, 30);
  EXPECT_EQ(made->axes[1].rpm_per_hz, 12.5);
  EXPECT_EQ(made->axes[1].maximum_hz, 400);
  EXPECT_EQ(made->axes[0].map.name, "a map");
  EXPECT_EQ(made->axes[1].map.name, "parts");
  const auto serial = read({{"slave", {247}}, {"bit_rate", {19200}}, {"stop_bits", {2}}},
                           {{"device", "/dev/ttyUSB0"}, {"parity", "E"}, {"map", "a map"}});
  ASSERT_TRUE(serial) << serial.error().message;
  const auto& rtu = std::get<RtuEndpoint>(serial->line.endpoint);
  EXPECT_EQ(rtu.bit_rate, 19200);
  EXPECT_EQ(rtu.parity, 'E');
  EXPECT_EQ(rtu.stop_bits, 2);
}

TEST(ModbusConfig, TakesTheEndsOfEachRangeAndNothingBeyond) {
  struct Range {
    const char* name;
    double least, most;
    bool whole;
  };
  const std::vector<Range> ranges{{"tcp_port", 1, 65535, true},        {"bit_rate", 1200, 921600, true},
                                  {"stop_bits", 1, 2, true},           {"deadline_ms", 5, 60000, true},
                                  {"period_ms", 1, 60000, true},       {"busy_ms", 0, 60000, true},
                                  {"boot_timeout_s", 0.1, 600, false}, {"rpm_per_hz", 1e-3, 1e5, false},
                                  {"maximum_hz", 0, 1e5, false},       {"stale_ms", 10, 60000, true}};
  for (const Range& range : ranges) {
    const auto with = [&](double value) { return said({{"slave", {1}}, {range.name, {value}}}); };
    const std::string refused = std::string(range.name) + " is ";
    for (const double end : {range.least, range.most}) {
      // Another rule may refuse it: 60 s of waiting leave nothing that is fresh. Its range does not.
      EXPECT_THAT(with(end), Not(HasSubstr("; allowed is a"))) << range.name << " " << end;
    }
    const double step = range.whole ? 1 : 1e-4;
    EXPECT_THAT(with(range.least - step), HasSubstr(refused)) << range.name;
    EXPECT_THAT(with(range.most + step), HasSubstr(refused)) << range.name;
    EXPECT_EQ(with(range.least + (range.most - range.least) / 2 + 0.25).find("whole") != std::string::npos, range.whole)
        << range.name;
  }
}

TEST(ModbusConfig, WantsValuesToStayFreshForLongerThanNewOnesTake) {
  const auto with = [](double stale) {
    return said({{"slave", {1}}, {"period_ms", {30}}, {"deadline_ms", {50}}, {"stale_ms", {stale}}});
  };
  EXPECT_EQ(with(81), "fine");
  EXPECT_EQ(
      with(80),
      "ModbusInterface, bus spindle0: stale_ms is 80; it must be above period_ms and deadline_ms together, 80, or "
      "values would be stale before newer ones can come");
}

TEST(ModbusConfig, WantsALineOfOneKind) {
  const std::string either = "either \"address\" (the IP address of a TCP device) or \"device\"";
  EXPECT_THAT(said({{"slave", {1}}}, {{"map", "a map"}}), HasSubstr(either));
  EXPECT_THAT(said({{"slave", {1}}}, {{"map", "a map"}, {"address", "::1"}, {"device", "/dev/ttyS0"}}),
              HasSubstr(either));
  EXPECT_THAT(said({{"slave", {1}}}, {{"map", "a map"}, {"device", "/dev/ttyS0"}, {"parity", ""}}),
              HasSubstr("parity is \"\"; there are N, E and O"));
  EXPECT_THAT(said({{"slave", {1}}}, {{"map", "a map"}, {"device", "/dev/ttyS0"}, {"parity", "EVEN"}}),
              HasSubstr("parity is \"EVEN\"; there are N, E and O"));
  EXPECT_THAT(said({{"slave", {1}}}, {{"map", "a map"}, {"device", "/dev/ttyS0"}, {"parity", "X"}}),
              HasSubstr("parity 'X'"));
}

TEST(ModbusConfig, KnowsTheNumbersThatSlavesHave) {
  EXPECT_EQ(said({{"slave", {247}}}), "fine");
  EXPECT_THAT(said({{"slave", {248}}}), HasSubstr("slave is 248; slaves are 1 to 247"));
  EXPECT_EQ(said({{"slave", {255}}}), "fine") << "a TCP device without a gateway";
  EXPECT_THAT(said({{"slave", {255}}}, kSerial), HasSubstr("slave is 255; slaves are 1 to 247"));
  EXPECT_THAT(said({}), HasSubstr("slave is missing; it lists the slave number of each axis"));
  EXPECT_THAT(said({{"slave", {3, 3}}}), HasSubstr("slave 3 stands twice; each drive needs a number of its own"));
  EXPECT_EQ(said({{"slave", {3, 4}}}), "fine");
}

TEST(ModbusConfig, NamesWhatIsWrongWithAMap) {
  const std::string at = "ModbusInterface, bus spindle0: ";
  EXPECT_EQ(said({{"slave", {1}}}, {{"address", "::1"}}),
            at + "map is missing; it names the register map of the drive");
  EXPECT_EQ(said({{"slave", {1}}}, {{"address", "::1"}, {"map", "none"}}), at + "map: there is none");
  EXPECT_THAT(said({{"slave", {1}}}, {{"address", "::1"}, {"map", "parts"}}),
              HasSubstr("maximum_hz is missing; parts takes its speed in parts of the largest frequency"));
  EXPECT_EQ(said({{"slave", {1}}, {"maximum_hz", {1}}}, {{"address", "::1"}, {"map", "parts"}}), "fine");
}

TEST(ModbusConfig, RefusesAParameterThatItDoesNotKnow) {
  EXPECT_THAT(said({{"slave", {1}}, {"speed", {1}}}), HasSubstr("parameter \"speed\" is not understood; there are "));
  EXPECT_THAT(io_said({{"speed", {1}}}), HasSubstr("parameter \"speed\" is not understood; there are "));
  EXPECT_THAT(io_said({{"busy_ms", {1}}}), HasSubstr("not understood")) << "inputs have no such time";
}

TEST(ModbusIoConfig, HasOneDeviceAndOneMap) {
  const auto made = read_io({});
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->slave, 1);
  EXPECT_EQ(made->map.name, "a map");
  EXPECT_EQ(made->stale, 1s);
  EXPECT_EQ(read_io({{"slave", {9}}})->slave, 9);
  EXPECT_THAT(io_said({{"slave", {1, 2}}}), HasSubstr("ModbusIOInterface: slave has several values; it takes one"));
  EXPECT_EQ(io_said({}, {{"address", "::1"}}),
            "ModbusIOInterface: map is missing; it names the register map of the device");
  EXPECT_EQ(io_said({}, {{"address", "::1"}, {"map", "none"}}), "ModbusIOInterface: map: there is none");
}

}  // namespace
}  // namespace rmac::fieldbus::modbus
