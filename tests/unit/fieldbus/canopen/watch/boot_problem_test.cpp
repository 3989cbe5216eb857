#include "canopen/watch/boot_problem.hpp"

#include <gmock/gmock.h>

#include <set>

namespace rmac::fieldbus::canopen {
namespace {

using Kind = BootProblem::Kind;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

class Problems : public testing::Test {
 protected:
  [[nodiscard]] std::string told(const BootProblem& problem) const { return describe(problem, 5, config_); }
  [[nodiscard]] std::string noted(const BootProblem& problem) const { return describe_note(problem, 5, config_); }

  CanopenConfig config_ = *read_canopen_config(
      "can0", {{"node", {5, 6, 5}}, {"axis_in_node", {0, 0, 1}}, {"bit_rate", {250e3}}}, {}, 0.004);
};

// Red when one reason is told in the words of another, or without its node and its axes.
TEST_F(Problems, AreToldEachInItsOwnWords) {
  std::set<std::string> all;
  for (auto kind = Kind::None; kind <= Kind::TwoHeartbeats; kind = static_cast<Kind>(static_cast<int>(kind) + 1)) {
    const std::string text = told({.kind = kind, .object = {0x6041, 0}});
    EXPECT_TRUE(text.starts_with("node 5 (axis 0, 2)")) << text;
    EXPECT_EQ(shows_two(kind), text.find("two devices have this node id") != std::string::npos) << text;
    EXPECT_TRUE(all.insert(text).second) << text;
  }
  EXPECT_EQ(told({}), "node 5 (axis 0, 2) came up");
}

TEST_F(Problems, SayHowLongWasWaited) {
  using std::chrono::milliseconds;
  EXPECT_EQ(told({.kind = Kind::NoBootUp, .object = {}, .waited = milliseconds(2500)}),
            "node 5 (axis 0, 2) is missing: no boot-up message in 2.5 s; check its power, its cable, its node id, and "
            "that it is set to 250000 bit/s");
  EXPECT_EQ(told({.kind = Kind::NoStart, .object = {}, .waited = milliseconds(700)}),
            "node 5 (axis 0, 2) is set up, but did not become operational in 0.7 s");
}

TEST_F(Problems, SayWhatWasNotAnsweredAndAdvisePatienceWhereTimeRanOut) {
  BootProblem problem{.kind = Kind::NoAnswer, .object = {0x1016, 1}, .found = 0x05040000, .writing = true};
  EXPECT_EQ(told(problem),
            "node 5 (axis 0, 2) did not answer when 1016h:01 was written: SDO protocol timed out; a drive that takes "
            "longer to answer needs a longer sdo_timeout_ms");
  problem.writing = false;
  problem.found = 0x05030000;
  EXPECT_EQ(told(problem), "node 5 (axis 0, 2) did not answer when 1016h:01 was read: toggle bit not alternated");
}

TEST_F(Problems, SayWhatWasRefusedAndWhatItIsNeededFor) {
  BootProblem problem{
      .kind = Kind::Refused, .object = {0x1600, 1}, .expected = 0x60400010, .found = 0x06010002, .writing = true};
  const std::string refused =
      "node 5 (axis 0, 2) refused 60400010h for 1600h:01: attempt to write a read-only object "
      "(06010002h)";
  EXPECT_EQ(told(problem), refused);
  problem.kept = 0x60410010;
  problem.needed = "to send it its setpoints (rpdo)";
  EXPECT_EQ(told(problem), refused + ", and has 60410010h there; it is needed to send it its setpoints (rpdo)");
  problem.writing = false;
  EXPECT_EQ(
      told(problem),
      "node 5 (axis 0, 2) refused to tell 1600h:01: attempt to write a read-only object (06010002h); it is needed "
      "to send it its setpoints (rpdo)");
}

TEST_F(Problems, NameTheNumberByWhichADeviceIsAnother) {
  const std::array<const char*, 4> names{"vendor id", "product code", "revision number", "serial number"};
  for (std::uint8_t sub = 1; sub <= 4; ++sub) {
    EXPECT_EQ(told({.kind = Kind::Different, .object = {0x1018, sub}, .expected = 0xAB, .found = 0xCD}),
              "node 5 (axis 0, 2) is another device than configured: its " + std::string(names.at(sub - 1U)) +
                  " (1018h:0" + std::to_string(sub) + ") is CDh, not ABh");
  }
  EXPECT_EQ(told({.kind = Kind::Different, .object = {0x1000, 0}, .expected = 402, .found = 0x191}),
            "node 5 (axis 0, 2) is not a drive: its device type (1000h) is 00000191h, and a CiA 402 drive ends in "
            "0192h");
  EXPECT_EQ(told({.kind = Kind::Different, .object = {0x60C2, 1}, .expected = 1, .found = 2, .needed = "to move"}),
            "node 5 (axis 0, 2) does not support what is asked of it: 60C2h:01 is 2h, and 1h is needed in it; it is "
            "needed to move");
}

/// 6502h: bit 0 is mode 1.
TEST_F(Problems, NameTheModesThatADriveLacks) {
  for (const std::uint16_t index : {std::uint16_t{0x6502}, std::uint16_t{0x6D02}}) {
    const std::string object = to_string({index, 0});
    EXPECT_EQ(told({.kind = Kind::Different, .object = {index, 0}, .expected = 0x221, .found = 0x87}),
              "node 5 (axis 0, 2) cannot do homing (mode 6) and cyclic synchronous torque (mode 10): " + object +
                  " says that it does the modes 1, 2, 3, 8");
    EXPECT_THAT(told({.kind = Kind::Different, .object = {index, 0}, .expected = 0x80, .found = 0x10000}),
                EndsWith(" cannot do cyclic synchronous position (mode 8): " + object +
                         " says that it does the modes of its maker only"));
    EXPECT_THAT(told({.kind = Kind::Different, .object = {index, 0}, .expected = 1, .found = 0x3FE}),
                EndsWith("the modes 2, 3, 4, 5, 6, 7, 8, 9, 10"));
  }
}

TEST_F(Problems, SayHowAPolarityIsSetRight) {
  for (const std::uint16_t index : {std::uint16_t{0x607E}, std::uint16_t{0x687E}}) {
    EXPECT_THAT(told({.kind = Kind::Different, .object = {index, 0}, .found = 0x380}),
                testing::AllOf(HasSubstr("turns its positions round (" + to_string({index, 0}) + " is 380h)"),
                               HasSubstr("or polarity to 128 where")));
  }
}

TEST_F(Problems, NameTheDescriptionByWhichADriveIsTreatedWhereItMayBeWrong) {
  DriveDescription drive;
  drive.file = "servo.json";
  for (auto kind = Kind::None; kind <= Kind::TwoHeartbeats; kind = static_cast<Kind>(static_cast<int>(kind) + 1)) {
    const bool may_be = kind == Kind::NoAnswer || kind == Kind::Refused || kind == Kind::Different;
    const std::string text = told({.kind = kind, .object = {0x6041, 0}, .drive = &drive});
    EXPECT_EQ(text.ends_with(". It is treated as servo.json says"), may_be) << text;
    EXPECT_THAT(told({.kind = kind, .object = {0x6041, 0}}), Not(HasSubstr("treated")));
  }
}

TEST_F(Problems, OfWhatWasPassedOverSayWhetherTheLoadCountsIt) {
  for (unsigned index = 0x17FE; index <= 0x1806; ++index) {
    const std::string text = noted({.kind = Kind::Refused,
                                    .object = {static_cast<std::uint16_t>(index), 1},
                                    .expected = 1,
                                    .found = 0x08000000,
                                    .writing = true});
    EXPECT_THAT(text, HasSubstr("general error (08000000h); it is not needed, and was passed over"));
    const bool sends = index >= 0x1801 && index <= 0x1803;
    EXPECT_EQ(text.ends_with(". What that PDO sends is not counted in the load"), sends) << text;
  }
  EXPECT_EQ(noted({.kind = Kind::Constant, .object = {0x1A00, 0}, .found = 0x06010002}),
            "node 5 (axis 0, 2) keeps 1A00h as it is, which will do: attempt to write a read-only object (06010002h)");
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
