// Each parameter of a CANopen bus: what it may be, what it is without being given, and where it goes.
#include <gmock/gmock.h>

#include <random>

#include "rmac/fieldbus/canopen/bus_load.hpp"
#include "rmac/fieldbus/canopen/canopen_config.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using std::chrono::milliseconds;
using Numbers = std::map<std::string, std::vector<double>>;
using Texts = std::map<std::string, std::string>;
using testing::HasSubstr;
using testing::Not;

Expected<CanopenConfig> read(Numbers numbers, const Texts& texts = {}) {
  numbers.try_emplace("node", std::vector<double>{5});
  return read_canopen_config("can0", numbers, texts, 0.001);
}
std::string answer(const Numbers& numbers, const Texts& texts = {}) {
  const auto config = read(numbers, texts);
  return config ? "accepted" : config.error().message;
}
CanopenConfig config_by(const Numbers& numbers, const Texts& texts = {}) {
  const auto config = read(numbers, texts);
  EXPECT_TRUE(config) << config.error().message;
  return config.value_or(CanopenConfig());
}

// Red when a bound is another, or is not held.
TEST(CanopenParameters, MayBeWhatIsWithinTheirBounds) {
  struct Bounds {
    const char* name;
    double least, most;
    bool whole = true;
  };
  constexpr double kUnsigned = 4294967295.0, kSigned = 2147483647.0;
  for (const Bounds& of : {Bounds{"bit_rate", 10e3, 1e6},
                           Bounds{"load_share", 1, 100, false},
                           Bounds{"heartbeat_ms", 2, 10000},
                           Bounds{"time_s", 0, 3600, false},
                           Bounds{"master_node", 1, 127},
                           Bounds{"boot_timeout_s", 0.1, 600, false},
                           Bounds{"abort_connection", -1, 3},
                           Bounds{"missed_answers", 0, 100},
                           Bounds{"node", 1, 127},
                           Bounds{"axis_in_node", 0, 3},
                           Bounds{"rpdo_node", 1, 127},
                           Bounds{"mode", 1, 10},
                           Bounds{"velocity_units_per_rpm", 1e-6, 1e9, false},
                           Bounds{"vendor_id", 0, kUnsigned},
                           Bounds{"product_code", 0, kUnsigned},
                           Bounds{"revision_number", 0, kUnsigned},
                           Bounds{"serial_number", 0, kUnsigned},
                           Bounds{"sdo_timeout_ms", 10, 60000},
                           Bounds{"answer_delay", 1, kMostAnswerDelay},
                           Bounds{"homing_method", -128, 37},
                           Bounds{"homing_speed", 1, kUnsigned},
                           Bounds{"homing_speed_slow", 1, kUnsigned},
                           Bounds{"homing_acceleration", 1, kUnsigned},
                           Bounds{"home_offset", -kSigned, kSigned},
                           Bounds{"polarity", 0, 255},
                           Bounds{"encoder_counts", 1, kUnsigned},
                           Bounds{"encoder_turns", 1, kUnsigned},
                           Bounds{"gear_motor_turns", 1, kUnsigned},
                           Bounds{"gear_shaft_turns", 1, kUnsigned},
                           Bounds{"feed_counts", 1, kUnsigned},
                           Bounds{"feed_shaft_turns", 1, kUnsigned},
                           Bounds{"check_scale", 0, 1}}) {
    const std::string name = of.name, refused = name + " is ";
    const double step = of.whole ? 1 : of.least / 2 + 1e-9;
    for (const double inside : {of.least, of.most}) {
      EXPECT_THAT(answer({{name, {inside}}}), Not(HasSubstr("allowed is"))) << name << " " << inside;
    }
    for (const double outside : {of.least - step, of.most + 1}) {
      EXPECT_THAT(answer({{name, {outside}}}), HasSubstr(refused)) << outside;
      EXPECT_THAT(answer({{name, {outside}}}), HasSubstr("allowed is a ")) << outside;
    }
    const double between = of.least + 0.5;
    EXPECT_EQ(answer({{name, {between}}}).find("allowed is a whole number") != std::string::npos, of.whole) << name;
  }
}

TEST(CanopenParameters, AreTheseWhereNothingIsGiven) {
  const CanopenConfig config = config_by({});
  EXPECT_EQ(config.interface, "can0");
  EXPECT_EQ(config.period, milliseconds(1));
  EXPECT_EQ(config.bit_rate, 1'000'000U);
  EXPECT_EQ(config.load_share, 0.8);
  EXPECT_EQ(config.heartbeat, milliseconds(50));
  EXPECT_EQ(config.time_interval.count(), 0);
  EXPECT_EQ(config.master_node, 127);
  EXPECT_EQ(config.boot_timeout, std::nullopt);
  EXPECT_EQ(config.abort_connection, std::nullopt);
  EXPECT_EQ(config.missed_answers, 1U);
  EXPECT_EQ(config.sync, SyncOrder::Last);
  const AxisConfig& axis = config.axes.at(0);
  EXPECT_EQ(axis.axis_in_node, 0);
  EXPECT_EQ(axis.mode, DriveMode::CyclicSyncTorque);
  EXPECT_EQ(axis.velocity_units_per_rpm, 1);
  EXPECT_EQ(axis.identity.vendor_id | axis.identity.product_code, 0U);
  EXPECT_EQ(axis.identity.revision_number | axis.identity.serial_number, 0U);
  EXPECT_EQ(axis.sdo_timeout, std::nullopt);
  EXPECT_EQ(axis.answer_delay, std::nullopt);
  EXPECT_TRUE(axis.check_scale);
  EXPECT_FALSE(axis.sets_polarity || axis.homes);
  EXPECT_TRUE(axis.setup.empty() && axis.drive.empty());
}

TEST(CanopenParameters, GoWhereTheirNamesSay) {
  const CanopenConfig config = config_by({{"bit_rate", {500e3}},
                                          {"load_share", {37.5}},
                                          {"heartbeat_ms", {20}},
                                          {"time_s", {0.25}},
                                          {"master_node", {3}},
                                          {"boot_timeout_s", {2.5}},
                                          {"abort_connection", {-1}},
                                          {"missed_answers", {7}},
                                          {"mode", {9}},
                                          {"velocity_units_per_rpm", {2.5}},
                                          {"vendor_id", {11}},
                                          {"product_code", {12}},
                                          {"revision_number", {13}},
                                          {"serial_number", {14}},
                                          {"sdo_timeout_ms", {70}},
                                          {"answer_delay", {2}},
                                          {"check_scale", {0}}},
                                         {{"sync", "external"}, {"drive", "none"}});
  EXPECT_EQ(config.bit_rate, 500'000U);
  EXPECT_EQ(config.load_share, 0.375);
  EXPECT_EQ(config.heartbeat, milliseconds(20));
  EXPECT_EQ(config.time_interval, milliseconds(250));
  EXPECT_EQ(config.master_node, 3);
  EXPECT_EQ(config.boot_timeout, milliseconds(2500));
  EXPECT_EQ(config.abort_connection, -1);
  EXPECT_EQ(config.missed_answers, 7U);
  EXPECT_EQ(config.sync, SyncOrder::External);
  const AxisConfig& axis = config.axes.at(0);
  EXPECT_EQ(axis.rpdo_node, 5);
  EXPECT_EQ(axis.mode, DriveMode::CyclicSyncVelocity);
  EXPECT_EQ(axis.velocity_units_per_rpm, 2.5);
  EXPECT_EQ(axis.identity.vendor_id, 11U);
  EXPECT_EQ(axis.identity.product_code, 12U);
  EXPECT_EQ(axis.identity.revision_number, 13U);
  EXPECT_EQ(axis.identity.serial_number, 14U);
  EXPECT_EQ(axis.sdo_timeout, milliseconds(70));
  EXPECT_EQ(axis.answer_delay, 2);
  EXPECT_EQ(axis.drive, "none");
  EXPECT_FALSE(axis.check_scale);
  EXPECT_EQ(config_by({}, {{"sync", "first"}}).sync, SyncOrder::First);
  EXPECT_EQ(config_by({}, {{"sync", "last"}}).sync, SyncOrder::Last);
}

/// CiA 402-2: sense and units of positions.
TEST(CanopenParameters, OfUnitsAreWrittenToTheirObjects) {
  struct Unit {
    const char* name;
    ObjectAddress object;
    std::size_t bytes;
  };
  for (const Unit& unit :
       {Unit{"polarity", {0x607E, 0}, 1}, Unit{"encoder_counts", {0x608F, 1}, 4}, Unit{"encoder_turns", {0x608F, 2}, 4},
        Unit{"gear_motor_turns", {0x6091, 1}, 4}, Unit{"gear_shaft_turns", {0x6091, 2}, 4},
        Unit{"feed_counts", {0x6092, 1}, 4}, Unit{"feed_shaft_turns", {0x6092, 2}, 4}}) {
    const CanopenConfig config = config_by({{unit.name, {129}}});
    const AxisConfig& axis = config.axes.at(0);
    ASSERT_EQ(axis.setup.size(), 1U) << unit.name;
    std::vector<std::uint8_t> bytes(unit.bytes);
    bytes[0] = 129;
    EXPECT_EQ(axis.setup[0].object, unit.object);
    EXPECT_EQ(axis.setup[0].bytes, bytes);
    EXPECT_EQ(axis.sets_polarity, unit.bytes == 1);
  }
}

/// CiA 402-2, 10 and 14 to 17: what a mode needs.
TEST(CanopenParameters, MapWhatTheModeNeeds) {
  struct Mode {
    double mode, homing_method;
    const char *rpdo, *tpdo;
  };
  const char* const kPositionAndTorque = "6041:00/16 6064:00/32 6077:00/16";
  const char* const kWithMode = "6041:00/16 6061:00/8 6064:00/32";
  for (const Mode& of : {Mode{1, 0, "6040:00/16 607A:00/32", kPositionAndTorque},
                         Mode{3, 0, "6040:00/16 60FF:00/32", "6041:00/16 606C:00/32"},
                         Mode{4, 0, "6040:00/16 6071:00/16", kPositionAndTorque},
                         Mode{7, 0, "6040:00/16 60C1:01/32", kPositionAndTorque},
                         Mode{8, 0, "6040:00/16 607A:00/32", kPositionAndTorque},
                         Mode{9, 0, "6040:00/16 60FF:00/32", kPositionAndTorque},
                         Mode{10, 0, "6040:00/16 6071:00/16", kPositionAndTorque},
                         Mode{8, 17, "6040:00/16 6060:00/8 607A:00/32", kWithMode},
                         Mode{9, 17, "6040:00/16 6060:00/8 60FF:00/32", kWithMode},
                         Mode{10, 17, "6040:00/16 6060:00/8 6071:00/16", kWithMode}}) {
    const Numbers numbers{{"mode", {of.mode}}, {"homing_method", {of.homing_method}}};
    const CanopenConfig by_mode = config_by(numbers),
                        by_text = config_by(numbers, {{"rpdo", of.rpdo}, {"tpdo", of.tpdo}});
    EXPECT_EQ(by_mode.axes.at(0).setpoints, by_text.axes.at(0).setpoints) << of.mode;
    EXPECT_EQ(by_mode.axes.at(0).answers, by_text.axes.at(0).answers) << of.mode;
  }
  for (const double mode : {2.0, 5.0, 6.0}) {
    EXPECT_THAT(answer({{"mode", {mode}}}), HasSubstr("allowed are 1, 3 and 4 "));
  }
  for (const double mode : {1.0, 3.0, 4.0, 7.0}) {
    EXPECT_THAT(answer({{"mode", {mode}}, {"homing_method", {1}}}), HasSubstr("does not move a joint"));
  }
}

TEST(CanopenParameters, OfHomingNeedTheModeOnBothSides) {
  const Numbers homes{{"mode", {8}}, {"homing_method", {17}}};
  const char* const kRefused = "has a homing_method, so rpdo must hold 6060:00/8 and tpdo 6061:00/8";
  const std::string with = "6040:00/16 6060:00/8 607A:00/32", without = "6040:00/16 607A:00/32";
  const std::string told = "6041:00/16 6061:00/8 6064:00/32", untold = "6041:00/16 6064:00/32";
  EXPECT_EQ(answer(homes, {{"rpdo", with}, {"tpdo", told}}), "accepted");
  EXPECT_THAT(answer(homes, {{"rpdo", without}, {"tpdo", told}}), HasSubstr(kRefused));
  EXPECT_THAT(answer(homes, {{"rpdo", with}, {"tpdo", untold}}), HasSubstr(kRefused));
  EXPECT_EQ(answer(homes, {{"rpdo", without}, {"second_rpdo", "6060:00/8"}, {"tpdo", told}}), "accepted");
  EXPECT_EQ(answer({{"mode", {8}}}, {{"rpdo", without}, {"tpdo", untold}}), "accepted");
}

TEST(CanopenParameters, NameASensorAmongTheAnswersOfAnyOfItsPdos) {
  const Texts first{{"tpdo", "6041:00/16 6401:01/16"}, {"sensor", "6401:01/16"}};
  EXPECT_EQ(config_by({}, first).axes.at(0).sensor, (MappedObject{{0x6401, 1}, 16}));
  const Texts second{{"second_tpdo", "6401:01/16"}, {"sensor", "6401:01/16"}};
  EXPECT_EQ(config_by({}, second).axes.at(0).sensor, (MappedObject{{0x6401, 1}, 16}));
  EXPECT_EQ(config_by({}).axes.at(0).sensor, std::nullopt);
  for (const char* const sensor : {"6401:01/8", "6401:02/16", "6041:00/16 6401:01/16"}) {
    EXPECT_THAT(answer({}, {{"tpdo", "6041:00/16 6401:01/16"}, {"sensor", sensor}}), HasSubstr("it names one object"));
  }
}

// Red when two drives write into the same byte of an RPDO, or two that do not are refused.
TEST(CanopenParameters, ShareAnRpdoWhereEachByteIsOfOneDrive) {
  std::mt19937 random(1600);
  int accepted = 0;
  for (int run = 0; run < 500; ++run) {
    std::array<std::string, 2> texts;
    std::array<unsigned, 2> own{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const std::array<std::string, 4> words{"6040:00/16", "6071:00/16", "60B2:00/16", "60B8:00/16"};
      const std::size_t controlword = random() % 4;  // which of the four places of two bytes
      for (std::size_t place = 0, word = 0; place < 4; ++place) {
        const bool mine = place == controlword || random() % 5 == 0;
        texts[axis] += place == controlword ? words[0] : mine ? words.at(++word) : "0006:00/16";
        texts[axis] += " ";
        if (mine) own[axis] |= 1U << place;
      }
    }
    const std::string said =
        answer({{"node", {1, 2}}, {"rpdo_node", {1, 1}}}, {{"rpdo_0", texts[0]}, {"rpdo_1", texts[1]}});
    if ((own[0] & own[1]) == 0) {
      ASSERT_EQ(said, "accepted") << texts[0] << "and " << texts[1];
      ++accepted;
    } else {
      ASSERT_THAT(said, HasSubstr("nodes 1 and 2 share an RPDO, and both map some of its bytes"))
          << texts[0] << texts[1];
    }
  }
  EXPECT_GT(accepted, 100);
}

TEST(Patience, IsThatOfDeviceJsonElseOfTheDriveElseTheUsual) {
  DriveDescription slow;
  slow.manners.sdo_timeout = milliseconds(900);
  slow.manners.boot_timeout = milliseconds(20000);
  slow.manners.sdo_retries = 4;
  const Patience usual = patience_with(config_by({}), 5, nullptr);
  EXPECT_EQ(usual.sdo_timeout, milliseconds(500));
  EXPECT_EQ(usual.sdo_tries, 3);
  EXPECT_EQ(usual.boot_timeout, milliseconds(5000));
  const Patience of_drive = patience_with(config_by({}), 5, &slow);
  EXPECT_EQ(of_drive.sdo_timeout, milliseconds(900));
  EXPECT_EQ(of_drive.sdo_tries, 5) << "the first, and four more";
  EXPECT_EQ(of_drive.boot_timeout, milliseconds(20000));
  const CanopenConfig given = config_by({{"sdo_timeout_ms", {70}}, {"boot_timeout_s", {3}}});
  EXPECT_EQ(patience_with(given, 5, &slow).sdo_timeout, milliseconds(70));
  EXPECT_EQ(patience_with(given, 5, &slow).boot_timeout, milliseconds(3000));
  EXPECT_EQ(patience_with(given, 6, &slow).sdo_timeout, milliseconds(900)) << "of another node nothing is given";
}

TEST(BusLoad, CountsHeartbeatsAndTimeOfEachSecond) {
  // 65 bits are a frame of a byte at its longest, 115 one of six.
  EXPECT_DOUBLE_EQ(bus_load(config_by({})).heartbeat_bits_per_s, 2 * 65 / 0.05) << "the master's, too";
  EXPECT_DOUBLE_EQ(bus_load(config_by({{"node", {1, 2, 2}}, {"axis_in_node", {0, 0, 1}}, {"heartbeat_ms", {100}}}))
                       .heartbeat_bits_per_s,
                   3 * 65 / 0.1)
      << "one a node, however many axes it has";
  EXPECT_DOUBLE_EQ(bus_load(config_by({{"time_s", {2}}})).heartbeat_bits_per_s, 2 * 65 / 0.05 + 115 / 2.0);
  EXPECT_DOUBLE_EQ(bus_load(config_by({{"bit_rate", {250e3}}})).bits_of_cycle, 250);
}

TEST(BusLoad, HasRoomInTheQueueForAllFramesOfACycle) {
  // SYNC, heartbeat, TIME and a frame of a boot beside the setpoints.
  EXPECT_EQ(frames_of_cycle(config_by({})), 1U + 4);
  EXPECT_EQ(frames_of_cycle(config_by({{"node", {1, 2, 3}}})), 3U + 4);
  EXPECT_EQ(frames_of_cycle(config_by({{"node", {1, 2, 3}}}, {{"second_rpdo_1", "60B1:00/32"}})), 3U + 1 + 4);
  CanopenConfig guarded = config_by({{"node", {1, 2, 3}}});
  auto library = std::make_shared<DriveLibrary>();
  library->drives.resize(2);
  guarded.drives = library;
  EXPECT_EQ(frames_of_cycle(guarded), 3U + 4);
  library->drives[1].manners.node_guarding = true;
  EXPECT_EQ(frames_of_cycle(guarded), 3U * 2 + 4) << "a question to each";
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
