#include "gateway/metrology/alignment.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/gateway/metrology/measured.hpp"

namespace rmac::gateway {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr int kAlignments = 60;

/// A face of a block: its normal, and the corner from which two ways go over it.
struct Face {
  const char* name;
  Vector normal, corner, u, v;
};
/// A block of 80 by 60 by 20, seen from its corner: the faces that a probe reaches.
const std::vector<Face>& block() {
  static const std::vector<Face> kFaces{{"top", {0, 0, 1}, {0, 0, 20}, {80, 0, 0}, {0, 60, 0}},
                                        {"front", {0, -1, 0}, {0, 0, 0}, {80, 0, 0}, {0, 0, 20}},
                                        {"left", {-1, 0, 0}, {0, 0, 0}, {0, 60, 0}, {0, 0, 20}}};
  return kFaces;
}

/// Measured where the part lies: anywhere near the nominal point on its face, with noise along the normal.
std::vector<SurfacePoint> measure(Chance& chance, const std::vector<Face>& faces, const Frame& part, int each,
                                  double beside_mm, double sigma) {
  std::vector<SurfacePoint> points;
  for (const Face& face : faces) {
    for (int i = 0; i < each; ++i) {
      const Vector nominal = plus(plus(face.corner, face.u, chance.within(0.1, 0.9)), face.v, chance.within(0.1, 0.9));
      const auto beside = [&] { return chance.within(-beside_mm, beside_mm) / 80; };
      Vector there = plus(plus(nominal, face.u, beside()), face.v, beside());
      there = plus(there, face.normal, chance.noise(sigma));
      points.push_back({face.name, nominal, face.normal, apply_to_point(part, there)});
    }
  }
  return points;
}

TEST(PointsToSurfaces, GiveBackTheTransformExactlyWhereverTheProbeLandsOnTheFaces) {
  Chance chance(13);
  for (int i = 0; i < kAlignments; ++i) {
    // 0.3 mm and 0.2 degrees off, and far beyond that: a part that was thrown onto the table.
    const Frame part = i % 2 == 0 ? chance.frame(0.3, 0.0035) : chance.frame(300, M_PI);
    const auto points = measure(chance, block(), part, 2 + i % 6, i % 3 == 0 ? 0.0 : 2.0, 0);
    const auto fit = fit_surfaces(points);
    ASSERT_TRUE(fit) << "trial " << i << ": " << fit.error().message;
    EXPECT_LT(distance(fit->p, part.p), 1e-8) << "trial " << i;
    EXPECT_LT(turned(*fit, part), 1e-10) << "trial " << i;
  }
}

TEST(PointsToSurfaces, OfNominalPointsInOnePlaneAreNotMirrored) {
  Chance chance(12);
  const std::vector<Vector> normals{{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}};
  for (int i = 0; i < kAlignments; ++i) {
    const Frame part = chance.frame(300, M_PI);
    std::vector<SurfacePoint> points;
    for (std::size_t j = 0; j < 12; ++j) {
      const Vector nominal{chance.within(-50, 50), chance.within(-50, 50), 0};
      points.push_back({"part", nominal, normals[j % 3], apply_to_point(part, nominal)});
    }
    const auto fit = fit_surfaces(points);
    ASSERT_TRUE(fit) << "trial " << i << ": " << fit.error().message;
    EXPECT_LT(distance(fit->p, part.p), 1e-8) << "trial " << i;
    EXPECT_LT(turned(*fit, part), 1e-10) << "trial " << i;
  }
}

TEST(PointsToSurfaces, AreWithoutBiasUnderNoise) {
  Chance chance(14);
  const Frame part = chance.frame(0.3, 0.0035);
  constexpr int kFits = 300, kEach = 12;
  constexpr double kSigma = 0.005;
  Vector mean{}, turn{};
  for (int i = 0; i < kFits; ++i) {
    const auto fit = fit_surfaces(measure(chance, block(), part, kEach, 1, kSigma));
    ASSERT_TRUE(fit) << fit.error().message;
    const Frame off = compose(inverse(part), *fit);
    mean = plus(mean, off.p, 1.0 / kFits);
    turn = plus(turn, {2 * off.q[1], 2 * off.q[2], 2 * off.q[3]}, 1.0 / kFits);
  }
  // The corner's place and the turns are held to about sigma, and sigma over the block's size, each.
  EXPECT_LT(distance(mean, {}), 5 * kSigma * 2 / std::sqrt(kFits));
  EXPECT_LT(distance(turn, {}), 5 * kSigma / 10 / std::sqrt(kFits));
}

TEST(PointsToSurfaces, OfOneFaceAreRefusedWithTheThreeFreedomsThatItLeaves) {
  Chance chance(15);
  const auto points = measure(chance, {block()[0]}, {}, 9, 1, 0);
  const auto fit = fit_surfaces(points);
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message, AllOf(HasSubstr("its place along"), HasSubstr(" and "),
                                         HasSubstr("its turn about (0.000, 0.000, 1.000)")));
  // Both shifts lie in the face.
  EXPECT_THAT(fit.error().message, Not(HasSubstr("along (0.000, 0.000, 1.000)")));
}

TEST(PointsToSurfaces, OfTwoFacesAreRefusedWithTheShiftAlongTheirEdge) {
  Chance chance(16);
  const auto fit = fit_surfaces(measure(chance, {block()[0], block()[1]}, {}, 6, 1, 0));
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message, HasSubstr("its place along (1.000, 0.000, 0.000)"));
  EXPECT_THAT(fit.error().message, Not(HasSubstr("turn")));
}

TEST(PointsToSurfaces, AroundAPinAreRefusedWithTheTurnAboutIt) {
  // A round pin that stands on a face: nothing says how it is turned.
  Chance chance(17);
  auto points = measure(chance, {block()[0]}, {}, 6, 0, 0);
  for (int i = 0; i < 12; ++i) {
    const double turn = i * M_PI / 6;
    const Vector normal{std::cos(turn), std::sin(turn), 0};
    const Vector place{30 + 8 * normal[0], 20 + 8 * normal[1], 25.0 + i % 3};
    points.push_back({"pin", place, normal, place});
  }
  const auto fit = fit_surfaces(points);
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message, HasSubstr("its turn about (0.000, 0.000, 1.000) through (30.000, 20.000"));
  EXPECT_THAT(fit.error().message, Not(HasSubstr("place")));
}

TEST(PointsToSurfaces, WithTooFewPointsOrABadNormalAreRefused) {
  Chance chance(18);
  auto points = measure(chance, block(), {}, 2, 0, 0);
  EXPECT_THAT(fit_surfaces(std::span(points).first(5)).error().message, HasSubstr("needs 6 points, and there are 5"));
  points[3].normal = {0, -2, 0};
  EXPECT_THAT(fit_surfaces(points).error().message, AllOf(HasSubstr("point 3 of front"), HasSubstr("length 2")));
  points[3].normal = {0, -1, 0};
  points[2].measured[1] = NAN;
  EXPECT_THAT(fit_surfaces(points).error().message, HasSubstr("not finite"));
}

TEST(FeatureDeviations, AreOfEachFeatureAlongItsNormals) {
  Chance chance(19);
  const Frame part = chance.frame(100, 1);
  auto points = measure(chance, block(), part, 5, 1, 0);
  // The front is 0.03 too far out everywhere, one point of the top 0.1 too deep.
  for (SurfacePoint& point : points) {
    if (point.feature == "front") point.measured = plus(point.measured, apply_to_vector(part, point.normal), 0.03);
  }
  points[2].measured = plus(points[2].measured, apply_to_vector(part, points[2].normal), -0.1);
  const auto features = feature_deviations(points, part);
  ASSERT_EQ(features.size(), 3U);
  EXPECT_EQ(features[0].feature, "top");
  EXPECT_EQ(features[0].points, 5U);
  EXPECT_NEAR(features[0].worst_mm, -0.1, 1e-9);
  EXPECT_NEAR(features[0].mean_mm, -0.02, 1e-9);
  EXPECT_NEAR(features[0].rms_mm, 0.1 / std::sqrt(5), 1e-9);
  EXPECT_NEAR(features[1].mean_mm, 0.03, 1e-9);
  EXPECT_NEAR(features[2].worst_mm, 0, 1e-9);
}

}  // namespace
}  // namespace rmac::gateway
