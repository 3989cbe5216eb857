// Which moves the joints' travel allows, from a joint that stands outside of it above all.
#include <gmock/gmock.h>

#include <random>

#include "unit/motion/planner/planner_bench.hpp"

namespace rmac::test {
namespace {

/// A mill of which Z stands `excess_mm` beyond its upper limit of 50.
class StandingOutside : public testing::Test {
 protected:
  void stand(double excess_mm) {
    z_ = 50 + excess_mm;
    builder_.restart(std::vector<double>{0, 0, z_}, {});
  }
  Move move(Geometry geometry) const {
    Move made;
    made.id = 7;
    made.feed_mm_s = 20;
    made.geometry = std::move(geometry);
    return made;
  }
  Move line_to(const Vector& to) const { return move(LineGeometry{{{0, 0, z_}, kUp}, {to, kUp}}); }
  /// Along a curve whose height goes through these.
  Move heights(const std::vector<double>& heights_mm) const {
    NurbsGeometry geometry;
    geometry.curve.degree = static_cast<int>(heights_mm.size()) - 1;
    for (std::size_t i = 0; i < heights_mm.size(); ++i) {
      geometry.curve.points.push_back({static_cast<double>(i), 0, heights_mm[i]});
    }
    geometry.curve.knots.assign(heights_mm.size(), 0);
    geometry.curve.knots.insert(geometry.curve.knots.end(), heights_mm.size(), 1);
    return move(geometry);
  }
  std::string refusal_of(const Move& made) {
    const auto segments = builder_.build(made);
    if (segments) return {};
    EXPECT_EQ(segments.error().code, MinorCode::TravelLimit);
    return segments.error().message;
  }

  double z_ = 50;
  PathBuilder builder_{mill()};
};

TEST_F(StandingOutside, AJointMayComeBackIn) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> excess(1e-5, 0.5), inside(-50, 50), aside(-49, 49);
  for (int i = 0; i < 100; ++i) {
    stand(excess(random));
    const Vector to{aside(random), aside(random), inside(random)};
    EXPECT_EQ(refusal_of(line_to(to)), "");
    stand(z_ - 50);
    EXPECT_EQ(refusal_of(move(JointTargetGeometry{{to[0], to[1], to[2]}})), "");
    stand(z_ - 50);
    EXPECT_EQ(refusal_of(move(PathTargetGeometry{{to, kUp}})), "");
    stand(z_ - 50);
    EXPECT_EQ(refusal_of(heights({z_, z_, 50, 40})), "");
    EXPECT_EQ(refusal_of(move(JointTargetGeometry{{3, 0, 30}})), "") << "and from there on as ever";
  }
}

TEST_F(StandingOutside, AJointMayNotGoFurtherOutNotEvenInBetween) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> excess(1e-5, 0.5), more(1e-4, 5);
  for (int i = 0; i < 100; ++i) {
    stand(excess(random));
    EXPECT_THAT(refusal_of(line_to({1, 0, z_ + more(random)})), testing::HasSubstr("joint Z"));
    EXPECT_THAT(refusal_of(heights({z_, z_ + more(random), 40, 30})), testing::HasSubstr("joint Z"));
    EXPECT_THAT(refusal_of(heights({z_, 40, 70, 30})), testing::HasSubstr("joint Z")) << "in, and out again";
    EXPECT_THAT(refusal_of(move(JointTargetGeometry{{0, 51, 40}})), testing::HasSubstr("joint Y"))
        << "another joint leaves its travel";
  }
}

TEST_F(StandingOutside, AMoveThatEndsThereIsRefusedWithWhatIsLeft) {
  stand(0.25);
  EXPECT_THAT(refusal_of(line_to({5, 0, 50.25})), testing::HasSubstr("takes joint Z to 50.2500 mm, 0.2500 mm beyond"));
  stand(0.25);
  EXPECT_THAT(refusal_of(move(JointTargetGeometry{{5, 0, 50.1}})),
              testing::HasSubstr("takes joint Z to 50.1000 mm, 0.1000 mm beyond"));
}

}  // namespace
}  // namespace rmac::test
