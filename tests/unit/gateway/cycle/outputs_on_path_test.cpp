// RMAC_CAM's InTurn with outputs, on the whole controller: at their place within a cycle, through rounded corners.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

constexpr std::uint64_t kCoolant = 1U << 5;

class OutputsOnThePathOfAMill : public testing::TestWithParam<unsigned> {
 protected:
  sdk::RmacCam& cam() { return machine_.controller.cam(); }
  TestMachine machine_;
};

// Red when an output switches a cycle early or late, at another corner, or more or less often than was asked for, and
// when the path slows down for it.
TEST_P(OutputsOnThePathOfAMill, SwitchInTheCycleThatPassesThem) {
  ASSERT_TRUE(machine_.load_at_zero(TestMachine::mill()));
  const std::uint64_t before_it = machine_.controller.sample().moves_done;
  machine_.samples.clear();
  std::mt19937 random(GetParam());
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  constexpr double kTolerance = 0.02;
  ASSERT_TRUE(cam().path().set_feedrate(3000));
  ASSERT_TRUE(cam().path().set_tolerance(kTolerance));
  struct Place {
    std::uint64_t after_moves;
    Vector at;
    bool on;
    std::int64_t id;
  };
  std::vector<Place> places;
  Vector at{0, 0, 0};
  std::int64_t id = 0;
  constexpr std::uint64_t kMoves = 60;
  double turn = 0;
  for (std::uint64_t move = 1; move <= kMoves; ++move) {
    turn += within(-0.8, 0.8);
    const double length = std::pow(10, within(-1.3, 0.4));
    const Vector to{at[0] + length * std::cos(turn), at[1] + length * std::sin(turn), at[2]};
    ASSERT_TRUE(machine_.line(++id, at, to));
    at = to;
    for (int marks = within(0, 1) < 0.5 ? 1 : 0; marks > 0; marks -= within(0, 1) < 0.7 ? 1 : 0) {
      places.push_back({move, at, within(0, 1) < 0.5, ++id});
      ASSERT_TRUE(cam().flow().in_turn(id, {sdk::OutputCall{"Coolant", places.back().on}}));
    }
  }
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine_.run_until(
      [&] { return !machine_.samples.empty() && machine_.samples.back().moves_done == before_it + kMoves; }));
  std::size_t passed = 0;
  bool on = false;
  const CycleSample* before = nullptr;
  for (const CycleSample& sample : machine_.samples) {
    for (; passed < places.size() && before_it + places[passed].after_moves <= sample.moves_done; ++passed) {
      on = places[passed].on;
      ASSERT_NE(before, nullptr);
      // A cycle's way behind the corner at most, and what the rounding of corners and short lines moves it by.
      const Vector& place = places[passed].at;
      const double way = std::hypot(sample.position_set[0] - before->position_set[0],
                                    sample.position_set[1] - before->position_set[1]);
      EXPECT_LE(std::hypot(sample.position_set[0] - place[0], sample.position_set[1] - place[1]), way + 4 * kTolerance)
          << "mark " << places[passed].id;
    }
    ASSERT_EQ((sample.outputs & kCoolant) != 0, on) << "cycle " << sample.cycle << ", " << sample.moves_done;
    before = &sample;
  }
  EXPECT_EQ(passed, places.size());
  for (const Place& place : places) {
    EXPECT_EQ(machine_.count(Event::Kind::MoveStarted, place.id), 1) << place.id;
    EXPECT_EQ(machine_.count(Event::Kind::MoveDone, place.id), 1) << place.id;
  }
  std::vector<std::int64_t> done;
  for (const Event& event : machine_.events) {
    if (event.kind == Event::Kind::MoveDone) done.push_back(event.move_id);
  }
  EXPECT_EQ(done.size(), static_cast<std::size_t>(id));
  EXPECT_TRUE(std::ranges::is_sorted(done)) << "told in the order of the program";
}

INSTANTIATE_TEST_SUITE_P(Seeds, OutputsOnThePathOfAMill, testing::Range(1U, 9U));

}  // namespace
}  // namespace rmac::gateway
