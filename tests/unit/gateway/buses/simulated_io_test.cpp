#include "gateway/buses/simulated_io.hpp"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "unit/gateway/buses/number_range.hpp"

namespace rmac::gateway {
namespace {

using test::expect_range, test::NumberRange;
using testing::HasSubstr;
using Numbers = std::map<std::string, std::vector<double>>;

/// What is made of these parameters, beside a probe.
auto made(Numbers numbers) {
  numbers.try_emplace("probe_input", std::vector<double>{2});
  return make_simulated_io({"SimulatedIOInterface", std::move(numbers), {}});
}

std::string refusal(const Numbers& numbers) {
  const auto io = made(numbers);
  return io ? "taken" : io.error().message;
}

TEST(SimulatedIo, HasAProbeAsItsParametersDescribeIt) {
  const auto io = made({{"probe_input", {5}},
                        {"probe_ready", {6}},
                        {"probe_stylus_mm", {0.1, -0.2, -50}},
                        {"probe_radius_mm", {1.5}},
                        {"probe_bounce_ms", {4}},
                        {"probe_switch_rpm", {500}}});
  ASSERT_TRUE(io) << io.error().message;
  const auto& probe = (*io)->probe();
  ASSERT_TRUE(probe);
  EXPECT_EQ(probe->touch_input, 5);
  EXPECT_EQ(probe->ready_input, 6);
  EXPECT_EQ(probe->stylus, (Vector{0.1, -0.2, -50}));
  EXPECT_EQ(probe->radius, 1.5);
  EXPECT_EQ(probe->bounce_s, 0.004);
  EXPECT_EQ(probe->switch_rpm, 500);
}

TEST(SimulatedIo, HasNoProbeWithoutParameters) {
  const auto io = make_simulated_io({"SimulatedIOInterface", {}, {}});
  ASSERT_TRUE(io);
  EXPECT_FALSE((*io)->probe());
}

TEST(SimulatedIo, TakesEachNumberUpToItsBounds) {
  const std::pair<NumberRange, std::size_t> parameters[]{
      {{"probe_input", 0, 63}, 1},      {{"probe_ready", 0, 63}, 1},       {{"probe_stylus_mm", -1e5, 1e5}, 3},
      {{"probe_radius_mm", 0, 100}, 1}, {{"probe_bounce_ms", 0, 1000}, 1}, {{"probe_switch_rpm", 0, 1e5}, 1},
      {{"part_place", -1e5, 1e5}, 6},   {{"part_bore_mm", -1e5, 1e5}, 5},  {{"sphere_mm", -1e5, 1e5}, 4}};
  for (const auto& [range, count] : parameters) {
    const std::string name = range.name;
    const std::size_t numbers = count;
    expect_range(range, [&](double value) {
      return refusal({{name, std::vector<double>(numbers, value)}}) == "taken";
    });
    EXPECT_THAT(refusal({{name, std::vector<double>(numbers + 1, 1)}}),
                HasSubstr("\"" + name + "\" takes " + std::to_string(numbers) + " number"));
  }
  EXPECT_THAT(refusal({{"probe_input", {2.5}}}), HasSubstr("\"probe_input\" takes 1 number from 0 to 63"));
  EXPECT_THAT(refusal({{"probe_ready", {2.5}}}), HasSubstr("\"probe_ready\" takes 1 number from 0 to 63"));
  EXPECT_EQ(refusal({{"probe_radius_mm", {2.5}}}), "taken");
}

TEST(SimulatedIo, TakesAsManyBodiesAsAreDescribed) {
  const auto io = made({{"part_block_mm", {0, 0, 0, 10, 20, 30, 100, 0, 0, 110, 20, 30}},
                        {"part_bore_mm", {5, 10, 2, 0, 30, 105, 10, 3, 0, 30}},
                        {"sphere_mm", {0, 0, 100, 12.5, 50, 0, 100, 10}}});
  ASSERT_TRUE(io) << io.error().message;
  const fieldbus::SimulatedPart& part = (*io)->part();
  EXPECT_NEAR(part.distance({5, 10, 15}), 2, 1e-9) << "in the middle of the first bore";
  EXPECT_NEAR(part.distance({105, 10, 15}), 3, 1e-9) << "in the middle of the second bore";
  EXPECT_NEAR(part.distance({112, 10, 15}), 2, 1e-9) << "beside the second block";
  EXPECT_NEAR(part.distance({0, 0, 115}), 2.5, 1e-9);
  EXPECT_NEAR(part.distance({50, 0, 88}), 2, 1e-9);
}

// Turned about x, then y, then z of the machine, as calibrations tell it.
TEST(SimulatedIo, PutsThePartWhereItIsSaidToBe) {
  constexpr double kDegree = std::numbers::pi / 180;
  for (const auto& [rx, ry, rz] : {std::array{30.0, 0.0, 0.0}, std::array{0.0, 40.0, 0.0}, std::array{0.0, 0.0, -50.0},
                                   std::array{25.0, -35.0, 145.0}}) {
    const auto io = made({{"part_block_mm", {9, 19, 29, 11, 21, 31}}, {"part_place", {100, -50, 7, rx, ry, rz}}});
    ASSERT_TRUE(io) << io.error().message;
    const Eigen::Vector3d middle =
        Eigen::AngleAxisd(rz * kDegree, Eigen::Vector3d::UnitZ()) *
            (Eigen::AngleAxisd(ry * kDegree, Eigen::Vector3d::UnitY()) *
             (Eigen::AngleAxisd(rx * kDegree, Eigen::Vector3d::UnitX()) * Eigen::Vector3d(10, 20, 30))) +
        Eigen::Vector3d(100, -50, 7);
    EXPECT_NEAR((*io)->part().distance({middle[0], middle[1], middle[2]}), -1, 1e-9) << rx << " " << ry << " " << rz;
  }
}

TEST(SimulatedIo, RefusesWhatIsNotThere) {
  EXPECT_THAT(refusal({{"probe", {1}}}),
              HasSubstr("\"probe\" is not understood; there are part_block_mm, part_bore_mm"));
  for (const std::size_t flat : {0U, 1U, 2U}) {
    std::vector<double> corners{0, 0, 0, 10, 10, 10};
    corners[flat] = 10;
    EXPECT_THAT(refusal({{"part_block_mm", corners}}), HasSubstr("must be below the second in x, y and z"));
  }
  const auto unprobed = make_simulated_io({"SimulatedIOInterface", {{"sphere_mm", {0, 0, 0, 1}}}, {}});
  ASSERT_FALSE(unprobed);
  EXPECT_THAT(unprobed.error().message, HasSubstr("\"probe_input\" is missing"));
  const auto text = make_simulated_io({"SimulatedIOInterface", {}, {{"probe_input", "two"}}});
  ASSERT_FALSE(text);
  EXPECT_THAT(text.error().message, HasSubstr("\"probe_input\" takes numbers"));
}

}  // namespace
}  // namespace rmac::gateway
