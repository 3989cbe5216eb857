// What becomes of the bus itself, of all drives on it, or of a second master: whom a stop names.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>

#include "rmac/fieldbus/canopen/nmt.hpp"
#include "unit/fieldbus/canopen/canopen_bench.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using std::chrono::milliseconds;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class LostBus : public test::CanopenBench {
 protected:
  /// So many drives, operational; no SYNC may go unanswered.
  void run(int drives) {
    std::vector<double> nodes;
    for (int node = 1; node <= drives; ++node) {
      wire_.add(static_cast<std::uint8_t>(node));
      nodes.push_back(node);
    }
    make({{"node", nodes}, {"missed_answers", {0}}, {"load_share", {100}}});
    start();
    enable_all();
  }
  /// The servo loop stops for what `receive` says before it looks at drives.
  [[nodiscard]] bool receives() {
    wire_.pass(milliseconds(1));
    return master_->receive(feedback_);
  }
  [[nodiscard]] std::string silence(std::size_t axis) { return master_->silence_text(axis).value_or("nothing"); }
};

// Red when the bus is looked at only behind the drives that it has made silent.
TEST_F(LostBus, InBusOffFailsTheBusBeforeADriveIsFoundSilent) {
  run(2);
  wire_.cut = wire_.bus_off = true;
  EXPECT_FALSE(receives());
  EXPECT_THAT(master_->fault_text(), HasSubstr("bus-off"));
}

TEST_F(LostBus, WithItsInterfaceDownFailsTheBusBeforeADriveIsFoundSilent) {
  run(1);
  wire_.cut = wire_.link_down = true;
  EXPECT_FALSE(receives());
  EXPECT_THAT(master_->fault_text(), HasSubstr("systemctl restart rmac-can@can0"));
  wire_.cut = wire_.link_down = false;
  EXPECT_TRUE(receives()) << "it is up again";
}

// A cable that is pulled is told by no controller for milliseconds, and by a virtual one never.
TEST_F(LostBus, ThatNobodyAnswersOnIsNamedAndNotOneDrivesCable) {
  run(3);
  wire_.cut = true;
  cycle(DriveWish::Operational);
  cycle(DriveWish::Operational);
  for (const std::size_t axis : {0U, 1U, 2U}) {
    EXPECT_FALSE(feedback_[axis].online);
    EXPECT_THAT(silence(axis), AllOf(HasSubstr("none of the 3 nodes on can0 answers"), HasSubstr("termination"),
                                     HasSubstr("supply of the drives"), Not(HasSubstr("its cable"))));
  }
}

// The SYNC of a cycle got to some: the first that is missed is not missed together with the others.
TEST_F(LostBus, IsNamedAlsoWhereItBreaksInMidCycle) {
  run(2);
  test::VirtualDrive& third = wire_.add(3);
  third.power_off();
  wire_.gateway = [](CanFrame& frame) {
    return frame.id == 0x181 ? std::vector<test::CanWire::Time>() : std::vector{test::CanWire::Time(0)};
  };
  cycle(DriveWish::Operational);
  cycle(DriveWish::Operational);
  ASSERT_FALSE(feedback_[0].online);
  ASSERT_TRUE(feedback_[1].online);
  EXPECT_THAT(silence(0), Not(HasSubstr("none of the")));
  wire_.cut = true;
  cycle(DriveWish::Operational);
  cycle(DriveWish::Operational);
  EXPECT_THAT(silence(0), HasSubstr("none of the 2 nodes on can0 answers"));
}

TEST_F(LostBus, IsNotNamedForADriveThatIsSilentAlone) {
  run(3);
  wire_.gateway = [](CanFrame& frame) {
    return frame.id == 0x182 ? std::vector<test::CanWire::Time>() : std::vector{test::CanWire::Time(0)};
  };
  cycle(DriveWish::Operational);
  cycle(DriveWish::Operational);
  ASSERT_FALSE(feedback_[1].online);
  EXPECT_EQ(master_->silence_text(1), std::nullopt);
}

// What was is not told of a drive that falls silent later, alone.
TEST_F(LostBus, IsForgottenWhenItIsBack) {
  run(2);
  wire_.cut = true;
  cycles(3, DriveWish::Operational);
  wire_.cut = false;
  cycles(2000, DriveWish::Off);
  ASSERT_TRUE(feedback_[0].online && feedback_[1].online);
  wire_.gateway = [](CanFrame& frame) {
    return frame.id == 0x181 ? std::vector<test::CanWire::Time>() : std::vector{test::CanWire::Time(0)};
  };
  cycles(2, DriveWish::Off);
  EXPECT_EQ(master_->silence_text(0), std::nullopt);
}

// As the kernel takes an interface down: first its frames are lost, and milliseconds later sockets are told.
TEST_F(LostBus, WhoseInterfaceIsAboutToBeDownIsToldToBe) {
  run(3);
  wire_.cut = true;
  cycles(2, DriveWish::Operational);
  wire_.controller.link_down = true;
  EXPECT_EQ(silence(0), "the interface can0 is down; bring it up with systemctl restart rmac-can@can0");
}

TEST_F(LostBus, OfOneDriveIsToldByItsController) {
  run(1);
  wire_.cut = true;
  wire_.controller = {.state = CanController::State::ErrorPassive, .errors = CanController::ErrorCounters{128, 0}};
  cycles(2, DriveWish::Operational);
  EXPECT_THAT(silence(0), AllOf(HasSubstr("the controller of can0 is error-passive (128 transmit errors, 0 receive "
                                          "errors)"),
                                HasSubstr("check cable, termination and bit rate")));
  wire_.controller = {.state = CanController::State::ErrorActive, .errors = CanController::ErrorCounters{}};
  EXPECT_EQ(master_->silence_text(0), std::nullopt);
}

// Red when a drive that says where it is counts as one whose cable is broken.
TEST_F(LostBus, IsNotBlamedForADriveThatAnotherMasterStops) {
  run(2);
  wire_.intrude(nmt_frame(NmtCommand::EnterPreOperational, 2));
  cycles(60, DriveWish::Operational);
  ASSERT_FALSE(feedback_[1].online);
  EXPECT_THAT(silence(1), AllOf(HasSubstr("node 2 (axis 1): another master sent NMT command 80h for node 2"),
                                HasSubstr("rmac bus trace can0")));
  EXPECT_EQ(master_->silence_text(0), std::nullopt);
}

// Red when all drives that are told to leave operation are taken for a cable that is broken.
TEST_F(LostBus, IsNotTakenForBrokenWhereAnotherMasterStopsAllDrives) {
  run(2);
  wire_.intrude(nmt_frame(NmtCommand::Stop, 0));
  cycles(2, DriveWish::Operational);
  EXPECT_THAT(silence(0), HasSubstr("another master sent NMT command 02h for all nodes"));
}

TEST_F(LostBus, IsNotTakenForBrokenWhereAnotherMasterResetsOneDriveAfterTheOther) {
  run(3);
  for (const std::uint8_t node : std::array<std::uint8_t, 3>{1, 2, 3})
    wire_.intrude(nmt_frame(NmtCommand::ResetCommunication, node));
  cycles(2, DriveWish::Operational);
  for (const std::size_t axis : {0U, 1U, 2U})
    EXPECT_THAT(silence(axis), HasSubstr(fmt::format("NMT command 82h for node {}", axis + 1)));
}

// As after a computer that stood still: the drives heard no master for longer than they bear.
TEST_F(LostBus, IsNotTakenForBrokenWhereAllDrivesLeaveOperationByThemselves) {
  run(2);
  for (const std::uint16_t id : std::array<std::uint16_t, 2>{0x701, 0x702})
    wire_.inject({.id = id, .size = 1, .data = {0x7F}});
  cycle(DriveWish::Operational);
  EXPECT_THAT(silence(0), AllOf(HasSubstr("left Operational"), Not(HasSubstr("none of"))));
}

TEST_F(LostBus, IsNotNamedForTheOneThatStaysAwayWhenTheOthersAreBack) {
  run(3);
  wire_.cut = true;
  cycles(2, DriveWish::Operational);
  wire_.cut = false;
  wire_.gateway = [](CanFrame& frame) {
    return (frame.id & 0x7FU) == 1 ? std::vector<test::CanWire::Time>() : std::vector{test::CanWire::Time(0)};
  };
  cycles(3000, DriveWish::Off);
  ASSERT_TRUE(feedback_[1].online);
  EXPECT_THAT(silence(0), Not(HasSubstr("none of the")));
}

TEST_F(LostBus, IsNotBlamedForADriveThatLeavesOperationByItself) {
  run(1);
  wire_.inject({.id = 0x081, .size = 8, .data = {0x30, 0x81, 0x11}});
  wire_.inject({.id = 0x701, .size = 1, .data = {4}});
  cycle(DriveWish::Operational);
  EXPECT_THAT(silence(0), AllOf(HasSubstr("left Operational, and says that it is stopped"),
                                HasSubstr("its last emergency was 8130h"), Not(HasSubstr("NMT command"))));
}

// Two masters: drives act on either's SYNC, on setpoints that are not of that cycle.
TEST_F(LostBus, WithASecondMasterThatSendsSyncFailsTheBusAndSaysSo) {
  run(2);
  bool failed = false;
  for (int i = 0; i < 10 && !failed; ++i) {
    wire_.intrude(sync_frame());
    failed = !receives();
    (void)master_->send(commands_);
  }
  EXPECT_TRUE(failed);
  EXPECT_THAT(master_->fault_text(), AllOf(HasSubstr("another node sends SYNC"), HasSubstr("sync to \"external\"")));
  EXPECT_EQ(master_->counters().duplicates, 0U) << "no drive is two because it answers two SYNCs";
  cycles(2000, DriveWish::Off);
  EXPECT_TRUE(receives()) << "it was switched off";
}

TEST_F(LostBus, TakesAStraySyncForNone) {
  run(1);
  for (int i = 0; i < 5; ++i) {
    wire_.intrude(sync_frame());
    for (int j = 0; j < 1200; ++j) {
      cycle(DriveWish::Operational);
      ASSERT_TRUE(sound_);
    }
  }
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
