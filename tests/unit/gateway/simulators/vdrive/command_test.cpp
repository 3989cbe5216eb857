#include "gateway/simulators/vdrive/command.hpp"

#include <gmock/gmock.h>

#include "unit/gateway/simulators/vdrive/node_bench.hpp"

namespace rmac::vdrive::test {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

class VirtualDriveCommands : public testing::Test {
 protected:
  VirtualDriveCommands() {
    for (const std::uint8_t id : {std::uint8_t{1}, std::uint8_t{2}}) {
      nodes_.push_back(std::make_unique<Node>(sheet(), id, fieldbus::AxisPlantParameters()));
      nodes_.back()->power_on(now_);
      nodes_.back()->take_output(now_).clear();
    }
  }
  std::string say(const std::string& line) {
    const auto answer = execute(line, nodes_, now_);
    return answer ? *answer : "error: " + answer.error().message;
  }
  /// The size of what a node answers to a read of its device type; 0 for nothing.
  std::size_t answers(std::size_t node) {
    nodes_[node]->receive(frame(static_cast<std::uint16_t>(0x601 + node), {0x40, 0, 0x10, 0, 0, 0, 0, 0}), now_);
    return nodes_[node]->take_output(now_).size();
  }

  Nodes nodes_;
  Time now_{std::chrono::seconds(1)};
};

TEST_F(VirtualDriveCommands, MakeOneNodeOrAllOfThemFail) {
  EXPECT_EQ(say("2 mute on"), "node 2 mute on");
  EXPECT_EQ(answers(0), 1U);
  EXPECT_EQ(answers(1), 0U);
  EXPECT_EQ(say("all mute off"), "node 1 mute off\nnode 2 mute off");
  EXPECT_EQ(answers(1), 1U);
  EXPECT_EQ(say("1 slow 20"), "node 1 slow 20");
  EXPECT_EQ(answers(0), 0U);
  now_ += milliseconds(20);
  EXPECT_EQ(nodes_[0]->take_output(now_).size(), 1U);
  say("1 slow 0");
  say("1 jump -500");
  EXPECT_THAT(say("1 status"), HasSubstr("node 1 pre-operational switch-on-disabled at -500 counts"));
  say("1 trip 0x7305");
  now_ += milliseconds(2);
  nodes_[0]->poll(now_);
  EXPECT_THAT(say("all status"), HasSubstr("node 1 pre-operational fault"));
  say("2 power off");
  EXPECT_EQ(answers(1), 0U);
  EXPECT_THAT(say("2 status"), HasSubstr("node 2 off"));
  say("2 power on");
  const auto boot = nodes_[1]->take_output(now_);
  ASSERT_EQ(boot.size(), 1U);
  EXPECT_EQ(boot[0], frame(0x702, {0}));
}

TEST_F(VirtualDriveCommands, ChangeTheLengthOfPdos) {
  nodes_[0]->receive(frame(0, {1, 1}), now_);
  nodes_[0]->poll(now_);
  nodes_[0]->take_output(now_).clear();
  // TPDO 1 tells the statusword when it changes.
  const auto told = [&](std::uint8_t controlword) {
    now_ += milliseconds(20);
    nodes_[0]->receive(frame(0x201, {controlword, 0}), now_);
    now_ += milliseconds(20);
    nodes_[0]->poll(now_);
    for (const CanFrame& out : nodes_[0]->take_output(now_)) {
      if (out.id == 0x181) return static_cast<int>(out.size);
    }
    return -1;
  };
  EXPECT_EQ(told(6), 2);
  say("1 pdo -1");
  EXPECT_EQ(told(0), 1);
  say("1 pdo 3");
  EXPECT_EQ(told(6), 5);
  say("1 pdo 0");
  EXPECT_EQ(told(0), 2);
}

TEST_F(VirtualDriveCommands, SayWhatTheyDoNotUnderstand) {
  EXPECT_EQ(say("3 mute on"), "error: there is no node 3 here");
  EXPECT_EQ(say("200 mute on"), "error: the node: \"200\" is no whole number from 1 to 127");
  EXPECT_EQ(say("1 mute"), "error: \"\" is neither on nor off");
  EXPECT_EQ(say("1 slow x"), "error: \"x\" is no whole number from 0 to 60000");
  EXPECT_EQ(
      say("1 dance on"),
      "error: \"dance\" is not understood; there are mute, slow, pdo, jump, hot, touch, trip, power, status and help");
  EXPECT_EQ(say("1 mute on now"), "error: a command is NODE, what, and a value: 1 mute on");
  EXPECT_THAT(say("help"), HasSubstr("NODE jump COUNTS"));
}

TEST_F(VirtualDriveCommands, AreReadWithTheirTime) {
  const auto read = read_scheduled("2.5 1 mute on");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->at, milliseconds(2500));
  EXPECT_EQ(read->line, "1 mute on");
  EXPECT_FALSE(read_scheduled("soon 1 mute on").has_value());
  EXPECT_FALSE(read_scheduled("-1 1 mute on").has_value());
  EXPECT_FALSE(read_scheduled("2").has_value());
}

}  // namespace
}  // namespace rmac::vdrive::test
