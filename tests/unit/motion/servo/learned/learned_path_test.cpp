#include "rmac/motion/servo/learned_path.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

namespace rmac {
namespace {

using testing::HasSubstr;

double wave(double along) {
  return 0.01 * std::sin(along / 5);
}

/// Moves 10, 20 and 30 of 10 mm each, a knot each 0.1 mm, of two joints; of the second it is half as much.
LearnedPath::Parts three_moves() {
  LearnedPath::Parts parts{{{10, 0}, {20, 10}, {30, 20}}, 30, {}, 2, {}};
  for (int i = 0; i <= 300; ++i) {
    parts.places.push_back(0.1 * i);
    parts.offsets.push_back(wave(parts.places.back()));
    parts.offsets.push_back(0.5 * wave(parts.places.back()));
  }
  return parts;
}

std::string refusal_of(const std::function<void(LearnedPath::Parts&)>& change) {
  LearnedPath::Parts parts = three_moves();
  change(parts);
  const auto made = LearnedPath::create(parts);
  return made ? "none" : made.error().message;
}

TEST(LearnedPath, TellsWhatWasLearnedAtEachPlaceAtAnyPace) {
  const auto path = LearnedPath::create(three_moves());
  ASSERT_TRUE(path);
  std::mt19937 random(1);
  for (int seed = 0; seed < 20; ++seed) {
    LearnedPath::Cursor cursor;
    double offsets[2] = {};
    std::uniform_real_distribution<double> step(0.001, 0.5);
    for (double along = 0; along < 30; along += step(random)) {
      const auto move = static_cast<int>(along / 10);
      ASSERT_TRUE(path->at(cursor, 10 * (move + 1), along - 10 * move, offsets));
      // Beyond the ends nothing is known of the slope.
      const double bound = along > 0.1 && along < 29.9 ? 2e-6 : 3e-5;
      ASSERT_NEAR(offsets[0], wave(along), bound) << "at " << along;
      ASSERT_NEAR(offsets[1], 0.5 * wave(along), bound) << "at " << along;
    }
  }
}

// Red when a move that has no place of its own ends what is learned.
TEST(LearnedPath, GoesThroughMovesThatWereTooShortToBeSeenAndNoFurther) {
  const auto path = LearnedPath::create(three_moves());
  LearnedPath::Cursor cursor;
  double offsets[2] = {};
  ASSERT_TRUE(path->at(cursor, 10, 9.0, offsets));
  ASSERT_TRUE(path->at(cursor, 10, 9.1, offsets));
  for (int i = 1; i <= 5; ++i) {
    ASSERT_TRUE(path->at(cursor, 15, 0, offsets));
    EXPECT_NEAR(offsets[0], wave(9.1 + 0.1 * i), 2e-6);
  }
  ASSERT_TRUE(path->at(cursor, 20, 0.1, offsets));
  EXPECT_NEAR(offsets[0], wave(10.1), 2e-6);
  for (int i = 0; i < 20; ++i) static_cast<void>(path->at(cursor, 15, 0, offsets));
  EXPECT_FALSE(path->at(cursor, 15, 0, offsets));
  LearnedPath::Cursor fresh;
  EXPECT_FALSE(path->at(fresh, 99, 1, offsets)) << "a jog, or another program";
}

TEST(LearnedPath, AnApproachThatIsLongerStaysBeforeTheNextMove) {
  const auto path = LearnedPath::create(three_moves());
  LearnedPath::Cursor cursor;
  double offsets[2] = {};
  ASSERT_TRUE(path->at(cursor, 10, 500, offsets));
  EXPECT_NEAR(offsets[0], wave(10), 2e-6);
  ASSERT_TRUE(path->at(cursor, 30, 500, offsets));
  EXPECT_NEAR(offsets[0], wave(30), 2e-6);
  ASSERT_TRUE(path->at(cursor, 10, -5, offsets));
  EXPECT_NEAR(offsets[0], 0, 2e-6);
  EXPECT_FALSE(path->at(cursor, 10, std::nan(""), offsets));
}

TEST(LearnedPath, TellsTheLargestOffsetsAndTheSteepestChange) {
  const auto path = LearnedPath::create(three_moves());
  EXPECT_NEAR(path->largest(0), 0.01, 1e-5);
  EXPECT_NEAR(path->largest(1), 0.005, 1e-5);
  EXPECT_NEAR(path->steepest(), 0.01 / 5 * 0.1, 1e-6);
}

TEST(LearnedPath, RefusesWhatMakesNoSense) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal_of([](auto& parts) { parts.moves.clear(); }), HasSubstr("no move"));
  EXPECT_THAT(refusal_of([](auto& parts) { parts.moves[2].id = 10; }), HasSubstr("two moves have the id 10"));
  EXPECT_THAT(refusal_of([](auto& parts) { parts.moves[2].begin_mm = 5; }), HasSubstr("move 30 begins before"));
  EXPECT_THAT(refusal_of([&](auto& parts) { parts.moves[1].begin_mm = nan; }), HasSubstr("move 20 begins before"));
  EXPECT_THAT(refusal_of([](auto& parts) { parts.end_mm = 1; }), HasSubstr("ends before it begins"));
  EXPECT_THAT(refusal_of([&](auto& parts) { parts.end_mm = infinity; }), HasSubstr("ends before it begins"));
  EXPECT_THAT(refusal_of([](auto& parts) { parts.places[7] = parts.places[6]; }), HasSubstr("knot 7 does not"));
  EXPECT_THAT(refusal_of([&](auto& parts) { parts.places[7] = nan; }), HasSubstr("knot 7 does not"));
  EXPECT_THAT(refusal_of([&](auto& parts) { parts.offsets[9] = nan; }), HasSubstr("an offset is no number"));
  EXPECT_THAT(refusal_of([&](auto& parts) { parts.offsets[9] = infinity; }), HasSubstr("an offset is no number"));
  EXPECT_THAT(refusal_of([](auto& parts) { parts.offsets.pop_back(); }), HasSubstr("an offset for each knot"));
  EXPECT_THAT(refusal_of([](auto& parts) { parts.joints = 0; }), HasSubstr("an offset for each knot"));
  EXPECT_THAT(refusal_of([](auto& parts) { parts.places.resize(1); }), HasSubstr("1 knots"));
  EXPECT_THAT(refusal_of([](auto& parts) { parts.places.resize(1'000'000); }), HasSubstr("1000000 knots"));
}

}  // namespace
}  // namespace rmac
