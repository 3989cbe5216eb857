// The ways beside lines and arcs, and where they cross, held against the contour that they are beside.
#include "clients/legacy/gcode/radius/offset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace rmac::gcode {
namespace {

constexpr double kWholeTurn = 2 * std::numbers::pi;

double apart(const Flat& a, const Flat& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double within(double low, double high) { return std::uniform_real_distribution(low, high)(engine_); }
  Flat place() { return {within(-50, 50), within(-50, 50)}; }

 private:
  std::mt19937 engine_;
};

TEST(Offset, OfALineIsBesideIt) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    const Flat begin = random.place(), end = random.place();
    const double left = random.within(-9, 9), way = apart(begin, end);
    const Flat along{(end.x - begin.x) / way, (end.y - begin.y) / way};
    const Offset offset = Offset::of_line(begin, end, left);
    EXPECT_NEAR(offset.length(), way, 1e-9);
    EXPECT_EQ(offset.tolerance(), 1e-6);
    for (const double place : {-3.0, 0.0, way / 3, way}) {
      const Flat wanted{begin.x + along.x * place - along.y * left, begin.y + along.y * place + along.x * left};
      EXPECT_LT(apart(offset.at(place), wanted), 1e-9) << seed;
      EXPECT_NEAR(offset.near_begin(wanted), place, 1e-9) << seed;
    }
    EXPECT_LT(apart(offset.first_direction(), along), 1e-12) << seed;
    EXPECT_LT(apart(offset.last_direction(), along), 1e-12) << seed;
    for (const double side : {-1.0, 1.0}) {
      const Flat beside{offset.at(2).x - along.y * side, offset.at(2).y + along.x * side};
      EXPECT_EQ(offset.has_beside(beside, 5), side > 0) << seed;
      EXPECT_EQ(offset.has_beside(beside, -5), side < 0) << seed;
    }
    EXPECT_TRUE(offset.has_beside(offset.at(1), 5) && offset.has_beside(offset.at(1), -5)) << "on it";
  }
}

TEST(Offset, OfAnArcIsAnArcAboutTheSameCentre) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    const Flat centre = random.place();
    const double radius = random.within(10, 40), left = random.within(-9, 9), from = random.within(-3, 3);
    const double sweep = random.within(0.1, 1.9 * kWholeTurn);
    const bool left_turn = seed % 2 == 0;
    const auto on = [&](double radius_mm, double turned) {
      const double angle = from + (left_turn ? turned : -turned);
      return Flat{centre.x + radius_mm * std::cos(angle), centre.y + radius_mm * std::sin(angle)};
    };
    const auto offset = Offset::of_arc(on(radius, 0), centre, left_turn, sweep, left);
    ASSERT_TRUE(offset) << seed;
    const double beside = left_turn ? radius - left : radius + left;
    EXPECT_EQ(offset->length(), sweep);
    EXPECT_NEAR(offset->tolerance(), 1e-6 / beside, 1e-12);
    for (const double turned : {0.0, sweep / 3, sweep}) EXPECT_LT(apart(offset->at(turned), on(beside, turned)), 1e-9);
    for (const double turned : {-0.5, 0.0, 0.5, 2.0}) EXPECT_NEAR(offset->near_begin(on(beside, turned)), turned, 1e-9);
    const auto tangent = [&](double turned) {
      const Flat a = on(1, turned), b = on(1, turned + 1e-6);
      return Flat{(b.x - a.x) * 1e6, (b.y - a.y) * 1e6};
    };
    EXPECT_LT(apart(offset->first_direction(), tangent(0)), 1e-5) << seed;
    EXPECT_LT(apart(offset->last_direction(), tangent(sweep)), 1e-5) << seed;
    EXPECT_FALSE(offset->has_beside(on(beside, 0), left)) << "only a line has sides";
    const double whole = left_turn ? radius : -radius;
    EXPECT_FALSE(Offset::of_arc(on(radius, 0), centre, left_turn, sweep, whole)) << "the tool is as large";
    EXPECT_FALSE(Offset::of_arc(on(radius, 0), centre, left_turn, sweep, whole * 1.1));
  }
}

/// Two ways through one place, each from its begin to beyond it: they meet there and nowhere later on the first.
TEST(Offset, MeetsWhereBothAreAtOnePlace) {
  for (unsigned seed = 1; seed <= 400; ++seed) {
    Random random(seed);
    const Flat place = random.place();
    struct Way {
      Offset offset;
      double there;
    };
    const auto through = [&](bool is_arc) -> Way {
      const double angle = random.within(-3, 3);
      if (!is_arc) {
        const double before = random.within(1, 9), behind = random.within(1, 9);
        const Flat along{std::cos(angle), std::sin(angle)};
        return {Offset::of_line({place.x - along.x * before, place.y - along.y * before},
                                {place.x + along.x * behind, place.y + along.y * behind}, 0),
                before};
      }
      const bool left_turn = random.within(0, 1) < 0.5;
      const double radius = random.within(20, 60), before = random.within(0.05, 0.15),
                   behind = random.within(0.05, 0.15);
      const Flat centre{place.x + radius * std::cos(angle), place.y + radius * std::sin(angle)};
      const double begin = angle + std::numbers::pi + (left_turn ? -before : before);
      return {*Offset::of_arc({centre.x + radius * std::cos(begin), centre.y + radius * std::sin(begin)}, centre,
                              left_turn, before + behind, 0),
              before};
    };
    const Way first = through(seed % 2 == 0), second = through(seed % 4 < 2);
    const Flat one = first.offset.first_direction(), other = second.offset.first_direction();
    if (std::abs(one.x * other.y - one.y * other.x) < 0.5) continue;  // they may cross twice
    const auto meeting = Offset::meet(first.offset, 0, second.offset);
    ASSERT_TRUE(meeting) << seed;
    EXPECT_NEAR(meeting->on_first, first.there, 1e-7) << seed;
    EXPECT_NEAR(meeting->on_second, second.there, 1e-7) << seed;
    EXPECT_TRUE(Offset::meet(first.offset, first.there, second.offset)) << seed;
    EXPECT_FALSE(Offset::meet(first.offset, first.there + 0.01, second.offset)) << "not before where it may";
  }
}

TEST(Offset, DoesNotMeetWhatIsBesideOrEndsBefore) {
  const Offset line = Offset::of_line({0, 0}, {10, 0}, 0);
  EXPECT_FALSE(Offset::meet(line, 0, Offset::of_line({0, 1}, {10, 1}, 0))) << "parallel";
  EXPECT_FALSE(Offset::meet(line, 0, Offset::of_line({11, -1}, {11, 1}, 0))) << "behind the first's end";
  EXPECT_FALSE(Offset::meet(line, 0, Offset::of_line({5, -2}, {5, -1}, 0))) << "before it";
  EXPECT_FALSE(Offset::meet(line, 0, Offset::of_line({5, 1}, {5, 2}, 0))) << "behind it";
  const auto circle = [](double x, double y, double radius) {
    return *Offset::of_arc({x + radius, y}, {x, y}, true, kWholeTurn, 0);
  };
  EXPECT_FALSE(Offset::meet(line, 0, circle(5, 6, 5.9)));
  EXPECT_FALSE(Offset::meet(circle(0, 0, 5), 0, circle(0, 0, 5)));
  EXPECT_FALSE(Offset::meet(circle(0, 0, 5), 0, circle(11, 0, 5.9)));
  EXPECT_FALSE(Offset::meet(circle(0, 0, 5), 0, circle(1, 0, 3.9)));
}

TEST(Offset, MeetsATangentThatRoundingTookAway) {
  const auto circle = *Offset::of_arc({10, 5}, {5, 5}, true, kWholeTurn, 0);
  const auto meeting = Offset::meet(Offset::of_line({0, -1e-13}, {10, -1e-13}, 0), 0, circle);
  ASSERT_TRUE(meeting);
  EXPECT_NEAR(meeting->on_first, 5, 1e-6);
  EXPECT_NEAR(meeting->on_second, 0.75 * kWholeTurn, 1e-6);
}

TEST(Offset, MeetsAtTheLastOfSeveralPlaces) {
  const auto circle = *Offset::of_arc({10, 5}, {5, 5}, true, kWholeTurn, 0);
  const auto meeting = Offset::meet(Offset::of_line({-5, 5}, {15, 5}, 0), 0, circle);
  ASSERT_TRUE(meeting);
  EXPECT_NEAR(meeting->on_first, 15, 1e-9);
  EXPECT_NEAR(meeting->on_second, 0, 1e-9);
  const auto twice = *Offset::of_arc({10, 5}, {5, 5}, true, 2.1 * kWholeTurn, 0);
  const auto last = Offset::meet(twice, 0, Offset::of_line({0, 8}, {20, 8}, 0));
  ASSERT_TRUE(last);
  EXPECT_NEAR(last->on_first, kWholeTurn + std::numbers::pi - std::asin(0.6), 1e-9) << "of two turns the last";
}

}  // namespace
}  // namespace rmac::gcode
