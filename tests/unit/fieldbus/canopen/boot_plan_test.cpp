#include "canopen/boot_plan.hpp"

#include <gmock/gmock.h>

#include <iomanip>
#include <sstream>

namespace rmac::fieldbus::canopen {
namespace {

using std::chrono::microseconds;
using std::chrono::nanoseconds;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

std::string hexadecimal(std::uint32_t number) {
  std::ostringstream text;
  text << std::uppercase << std::hex << number;
  return text.str();
}

/// "write 1400h:02 = 1 (1 byte)": what a step does; "may" where a refusal is passed over.
std::string text_of(const BootStep& step) {
  std::uint32_t written = 0;
  for (std::size_t i = 0; i < step.bytes.size(); ++i) written |= std::uint32_t{step.bytes[i]} << (8 * i);
  const std::string length = std::to_string(step.bytes.size()) + (step.bytes.size() == 1 ? " byte" : " bytes");
  const std::string expected = hexadecimal(step.value) + " in " + hexadecimal(step.mask);
  std::string text = step.optional ? "may " : "";
  switch (step.kind) {
    case BootStep::Kind::Check:
      text += "check " + to_string(step.object) + " for " + expected;
      break;
    case BootStep::Kind::Write:
      text += "write " + to_string(step.object) + " = " + hexadecimal(written) + " (" + length + ")";
      if (step.may_be_constant) text += " or find " + expected;
      break;
    case BootStep::Kind::Read:
      text += "read " + to_string(step.object);
      break;
    case BootStep::Kind::Compare:
      text += "compare " + to_string(step.object) + " with " + expected;
      break;
    case BootStep::Kind::Store:
      text += "store " + to_string(step.object) + " = " + hexadecimal(written);
      break;
    case BootStep::Kind::Reset:
      text += "reset";
      break;
    case BootStep::Kind::Refuse:
      text += "refuse: " + std::string(step.needed);
      break;
  }
  if (step.may_be_absent) text += ", unless absent";
  if (step.after_refusal) text += ", where it was refused";
  if (step.after_change) text += ", where it is changed";
  return text;
}

CanopenConfig config_of(std::map<std::string, std::vector<double>> numbers,
                        const std::map<std::string, std::string>& texts = {}, double period_s = 0.001) {
  numbers.try_emplace("node", std::vector<double>{5});
  auto config = read_canopen_config("can0", numbers, texts, period_s);
  EXPECT_TRUE(config) << config.error().message;
  return config.value_or(CanopenConfig());
}
std::vector<std::string> plan_of(const CanopenConfig& config, const DriveDescription* drive = nullptr) {
  std::vector<std::string> texts;
  for (const BootStep& step : boot_plan(config, 5, drive)) texts.push_back(text_of(step));
  return texts;
}
/// What the plan does with one object.
std::vector<std::string> plan_of(const CanopenConfig& config, ObjectAddress object,
                                 const DriveDescription* drive = nullptr) {
  std::vector<std::string> texts;
  for (const BootStep& step : boot_plan(config, 5, drive)) {
    if (step.object == object) texts.push_back(text_of(step));
  }
  return texts;
}

// CiA 301, 7.5.2.36: a PDO is made invalid, then its entries go, come anew, are counted, and it is valid again.
TEST(BootPlan, OfADriveOfPositionsIsInTheStandardsOrder) {
  EXPECT_THAT(plan_of(config_of({{"mode", {8}}, {"vendor_id", {0x1A3}}})),
              ElementsAre("check 1000h:00 for 192 in FFFF", "check 1018h:01 for 1A3 in FFFFFFFF", "may read 1018h:02",
                          "may read 1018h:03", "may read 1018h:04", "may check 6502h:00 for 80 in 80",
                          // what it sends and takes by default
                          "may write 1401h:01 = 80000305 (4 bytes)", "may write 1801h:01 = C0000285 (4 bytes)",
                          "may write 1402h:01 = 80000405 (4 bytes)", "may write 1802h:01 = C0000385 (4 bytes)",
                          "may write 1403h:01 = 80000505 (4 bytes)", "may write 1803h:01 = C0000485 (4 bytes)",
                          // setpoints
                          "write 1400h:01 = 80000205 (4 bytes) or find 205 in BFFFFFFF",
                          "write 1400h:02 = 1 (1 byte) or find 1 in FF", "write 1600h:00 = 0 (1 byte) or find 2 in FF",
                          "write 1600h:01 = 60400010 (4 bytes) or find 60400010 in FFFFFFFF",
                          "write 1600h:02 = 607A0020 (4 bytes) or find 607A0020 in FFFFFFFF",
                          "write 1600h:00 = 2 (1 byte) or find 2 in FF",
                          "write 1400h:01 = 205 (4 bytes) or find 205 in BFFFFFFF",
                          // answers
                          "write 1800h:01 = C0000185 (4 bytes) or find 185 in BFFFFFFF",
                          "write 1800h:02 = 1 (1 byte) or find 1 in FF", "write 1A00h:00 = 0 (1 byte) or find 3 in FF",
                          "write 1A00h:01 = 60410010 (4 bytes) or find 60410010 in FFFFFFFF",
                          "write 1A00h:02 = 60640020 (4 bytes) or find 60640020 in FFFFFFFF",
                          "write 1A00h:03 = 60770010 (4 bytes) or find 60770010 in FFFFFFFF",
                          "write 1A00h:00 = 3 (1 byte) or find 3 in FF",
                          "write 1800h:01 = 40000185 (4 bytes) or find 185 in BFFFFFFF", "may read 1800h:02",
                          // a quick stop when the master dies, its mode, and its times of a millisecond
                          "write 6007h:00 = 3 (2 bytes)", "write 6060h:00 = 8 (1 byte)",
                          "may write 60C2h:01 = 1 (1 byte)", "may check 60C2h:01 for 1 in FF, where it was refused",
                          "may write 60C2h:02 = FD (1 byte)", "may check 60C2h:02 for FD in FF, where it was refused",
                          // its scale
                          "may read 608Fh:01", "may read 608Fh:02", "may read 6091h:01", "may read 6091h:02",
                          "may read 6092h:01", "may read 6092h:02",
                          // once more who it is, and its watch over node 127, whose heartbeat is late after 75 ms
                          "may read 1018h:01", "may read 1018h:02", "may read 1018h:03", "may read 1018h:04",
                          "write 1016h:01 = 7F004B (4 bytes)", "write 1017h:00 = 32 (2 bytes)", "may read 1017h:00",
                          "may read 603Fh:00"));
}

TEST(BootPlan, OfAFurtherAxisHasItsObjectsAndItsPdos) {
  const auto config = config_of({{"node", {5, 5}}, {"axis_in_node", {0, 3}}, {"mode", {8, 10}}},
                                {{"setup_1", "6085:00/32=1 2000:01/16=2"}});
  EXPECT_THAT(plan_of(config, {0x7D02, 0}), ElementsAre("may check 7D02h:00 for 200 in 200"));
  EXPECT_THAT(plan_of(config, {0x14C0, 1}), ElementsAre("write 14C0h:01 = 80000505 (4 bytes) or find 505 in BFFFFFFF",
                                                        "write 14C0h:01 = 505 (4 bytes) or find 505 in BFFFFFFF"));
  EXPECT_THAT(plan_of(config, {0x16C0, 1}),
              ElementsAre("write 16C0h:01 = 78400010 (4 bytes) or find 78400010 in FFFFFFFF"));
  EXPECT_THAT(plan_of(config, {0x18C0, 2}),
              ElementsAre("write 18C0h:02 = 1 (1 byte) or find 1 in FF", "may read 18C0h:02"));
  EXPECT_THAT(plan_of(config, {0x1AC0, 2}),
              ElementsAre("write 1AC0h:02 = 78640020 (4 bytes) or find 78640020 in FFFFFFFF"));
  EXPECT_THAT(plan_of(config, {0x7807, 0}), ElementsAre("write 7807h:00 = 3 (2 bytes)"));
  EXPECT_THAT(plan_of(config, {0x7860, 0}), ElementsAre("write 7860h:00 = A (1 byte)"));
  EXPECT_THAT(plan_of(config, {0x787E, 0}), ElementsAre("check 787Eh:00 for 0 in 80, unless absent"));
  EXPECT_THAT(plan_of(config, {0x7885, 0}), ElementsAre("write 7885h:00 = 1 (4 bytes)"));
  EXPECT_THAT(plan_of(config, {0x2000, 1}), ElementsAre("write 2000h:01 = 2 (2 bytes)"));
  EXPECT_THAT(plan_of(config, {0x78C2, 1}), ElementsAre("may write 78C2h:01 = 1 (1 byte)")) << "torques jump";
  EXPECT_THAT(plan_of(config, {0x788F, 2}), ElementsAre("may read 788Fh:02"));
  // Another axis's identifier must be free; who takes nobody's place may stay.
  EXPECT_THAT(plan_of(config, {0x1403, 1}), ElementsAre("write 1403h:01 = 80000505 (4 bytes)"));
  EXPECT_THAT(plan_of(config, {0x1803, 1}), ElementsAre("write 1803h:01 = C0000485 (4 bytes)"));
  EXPECT_THAT(plan_of(config, {0x1402, 1}), ElementsAre("may write 1402h:01 = 80000405 (4 bytes)"));
  EXPECT_THAT(plan_of(config, {0x1802, 1}), ElementsAre("may write 1802h:01 = C0000385 (4 bytes)"));
}

TEST(BootPlan, AsksForTheModeAndForHomingWhereTheyAreWanted) {
  for (const int mode : {1, 3, 4, 7, 8, 9, 10}) {
    const std::string bit = hexadecimal(1U << (mode - 1));
    EXPECT_THAT(plan_of(config_of({{"mode", {double(mode)}}}), {0x6502, 0}),
                ElementsAre("may check 6502h:00 for " + bit + " in " + bit));
    EXPECT_THAT(plan_of(config_of({{"mode", {double(mode)}}}), {0x6060, 0}),
                ElementsAre("write 6060h:00 = " + hexadecimal(static_cast<std::uint32_t>(mode)) + " (1 byte)"));
  }
  EXPECT_THAT(plan_of(config_of({{"mode", {8}}, {"homing_method", {17}}}), {0x6502, 0}),
              ElementsAre("may check 6502h:00 for A0 in A0"));
}

TEST(BootPlan, HasSecondPdosWhereTheyAreMapped) {
  const auto config = config_of({}, {{"second_rpdo", "60B1:00/32"}, {"second_tpdo", "60FD:00/32"}});
  EXPECT_THAT(plan_of(config, {0x1401, 1}), ElementsAre("may write 1401h:01 = 80000305 (4 bytes)",
                                                        "write 1401h:01 = 80000305 (4 bytes) or find 305 in BFFFFFFF",
                                                        "write 1401h:01 = 305 (4 bytes) or find 305 in BFFFFFFF"));
  EXPECT_THAT(plan_of(config, {0x1801, 1}), ElementsAre("may write 1801h:01 = C0000285 (4 bytes)",
                                                        "write 1801h:01 = C0000285 (4 bytes) or find 285 in BFFFFFFF",
                                                        "write 1801h:01 = 40000285 (4 bytes) or find 285 in BFFFFFFF"));
  EXPECT_THAT(plan_of(config, {0x1601, 1}),
              ElementsAre("write 1601h:01 = 60B10020 (4 bytes) or find 60B10020 in FFFFFFFF"));
  EXPECT_THAT(plan_of(config, {0x1A01, 1}),
              ElementsAre("write 1A01h:01 = 60FD0020 (4 bytes) or find 60FD0020 in FFFFFFFF"));
  EXPECT_THAT(plan_of(config, {0x1801, 2}),
              ElementsAre("write 1801h:02 = 1 (1 byte) or find 1 in FF", "may read 1801h:02"));
  const auto without = plan_of(config_of({}));
  EXPECT_THAT(without, Not(Contains(testing::HasSubstr("1601h"))));
  EXPECT_THAT(without, Not(Contains("may read 1801h:02")));
}

/// 60C2h: a value of 1 to 255 times a power of ten of a second, in ms where it can be said so.
TEST(BootPlan, TellsTheCycleAsFewDigitsSayIt) {
  struct Time {
    nanoseconds period;
    unsigned value;
    int exponent;
  };
  using std::chrono::milliseconds;
  for (const Time& time :
       {Time{milliseconds(1), 1, -3}, Time{milliseconds(4), 4, -3}, Time{milliseconds(255), 255, -3},
        Time{milliseconds(300), 30, -2}, Time{milliseconds(1000), 100, -2}, Time{milliseconds(25000), 250, -1},
        Time{milliseconds(100000), 100, 0}, Time{microseconds(500), 5, -4}, Time{microseconds(250), 25, -5},
        Time{microseconds(1500), 15, -4}, Time{microseconds(125), 125, -6}, Time{nanoseconds(2500), 25, -7},
        Time{nanoseconds(120), 12, -8}, Time{nanoseconds(255), 255, -9}}) {
    CanopenConfig config = config_of({{"mode", {8}}});
    config.period = time.period;
    EXPECT_THAT(plan_of(config, {0x60C2, 1}),
                Contains("may write 60C2h:01 = " + hexadecimal(time.value) + " (1 byte)"));
    const auto exponent = static_cast<std::uint8_t>(time.exponent);
    EXPECT_THAT(plan_of(config, {0x60C2, 2}), Contains("may write 60C2h:02 = " + hexadecimal(exponent) + " (1 byte)"));
  }
  for (const nanoseconds period : {nanoseconds(milliseconds(256)), nanoseconds(62500), nanoseconds(0)}) {
    CanopenConfig config = config_of({{"mode", {8}}});
    config.period = period;
    EXPECT_THAT(plan_of(config, {0x60C2, 1}), IsEmpty()) << period.count() << " ns cannot be said";
  }
}

TEST(BootPlan, TellsADriveTheTimesThatItTakes) {
  DriveDescription drive;
  drive.manners.interpolation = InterpolationTimes{-4, {10, 20}};
  const auto config = config_of({{"mode", {8}}});
  EXPECT_THAT(plan_of(config, {0x60C2, 1}, &drive),
              ElementsAre("may write 60C2h:01 = A (1 byte)", "may check 60C2h:01 for A in FF, where it was refused"));
  EXPECT_THAT(plan_of(config, {0x60C2, 2}, &drive),
              ElementsAre("may write 60C2h:02 = FC (1 byte)", "may check 60C2h:02 for FC in FF, where it was refused"));
  const std::string refused =
      "refuse: the cycle (period_s) is none of the times that it takes in 60C2h (InterpolationTimePeriod)";
  EXPECT_THAT(plan_of(config, &drive), Not(Contains(refused)));
  drive.manners.interpolation = InterpolationTimes{-4, {20}};
  EXPECT_THAT(plan_of(config, &drive), Contains(refused));
  EXPECT_THAT(plan_of(config_of({{"mode", {10}}}), &drive), Not(Contains(refused))) << "torques are not interpolated";
  EXPECT_THAT(plan_of(config_of({{"mode", {8}}}, {{"setup", "60C2:01/8=10"}}), &drive), Not(Contains(refused)))
      << "device.json says it";
}

TEST(BootPlan, AsksAPolarityOfTorqueAloneAndWhereNobodySetsIt) {
  EXPECT_THAT(plan_of(config_of({{"mode", {10}}}), {0x607E, 0}),
              ElementsAre("check 607Eh:00 for 0 in 80, unless absent"));
  EXPECT_THAT(plan_of(config_of({{"mode", {8}}}), {0x607E, 0}), IsEmpty());
  EXPECT_THAT(plan_of(config_of({{"mode", {10}}, {"polarity", {0}}}), {0x607E, 0}),
              ElementsAre("write 607Eh:00 = 0 (1 byte)"));
}

TEST(BootPlan, ReadsAScaleThatSomebodyWantsToKnow) {
  for (const int mode : {1, 7, 8, 9, 10}) {
    EXPECT_THAT(plan_of(config_of({{"mode", {double(mode)}}}), {0x6091, 2}), ElementsAre("may read 6091h:02"));
  }
  EXPECT_THAT(plan_of(config_of({{"mode", {3}}}), {0x6091, 2}), IsEmpty());
  EXPECT_THAT(plan_of(config_of({{"mode", {8}}, {"check_scale", {0}}}), {0x6091, 2}), IsEmpty());
}

TEST(BootPlan, SaysWhatADriveDoesWithoutItsMasterUnlessItIsToKeepItsWay) {
  for (const int option : {0, 1, 2, 3}) {
    EXPECT_THAT(plan_of(config_of({{"abort_connection", {double(option)}}}), {0x6007, 0}),
                ElementsAre("write 6007h:00 = " + std::to_string(option) + " (2 bytes)"));
  }
  EXPECT_THAT(plan_of(config_of({{"abort_connection", {-1}}}), {0x6007, 0}), IsEmpty());
  DriveDescription drive;
  drive.manners.no_abort_connection = true;
  EXPECT_THAT(plan_of(config_of({}), {0x6007, 0}, &drive), IsEmpty());
  EXPECT_THAT(plan_of(config_of({{"abort_connection", {2}}}), {0x6007, 0}, &drive),
              ElementsAre("write 6007h:00 = 2 (2 bytes)"))
      << "device.json goes before it";
}

TEST(BootPlan, HasTheMasterWatchedByItsHeartbeatOrByItsQuestions) {
  const auto config = config_of({{"heartbeat_ms", {200}}, {"master_node", {0x41}}});
  EXPECT_THAT(plan_of(config, {0x1016, 1}), ElementsAre("write 1016h:01 = 41012C (4 bytes)"));
  EXPECT_THAT(plan_of(config, {0x1017, 0}), ElementsAre("write 1017h:00 = C8 (2 bytes)", "may read 1017h:00"));
  EXPECT_THAT(plan_of(config, {0x100C, 0}), IsEmpty());
  DriveDescription guarded;
  guarded.manners.node_guarding = true;
  EXPECT_THAT(plan_of(config, {0x1016, 1}, &guarded), IsEmpty());
  EXPECT_THAT(plan_of(config, {0x1017, 0}, &guarded), ElementsAre("may write 1017h:00 = 0 (2 bytes)"));
  EXPECT_THAT(plan_of(config, {0x100C, 0}, &guarded), ElementsAre("write 100Ch:00 = C8 (2 bytes)"));
  EXPECT_THAT(plan_of(config, {0x100D, 0}, &guarded), ElementsAre("write 100Dh:00 = 2 (1 byte)"));
  DriveDescription alone;
  alone.manners.no_heartbeat_consumer = "it runs on";
  EXPECT_THAT(plan_of(config, {0x1016, 1}, &alone), IsEmpty());
  EXPECT_THAT(plan_of(config, {0x1017, 0}, &alone), ElementsAre("write 1017h:00 = C8 (2 bytes)", "may read 1017h:00"));
}

TEST(BootPlan, ComparesAMappingThatIsFixed) {
  DriveDescription drive;
  drive.manners.fixed_mapping = true;
  const auto config = config_of({{"mode", {8}}});
  EXPECT_THAT(plan_of(config, {0x1600, 0}, &drive), ElementsAre("check 1600h:00 for 2 in FF"));
  EXPECT_THAT(plan_of(config, {0x1600, 2}, &drive), ElementsAre("check 1600h:02 for 607A0020 in FFFFFFFF"));
  EXPECT_THAT(plan_of(config, {0x1400, 1}, &drive),
              ElementsAre("write 1400h:01 = 80000205 (4 bytes) or find 205 in BFFFFFFF",
                          "write 1400h:01 = 205 (4 bytes) or find 205 in BFFFFFFF"));
}

TEST(BootPlan, StoresAMappingThatCountsFromTheNextResetOn) {
  DriveDescription drive;
  drive.manners.store_after_mapping = true;
  const auto config = config_of({{"mode", {8}}});
  EXPECT_THAT(
      plan_of(config, {0x1600, 0}, &drive),
      ElementsAre("compare 1600h:00 with 2 in FF", "write 1600h:00 = 0 (1 byte) or find 2 in FF, where it is changed",
                  "write 1600h:00 = 2 (1 byte) or find 2 in FF, where it is changed"));
  EXPECT_THAT(plan_of(config, {0x1600, 1}, &drive),
              ElementsAre("compare 1600h:01 with 60400010 in FFFFFFFF",
                          "write 1600h:01 = 60400010 (4 bytes) or find 60400010 in FFFFFFFF, where it is changed"));
  EXPECT_THAT(plan_of(config, {0x1400, 1}, &drive),
              ElementsAre("write 1400h:01 = 80000205 (4 bytes) or find 205 in BFFFFFFF",
                          "write 1400h:01 = 205 (4 bytes) or find 205 in BFFFFFFF"))
      << "these are no contents, and count at once";
  EXPECT_THAT(plan_of(config, {0x1010, 1}, &drive), ElementsAre("store 1010h:01 = 65766173, where it is changed"));
  EXPECT_THAT(plan_of(config, &drive), Contains("reset, where it is changed"));
  EXPECT_THAT(plan_of(config), Not(Contains("reset, where it is changed")));
}

TEST(BootPlan, LeavesAloneWhatIsToBeSkippedOnEachAxis) {
  DriveDescription drive;
  drive.manners.skip = {{0x60C2, 1}, {0x6502, {}}, {0x1802, 1}, {0x1018, 4}};
  const auto config = config_of({{"node", {5, 5}}, {"axis_in_node", {0, 1}}, {"mode", {8}}});
  for (const ObjectAddress skipped :
       {ObjectAddress{0x60C2, 1}, {0x68C2, 1}, {0x6502, 0}, {0x6D02, 0}, {0x1802, 1}, {0x1018, 4}}) {
    EXPECT_THAT(plan_of(config, skipped, &drive), IsEmpty()) << to_string(skipped);
    EXPECT_THAT(plan_of(config, skipped), Not(IsEmpty())) << to_string(skipped);
  }
  for (const ObjectAddress other : {ObjectAddress{0x60C2, 2}, {0x68C2, 2}, {0x1402, 1}, {0x1803, 1}, {0x1018, 3}}) {
    EXPECT_THAT(plan_of(config, other, &drive), Not(IsEmpty())) << to_string(other);
  }
}

TEST(BootPlan, SkipsNoPdoThatIsMapped) {
  DriveDescription drive;
  drive.manners.skip = {{0x1401, {}}, {0x1801, 1}};
  const std::string refused =
      "refuse: its second PDO is to be left alone (Skip), and second_rpdo or second_tpdo maps it";
  EXPECT_THAT(plan_of(config_of({}), &drive), Not(Contains(refused)));
  EXPECT_THAT(plan_of(config_of({}, {{"second_rpdo", "60B1:00/32"}}), &drive), Contains(refused));
  EXPECT_THAT(plan_of(config_of({}, {{"second_tpdo", "60FD:00/32"}}), &drive), Contains(refused));
  // Of two axes, one would take what is the other's.
  const auto two = config_of({{"node", {5, 5}}, {"axis_in_node", {0, 1}}});
  EXPECT_THAT(plan_of(two, {0x1401, 1}, &drive), ElementsAre("write 1401h:01 = 80000305 (4 bytes)"));
}

TEST(BootPlan, EndsWithTheIdentityOfADriveWhoseDescriptionIsRefused) {
  DriveDescription drive;
  drive.refusal = "two files are for it";
  const auto steps = plan_of(config_of({}), &drive);
  ASSERT_EQ(steps.size(), kIdentitySteps + 1);
  EXPECT_EQ(steps.back(), "refuse: two files are for it");
}

TEST(BootPlan, ComparesEachNumberOfAnIdentityThatIsGiven) {
  const auto config =
      config_of({{"vendor_id", {1}}, {"product_code", {2}}, {"revision_number", {3}}, {"serial_number", {4}}});
  for (const std::uint8_t sub : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3}, std::uint8_t{4}}) {
    const std::string at = to_string({0x1018, sub});
    EXPECT_THAT(plan_of(config, {0x1018, sub}),
                ElementsAre("check " + at + " for " + std::to_string(sub) + " in FFFFFFFF", "may read " + at));
  }
}

TEST(BootPlan, IsEmptyOfAxesThatAreNotTheNodes) {
  const auto config = config_of({{"node", {5, 6}}, {"mode", {8, 3}}});
  EXPECT_THAT(plan_of(config, {0x6060, 0}), ElementsAre("write 6060h:00 = 8 (1 byte)"));
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
