#include "gateway/metrology/probe.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/gateway/metrology/measured.hpp"

namespace rmac::gateway {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr int kProbes = 60;

TEST(Probe, IsQualifiedOnASphere) {
  Chance chance(20);
  for (int i = 0; i < kProbes; ++i) {
    const Vector centre = chance.place(500), offset = chance.place(0.2);
    const double radius = chance.within(5, 25), tip = chance.within(0.5, 4);
    std::vector<Vector> hits;
    for (int j = 0; j < 9; ++j) {
      Vector from = chance.direction();
      from[2] = std::abs(from[2]);
      hits.push_back(plus(plus(centre, from, radius + tip), offset, -1));
    }
    const auto probe = qualify_probe(hits, centre, radius);
    ASSERT_TRUE(probe) << "trial " << i << ": " << probe.error().message;
    EXPECT_NEAR(probe->tip_radius_mm, tip, 1e-8) << "trial " << i;
    EXPECT_LT(distance(probe->offset, offset), 1e-8) << "trial " << i;
    EXPECT_LT(probe->quality.worst_mm, 1e-9);
    for (const Vector& hit : hits) {
      const Vector tip_centre = plus(hit, probe->offset);
      const Vector normal = plus({}, plus(tip_centre, centre, -1), 1 / (radius + tip));
      EXPECT_NEAR(distance(touched_along_normal(tip_centre, normal, tip), centre), radius, 1e-8);
    }
  }
}

TEST(Probe, OnASphereOfTheWrongRadiusOrInOnePlaneIsRefused) {
  Chance chance(21);
  std::vector<Vector> hits, ring;
  for (int i = 0; i < 9; ++i) {
    hits.push_back(plus({}, chance.direction(), 10));
    ring.push_back({10 * std::cos(0.7 * i), 10 * std::sin(0.7 * i), 3});
  }
  EXPECT_THAT(qualify_probe(hits, {}, 12).error().message, AllOf(HasSubstr("10.0000"), HasSubstr("12.0000")));
  EXPECT_THAT(qualify_probe(ring, {}, 8).error().message, HasSubstr("not held"));
  EXPECT_THAT(qualify_probe(hits, {}, 0).error().message, HasSubstr("above 0"));
}

}  // namespace
}  // namespace rmac::gateway
