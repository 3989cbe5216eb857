#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

/// By de Boor's recurrence, with weights.
std::vector<double> curve_at(const json& nurbs, double u) {
  const auto knots = nurbs["knots"].get<std::vector<double>>();
  const auto points = nurbs["points"].get<std::vector<std::vector<double>>>();
  const auto weights =
      nurbs.contains("weights") ? nurbs["weights"].get<std::vector<double>>() : std::vector<double>(points.size(), 1);
  const std::size_t degree = nurbs["degree"];
  std::size_t span = degree;
  while (span + 1 < points.size() && knots[span + 1] <= u) ++span;
  std::vector<std::vector<double>> p;
  for (std::size_t i = span - degree; i <= span; ++i)
    p.push_back({points[i][0] * weights[i], points[i][1] * weights[i], weights[i]});
  for (std::size_t r = 1; r <= degree; ++r) {
    for (std::size_t j = degree; j >= r; --j) {
      const double low = knots[span - degree + j], high = knots[span + 1 + j - r], a = (u - low) / (high - low);
      for (std::size_t k = 0; k < 3; ++k) p[j][k] = (1 - a) * p[j - 1][k] + a * p[j][k];
    }
  }
  return {p[degree][0] / p[degree][2], p[degree][1] / p[degree][2]};
}

json curve_of(const std::string& lines, std::size_t number = 0) {
  for (const auto& request : imported(program_of(lines)).requests) {
    if (request["method"] == "RMAC_CAM.MoveAlongNurbs" && number-- == 0) return request["params"]["Nurbs"];
  }
  ADD_FAILURE() << "no curve in " << lines;
  return {};
}

/// Against Bernstein's polynomials of what was written.
TEST(Rs274Splines, AreTheBezierCurvesThatAreWritten) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> any(-50, 50);
  for (int round = 0; round < 50; ++round) {
    const double x = any(random), y = any(random), i = any(random), j = any(random), p = any(random), q = any(random);
    const json cubic = curve_of(fmt::format("G5 X{} Y{} I{} J{} P{} Q{}", x, y, i, j, p, q));
    const json square = curve_of(fmt::format("G5.1 X{} Y{} I{} J{}", x, y, i, j));
    for (const double u : {0.0, 0.25, 0.5, 0.9}) {
      const double v = 1 - u;
      EXPECT_NEAR(curve_at(cubic, u)[0], 3 * v * v * u * i + 3 * v * u * u * (x + p) + u * u * u * x, 1e-9);
      EXPECT_NEAR(curve_at(cubic, u)[1], 3 * v * v * u * j + 3 * v * u * u * (y + q) + u * u * u * y, 1e-9);
      EXPECT_NEAR(curve_at(square, u)[0], 2 * v * u * i + u * u * x, 1e-9);
      EXPECT_NEAR(curve_at(square, u)[1], 2 * v * u * j + u * u * y, 1e-9);
    }
  }
}

TEST(Rs274Splines, GoOnInTheDirectionInWhichTheLastOneEnded) {
  const json next = curve_of("G5 X10 Y0 I1 J2 P-3 Q4\nG5 X20 Y0 P0 Q1", 1);
  EXPECT_EQ(next["points"][1], json({13, -4, 10}));
  EXPECT_THAT(refusal_of(program_of("G5 X1 Y1 P1 Q1")), HasSubstr("the first G5 needs I and J"));
  EXPECT_THAT(refusal_of(program_of("G5 X1 Y1 I1 J1 P1 Q1\nG1 X5\nG5 X9 Y1 P1 Q1")), HasSubstr("the first G5 needs"));
}

/// Quarter circles as rational quadratics: exact, which no polynomial is.
TEST(Rs274Splines, HaveWeights) {
  const json arc = curve_of(fmt::format("G0 X10 Y0\nG5.2 X10 Y10 P{}\nX0 Y10 P1\nG5.3", std::sqrt(0.5)));
  for (double u = 0; u < 1; u += 0.1) EXPECT_NEAR(std::hypot(curve_at(arc, u)[0], curve_at(arc, u)[1]), 10, 1e-6);
}

TEST(Rs274Splines, MayNameTheirCodeInEachBlock) {
  const std::string first = "G5.2 P2 L4\n", last = "G5.3";
  EXPECT_EQ(curve_of(first + "G5.2 X1 Y1 P1\nX2 Y1 P1\nG5.2 X3 Y0 P1\n" + last),
            curve_of(first + "X1 Y1 P1\nX2 Y1 P1\nX3 Y0 P1\n" + last));
}

TEST(Rs274Splines, AreClosedByTheirOwnCode) {
  EXPECT_EQ(ends_of("G5.2 P2 L4\nX1 Y1 P1\nX2 Y1 P1\nX3 Y0 P1\nG5.3\nG1 X4").back(), (std::vector<double>{4, 0, 10}));
  EXPECT_THAT(refusal_of(program_of("G5.2 X1 Y1 P1\nM2")), HasSubstr("between G5.2 and G5.3"));
  EXPECT_THAT(refusal_of("%\n" + program_of("G5.2 X1 Y1 P1").substr(0, 49) + "\n%\n"), HasSubstr("G5.3"));
  EXPECT_THAT(refusal_of(program_of("G5.2 X1 Y1 P1\nG5.3")), HasSubstr("needs as many points"));
  EXPECT_THAT(refusal_of(program_of("G5.2 X1 Y1 P1\nX2 Y2 P1 F9\nG5.3")), HasSubstr("nothing in this block uses F"));
  EXPECT_THAT(refusal_of(program_of("G5.2 X1 Y1 P0")), HasSubstr("weight"));
  EXPECT_THAT(refusal_of(program_of("G5.3")), StartsWith("3:1: "));
  EXPECT_THAT(refusal_of(program_of("G18\nG5.1 X1 I1 J1")), HasSubstr("XY plane"));
  EXPECT_THAT(refusal_of(program_of("G5.1 X1 Z1 I1 J1")), HasSubstr("no Z"));
}

}  // namespace
}  // namespace rmac::rs274
