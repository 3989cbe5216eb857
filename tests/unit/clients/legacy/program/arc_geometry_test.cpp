#include "clients/legacy/program/arc_geometry.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "clients/legacy/program/pecking.hpp"
#include "clients/legacy/program/refusal.hpp"
#include "clients/legacy/program/vectors.hpp"

// Arcs as RS274/NGC has them, told by who made them: a circle in one of three planes, a begin and a turn on it.

namespace rmac::legacy {
namespace {

const std::array<Plane, 3> kPlanes{Plane{0, 1, 2}, Plane{2, 0, 1}, Plane{1, 2, 0}};

struct Made {
  Plane plane;
  Point centre{}, start{}, end{};
  double radius = 0, sweep = 0;  ///< mm; rad, from the first axis of the plane towards the second
  [[nodiscard]] Point at(double radius_mm, double angle) const {
    Point point = centre;
    point.at(plane.first) += radius_mm * std::cos(angle);
    point.at(plane.second) += radius_mm * std::sin(angle);
    return point;
  }
  [[nodiscard]] Arc arc() const { return {.centre = centre, .end = end, .counter_clockwise = sweep > 0}; }
};

Made made_by(unsigned seed, double most_of_turn = 0.98) {
  std::mt19937 random(seed);
  const auto within = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  Made made{kPlanes.at(seed % 3)};
  made.centre = {within(-50, 50), within(-50, 50), within(-50, 50)};
  made.radius = within(0.5, 80);
  const double from = within(-3, 3);
  made.sweep = within(0.05, most_of_turn) * kTurn_rad * (seed % 2 == 0 ? 1 : -1);
  made.start = made.at(made.radius, from);
  made.end = made.at(made.radius, from + made.sweep);
  made.end.at(made.plane.normal) += within(-20, 20);
  return made;
}

std::string refusal_of(const auto& act) {
  try {
    act();
  } catch (const Refusal& refusal) {
    return refusal.message;
  }
  return "taken";
}

TEST(ArcGeometry, HasTheLengthOfAHelix) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Made made = made_by(seed);
    Arc arc = made.arc();
    const double climb = made.end.at(made.plane.normal) - made.start.at(made.plane.normal);
    for (const int more : {0, 1, 5}) {
      arc.more_turns = more;
      const double turned = std::abs(made.sweep) + more * kTurn_rad;
      EXPECT_NEAR(length_of(made.start, arc, made.plane), std::hypot(made.radius * turned, climb), 1e-6) << seed;
    }
    arc.closed = true;
    arc.end = made.start;
    arc.more_turns = 0;
    EXPECT_NEAR(length_of(made.start, arc, made.plane), made.radius * kTurn_rad, 1e-6) << seed;
  }
}

TEST(ArcGeometry, FindsTheCentreOfARadiusNegativeForTheLongerWay) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Made made = made_by(seed);
    const double radius = std::abs(made.sweep) <= std::numbers::pi ? made.radius : -made.radius;
    const Point centre = centre_by_radius(made.start, made.end, made.plane, made.sweep > 0, radius, 0);
    EXPECT_NEAR(centre.at(made.plane.first), made.centre.at(made.plane.first), 1e-5) << seed;
    EXPECT_NEAR(centre.at(made.plane.second), made.centre.at(made.plane.second), 1e-5) << seed;
    EXPECT_EQ(centre.at(made.plane.normal), made.start.at(made.plane.normal)) << seed;
  }
}

TEST(ArcGeometry, TakesARadiusThatIsTooShortByRoundingOnly) {
  const auto centre_of = [](double radius) { return centre_by_radius({}, {20, 0, 0}, kPlanes[0], true, radius, 0); };
  EXPECT_EQ(centre_of(10), (Point{10, 0, 0}));
  EXPECT_EQ(centre_of(10 - 0.00126), (Point{10, 0, 0}));
  EXPECT_THAT(refusal_of([&] { static_cast<void>(centre_of(10 - 0.00128)); }),
              testing::HasSubstr("a radius of 9.99872 mm does not reach the end, which is 20 mm away"));
  EXPECT_THAT(refusal_of([&] { static_cast<void>(centre_of(-9)); }),
              testing::HasSubstr("a radius of 9 mm does not reach"));
  const auto closed = [](double mm) {
    return refusal_of([&] { static_cast<void>(centre_by_radius({}, {mm, 0, 5}, kPlanes[0], true, 10, 0)); });
  };
  EXPECT_THAT(closed(0), testing::HasSubstr("the radius alone tells no circle"));
  EXPECT_THAT(closed(0.001), testing::HasSubstr("the radius alone tells no circle"));
  EXPECT_EQ(closed(0.00102), "taken");
}

/// An arc that closes on its circle keeps what was written.
TEST(ArcGeometry, KeepsAnArcThatIsOne) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Made made = made_by(seed);
    const auto arc = arc_about(made.start, made.arc(), made.plane, 0);
    ASSERT_TRUE(arc) << seed;
    EXPECT_LT(length(difference(arc->centre, made.centre)), 1e-6) << seed;
    EXPECT_LT(length(difference(arc->end, made.end)), 1e-6) << seed;
    EXPECT_EQ(arc->counter_clockwise, made.sweep > 0);
    EXPECT_FALSE(arc->closed);
  }
}

/// Programs round: the arc that comes of it is a circle's, begins where the tool is, stays beside the circle that was
/// written, and ends where it was to, or as far on its own circle.
TEST(ArcGeometry, EvensRadiiThatDifferByRounding) {
  for (unsigned seed = 1; seed <= 400; ++seed) {
    Made made = made_by(seed);
    std::mt19937 random(seed);
    const double off = std::uniform_real_distribution(-0.0049, 0.0049)(random);
    const double far = made.radius + off;
    for (const std::size_t axis : {made.plane.first, made.plane.second})
      made.end.at(axis) = made.centre.at(axis) + (made.end.at(axis) - made.centre.at(axis)) * far / made.radius;
    const auto arc = arc_about(made.start, made.arc(), made.plane, 0);
    ASSERT_TRUE(arc) << seed;
    const auto to = [&](const Point& point) {
      return std::hypot(point.at(made.plane.first) - arc->centre.at(made.plane.first),
                        point.at(made.plane.second) - arc->centre.at(made.plane.second));
    };
    EXPECT_NEAR(to(made.start), to(arc->end), 1e-6) << seed;
    EXPECT_EQ(arc->end.at(made.plane.normal), made.end.at(made.plane.normal)) << seed;
    EXPECT_LT(length(difference(arc->end, made.end)), std::abs(off) + 1e-6) << seed;
    // Halfway along it, too, it is beside the circle.
    const Point middle =
        made.at(made.radius, std::atan2(made.start.at(made.plane.second) - made.centre.at(made.plane.second),
                                        made.start.at(made.plane.first) - made.centre.at(made.plane.first)) +
                                 made.sweep / 2);
    EXPECT_NEAR(to(middle), to(made.start), std::abs(off) + 1e-3) << seed;
  }
}

/// rs274: 0.005 mm, or a thousandth of the radius up to 0.5 mm.
TEST(ArcGeometry, IsRefusedWhereItsRadiiDifferByMoreThanRounding) {
  const auto off_by = [](double radius, double off) {
    return refusal_of([&] {
      static_cast<void>(
          arc_about({radius, 0, 0}, {.end = {0, radius + off, 0}, .counter_clockwise = true}, kPlanes[0], 0));
    });
  };
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(off_by(1, sign * 0.00499), "taken");
    EXPECT_THAT(off_by(1, sign * 0.00501), testing::HasSubstr("mm from its start and"));
    EXPECT_EQ(off_by(100, sign * 0.0999), "taken");
    EXPECT_THAT(off_by(100, sign * 0.1001), testing::HasSubstr("mm from its start and"));
    EXPECT_EQ(off_by(10'000, sign * 0.4999), "taken");
    EXPECT_THAT(off_by(10'000, sign * 0.5001), testing::HasSubstr("mm from its start and"));
  }
  EXPECT_THAT(off_by(2, 0.5), testing::HasSubstr("the arc's centre is 2 mm from its start and 2.5 mm from its end"));
  EXPECT_THAT(off_by(0.001, 0), testing::HasSubstr("the arc's centre is where it begins"));
  EXPECT_EQ(off_by(0.00102, 0), "taken");
}

TEST(ArcGeometry, ThatEndsWhereItBeginsIsAFullCircle) {
  for (const bool counter_clockwise : {false, true}) {
    for (const double off : {0.0, 0.0005, 0.001}) {
      const auto arc =
          arc_about({10, 0, 0},
                    {.end = {10 * std::cos(off / 10), (counter_clockwise ? -10 : 10) * std::sin(off / 10), 3},
                     .counter_clockwise = counter_clockwise,
                     .more_turns = 2},
                    kPlanes[0], 0);
      ASSERT_TRUE(arc);
      EXPECT_TRUE(arc->closed) << off;
      EXPECT_EQ(arc->more_turns, 2);
      EXPECT_EQ(arc->end, (Point{10, 0, 3}));
    }
    // So little the other way is no arc, but the last bit of the turns before.
    const Arc beyond{.end = {10 * std::cos(5e-5), (counter_clockwise ? 10 : -10) * std::sin(5e-5), 0},
                     .counter_clockwise = counter_clockwise};
    EXPECT_EQ(arc_about({10, 0, 0}, beyond, kPlanes[0], 0), std::nullopt);
    Arc turned = beyond;
    turned.more_turns = 3;
    const auto arc = arc_about({10, 0, 0}, turned, kPlanes[0], 0);
    ASSERT_TRUE(arc);
    EXPECT_TRUE(arc->closed);
    EXPECT_EQ(arc->more_turns, 2);
  }
}

TEST(Pecking, ReachesTheBottomInEvenPecksAndALastOne) {
  std::mt19937 random(5);
  for (int i = 0; i < 500; ++i) {
    const double peck = std::uniform_real_distribution(0.05, 3.0)(random);
    const double depth = std::uniform_real_distribution(0.05, 60.0)(random);
    const int count = pecks_to(depth, peck);
    EXPECT_GE(count, 1);
    EXPECT_GE(count * peck, depth - 1e-8);
    EXPECT_LT((count - 1) * peck, depth);
    const int whole = 1 + static_cast<int>(random() % 40);
    EXPECT_EQ(pecks_to(whole * peck, peck), whole) << "no last peck of nothing";
  }
}

}  // namespace
}  // namespace rmac::legacy
