// RMAC_CAM's ParkProgram: what is held is set aside, and goes on from its place, in the frames in force then.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "rmac/motion/frame.hpp"
#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const ToolPose kUpright{{0, 0, 0}, {0, 0, 1}};

ToolPose at(double x, double y, double z) {
  return {{x, y, z}, kUpright.axis};
}

/// The mill in the role of a measuring machine.
sdk::DeviceObject measuring_role() {
  sdk::DeviceObject device = TestMachine::mill();
  device.name = "Measurer";
  device.overlay = true;
  device.overlay_of = "Mill";
  return device;
}

class ParkProgram : public testing::Test {
 protected:
  void SetUp() override {
    const auto loaded = machine_.load_at_zero(TestMachine::mill());
    ASSERT_TRUE(loaded) << loaded.error().message;
  }
  /// A quarter of an arc between two lines, a positioning move and one of the joints.
  void queue(double feed_mm_min = 300) {
    ASSERT_TRUE(cam().path().set_feedrate(feed_mm_min));
    ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {8, 0, 0}));
    ASSERT_TRUE(cam().queue().add(2, ArcGeometry{{8, 4, 0}, {0, 0, 1}, 1, false, at(8, 0, 0), at(12, 4, 0)}));
    ASSERT_TRUE(machine_.line(3, {12, 4, 0}, {12, 12, 2}));
    ASSERT_TRUE(cam().queue().add(4, PathTargetGeometry{at(4, 12, 2)}));
    ASSERT_TRUE(cam().queue().add(5, JointTargetGeometry{{-2, 6, 1}}));
    ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  }
  void hold() {
    ASSERT_TRUE(cam().cycle().hold());
    ASSERT_TRUE(machine_.run_until([&] { return !machine_.controller.sample().moving && rests(); }));
  }
  [[nodiscard]] bool rests() {
    machine_.controller.dispatch();
    return !machine_.samples.empty() && !machine_.samples.back().moving;
  }
  /// The machine is up to twice 4096 cycles ahead of who hears of it: each of the first three moves lasts longer.
  void queue_and_hold_in(std::int64_t move) {
    queue(30);
    hold_in(move);
  }
  void hold_in(std::int64_t move) {
    ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveStarted, move));
    hold();
  }
  void park() {
    // Hold and rest are told by different threads.
    Expected<> parked;
    ASSERT_TRUE(machine_.run_until([&] {
      parked = cam().parking().park();
      return parked || parked.error().message.find("coming to rest") == std::string::npos;
    }));
    ASSERT_TRUE(parked) << parked.error().message;
  }
  void take_up() {
    const auto taken = cam().parking().take_up();
    ASSERT_TRUE(taken) << taken.error().message;
    EXPECT_EQ(state(), CycleState::Holding);
  }
  void finish() {
    ASSERT_TRUE(cam().cycle().resume());
    ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 5));
    ASSERT_TRUE(machine_.run_until([&] { return rests(); }));
  }
  sdk::RmacCam& cam() { return machine_.controller.cam(); }
  [[nodiscard]] CycleState state() { return machine_.controller.cycle_now().state; }
  [[nodiscard]] std::vector<std::int64_t> done() const {
    std::vector<std::int64_t> ids;
    for (const Event& event : machine_.events) {
      if (event.kind == Event::Kind::MoveDone && event.move_id > 0) ids.push_back(event.move_id);
    }
    return ids;
  }
  /// How far a point in the part is from the program's path.
  static double off_path(const Vector& p) {
    const auto from_line = [&](const Vector& a, const Vector& b) {
      Vector way{}, to{};
      double along = 0, length = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        way[i] = b[i] - a[i];
        to[i] = p[i] - a[i];
        along += way[i] * to[i];
        length += way[i] * way[i];
      }
      const double t = std::clamp(along / length, 0.0, 1.0);
      return std::hypot(to[0] - t * way[0], to[1] - t * way[1], to[2] - t * way[2]);
    };
    const bool on_arc_side = p[0] >= 8 && p[1] <= 4;
    const double arc = on_arc_side ? std::hypot(std::hypot(p[0] - 8, p[1] - 4) - 4, p[2]) : 1e9;
    return std::min({from_line({0, 0, 0}, {8, 0, 0}), arc, from_line({12, 4, 0}, {12, 12, 2}),
                     from_line({12, 12, 2}, {4, 12, 2}), from_line({4, 12, 2}, {-2, 6, 1})});
  }
  TestMachine machine_;
};

TEST_F(ParkProgram, GoesOnFromItsPlaceWhereverItWasHeld) {
  std::mt19937 random(20261122);  // NOLINT(cert-msc51-cpp): the same instants every time
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    ASSERT_TRUE(cam().queue().add(6, JointTargetGeometry{{0, 0, 0}}));
    ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
    ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 6));
    ASSERT_TRUE(cam().cycle().stop());
    ASSERT_TRUE(machine_.run_until([&] { return state() == CycleState::Idle && rests(); }));
    machine_.events.clear();
    machine_.samples.clear();
    queue();
    const std::size_t cycles = std::uniform_int_distribution<std::size_t>(1, 6500)(random);
    ASSERT_TRUE(machine_.run_until([&] { return machine_.samples.size() > cycles || done().size() == 5; }));
    hold();
    if (done().size() < 5) {
      park();
      EXPECT_EQ(cam().queue().moves_left(), 0);
      EXPECT_EQ(state(), CycleState::Idle);
      take_up();
      finish();
    }
    EXPECT_THAT(done(), ElementsAre(1, 2, 3, 4, 5)) << "each move once";
    double largest = 0, longest_step = 0;
    const CycleSample* before = nullptr;
    for (const CycleSample& sample : machine_.samples) {
      largest = std::max(largest, off_path({sample.position_set[0], sample.position_set[1], sample.position_set[2]}));
      for (std::size_t j = 0; before != nullptr && j < 3; ++j) {
        longest_step = std::max(longest_step, std::abs(sample.position_set[j] - before->position_set[j]));
      }
      before = &sample;
    }
    EXPECT_LT(largest, 1e-6) << "nothing is cut beside the path";
    EXPECT_LT(longest_step, 0.201) << "200 mm/s in a millisecond: nothing is left out";
    EXPECT_NEAR(machine_.samples.back().position_set[0], -2, 1e-6);
  }
}

// Red when what is done is done once more, or what was begun is lost.
TEST_F(ParkProgram, DoesWhatStandsBetweenItsMovesOnce) {
  ASSERT_TRUE(cam().path().set_feedrate(1200));
  ASSERT_TRUE(cam().flow().dwell(1, 0.2));
  ASSERT_TRUE(machine_.line(2, {0, 0, 0}, {8, 0, 0}));
  ASSERT_TRUE(cam().flow().stop(3, false, "look"));
  ASSERT_TRUE(cam().flow().dwell(4, 30));
  ASSERT_TRUE(machine_.line(5, {8, 0, 0}, {8, 4, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::ProgramStopped, 3));
  EXPECT_EQ(state(), CycleState::Holding);
  EXPECT_EQ(machine_.controller.cycle_now().stop_prompt, "program stop 3: look");
  EXPECT_EQ(cam().queue().moves_left(), 3);
  park();
  EXPECT_EQ(machine_.controller.cycle_now().stop_prompt, "");
  EXPECT_EQ(cam().parking().parked()->move_id, 3) << "nobody went on: it holds once more";
  take_up();
  ASSERT_TRUE(cam().cycle().resume());
  ASSERT_TRUE(machine_.run_until([&] { return machine_.count(Event::Kind::ProgramStopped, 3) == 2; }));
  ASSERT_TRUE(cam().cycle().resume());
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveStarted, 4));
  hold();
  park();
  EXPECT_EQ(cam().parking().parked()->move_id, 4);
  EXPECT_EQ(cam().parking().parked()->moves, 2U);
  take_up();
  const double began_s = machine_.controller.sample().t_s;
  finish();
  EXPECT_GE(machine_.controller.sample().t_s - began_s, 30) << "all of its time, from its begin";
  EXPECT_THAT(done(), ElementsAre(1, 2, 3, 4, 5));
}

TEST_F(ParkProgram, LaysWhatIsLeftInTheFrameThatIsInForceThen) {
  queue_and_hold_in(2);
  park();
  Frame found;
  found.p = {0.3, -0.2, 0.1};
  const double half = 0.1 * 3.14159265358979 / 180;
  found.q = {std::cos(half), 0, 0, std::sin(half)};
  ASSERT_TRUE(cam().frames().set_part(found));
  const auto parked = cam().parking().parked();
  ASSERT_TRUE(parked);
  EXPECT_EQ(parked->move_id, 2);
  EXPECT_EQ(parked->moves, 4U);
  EXPECT_GT(parked->s_mm, 0);
  EXPECT_NEAR(parked->off_mm, std::hypot(0.3, 0.2, 0.1), 0.1);
  take_up();
  machine_.samples.clear();
  finish();
  bool on_it = false;
  for (const CycleSample& sample : machine_.samples) {
    if (!sample.moving || (sample.move_id != 2 && sample.move_id != 3)) continue;
    on_it = true;
    const ToolPose in_part = apply_to_pose(
        inverse(found), {{sample.position_set[0], sample.position_set[1], sample.position_set[2]}, {0, 0, 1}});
    ASSERT_LT(off_path(in_part.tip), 1e-6) << "move " << sample.move_id << " at " << sample.s_mm;
  }
  EXPECT_TRUE(on_it);
  EXPECT_THAT(done(), ElementsAre(1, 2, 3, 4, 5));
}

TEST_F(ParkProgram, TakesNothingUpWhereTheToolStandsElsewhere) {
  queue_and_hold_in(3);
  park();
  ASSERT_TRUE(cam().positioning().jog_joint(2, 5));
  ASSERT_TRUE(machine_.run_until([&] { return state() == CycleState::Idle && rests(); }));
  const auto refused = cam().parking().take_up();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("stands 5.000 mm from where the program goes on, 12.0000"));
  EXPECT_THAT(refused.error().message, HasSubstr("stays parked"));
  EXPECT_EQ(cam().queue().moves_left(), 0);
  EXPECT_NEAR(cam().parking().parked()->off_mm, 5, 1e-6);
  ASSERT_TRUE(cam().positioning().jog_joint(2, -5));
  ASSERT_TRUE(machine_.run_until([&] { return state() == CycleState::Idle && rests(); }));
  take_up();
  finish();
  EXPECT_THAT(done(), ElementsAre(1, 2, 3, 4, 5));
}

TEST_F(ParkProgram, RefusesAFrameInWhichTheRestCannotBeReached) {
  ASSERT_TRUE(cam().path().set_feedrate(120));
  ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {20, 0, 0}));
  ASSERT_TRUE(machine_.line(2, {20, 0, 0}, {20, 49.9, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  hold_in(1);
  park();
  Frame shifted;
  shifted.p = {0, 0.5, 0};
  ASSERT_TRUE(cam().frames().set_part(shifted));
  const auto refused = cam().parking().take_up();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("move 2 takes joint Y"));
  EXPECT_EQ(cam().queue().moves_left(), 0);
  ASSERT_TRUE(cam().parking().parked());
  ASSERT_TRUE(cam().frames().set_part({}));
  take_up();
  EXPECT_EQ(cam().queue().moves_left(), 2);
}

TEST_F(ParkProgram, StopsTheSpindleAndHasItTurningAgainBeforeItGoesOn) {
  ASSERT_TRUE(cam().spindles().set_rpm(0, 800));
  ASSERT_TRUE(cam().spindles().set_coolant(true));
  queue_and_hold_in(2);
  EXPECT_NEAR(machine_.controller.sample().spindle_rpm[0], 800, 25);
  park();
  ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.sample().spindle_rpm[0] < 1; }));
  EXPECT_EQ(machine_.controller.sample().outputs & (1U << 5), 0U);
  take_up();
  machine_.samples.clear();
  ASSERT_TRUE(machine_.run_until([&] { return machine_.samples.size() > 300; }));
  EXPECT_LT(machine_.samples.back().spindle_rpm[0], 1) << "nothing begins by itself";
  finish();
  for (const CycleSample& sample : machine_.samples) {
    if (sample.moving) {
      EXPECT_GT(sample.spindle_rpm[0], 775);
      EXPECT_NE(sample.outputs & (1U << 5), 0U);
      break;
    }
  }
}

TEST_F(ParkProgram, OutlastsAnotherRoleOfTheSameMachine) {
  Frame part;
  part.p = {1, 2, 0};
  ASSERT_TRUE(cam().frames().set_part(part));
  ASSERT_TRUE(cam().path().set_feedrate(300));
  ASSERT_TRUE(cam().queue().add(6, PathTargetGeometry{at(0, 0, 0)}));
  queue_and_hold_in(2);
  park();
  const auto loaded = machine_.load(measuring_role());
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(cam().frames().part().p, part.p);
  const auto refused = cam().parking().take_up();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("parked on Mill; load that first"));
  Frame corrected;
  corrected.p = {1.2, 2, 0};
  ASSERT_TRUE(cam().frames().set_part(corrected));
  ASSERT_TRUE(machine_.load(TestMachine::mill()));
  EXPECT_EQ(cam().frames().part().p, corrected.p);
  take_up();
  machine_.samples.clear();
  finish();
  double largest = 0;
  for (const CycleSample& sample : machine_.samples) {
    if (!sample.moving || (sample.move_id != 2 && sample.move_id != 3)) continue;
    largest =
        std::max(largest, off_path({sample.position_set[0] - 1.2, sample.position_set[1] - 2, sample.position_set[2]}));
  }
  EXPECT_LT(largest, 1e-6);
}

TEST_F(ParkProgram, EndsWhenAnotherMachineIsLoadedAndSurvivesOneThatCannotBe) {
  queue_and_hold_in(2);
  park();
  sdk::DeviceObject broken = measuring_role();
  broken.kinematics.name = "NoSuchModule";
  ASSERT_FALSE(machine_.load(broken));
  machine_.controller.discard_draft();
  ASSERT_TRUE(cam().parking().parked());
  ASSERT_TRUE(machine_.load(TestMachine::plane_mill()));
  EXPECT_FALSE(cam().parking().parked());
  machine_.controller.dispatch();
  bool told = false;
  for (const Event& event : machine_.events)
    told = told || event.message.find("is dropped, with 4") != std::string::npos;
  EXPECT_TRUE(told);
}

TEST_F(ParkProgram, SetsAsideOnlyWhatIsHeld) {
  EXPECT_THAT(cam().parking().park().error().message, HasSubstr("nothing is queued"));
  queue(30);
  EXPECT_THAT(cam().parking().park().error().message, HasSubstr("FeedHold first"));
  hold_in(2);
  park();
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  EXPECT_THAT(cam().parking().take_up().error().message, HasSubstr("the cycle is under way"));
  ASSERT_TRUE(cam().cycle().stop());
  ASSERT_TRUE(machine_.run_until([&] { return state() == CycleState::Idle; }));
  ASSERT_TRUE(cam().parking().drop());
  EXPECT_FALSE(cam().parking().parked());
  EXPECT_THAT(cam().parking().take_up().error().message, HasSubstr("no program is parked"));
}

TEST_F(ParkProgram, CanBeRepeatedOnTheWayBack) {
  queue_and_hold_in(2);
  for (int i = 0; i < 3; ++i) {
    park();
    take_up();
  }
  finish();
  EXPECT_THAT(done(), ElementsAre(1, 2, 3, 4, 5));
}

}  // namespace
}  // namespace rmac::gateway
