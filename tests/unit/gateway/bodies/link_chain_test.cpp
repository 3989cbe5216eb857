#include "gateway/bodies/link_chain.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "gateway/bodies/link.hpp"
#include "rmac/modules/chain_kinematics.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::gateway {
namespace {

using modules::ChainKinematics;
using modules::ScrewAxis;
using Names = std::vector<std::string>;

/// A turntable C on a cradle A about a line 60 mm below, under a spindle that X, Y and Z carry.
ChainKinematics trunnion() {
  const std::vector<ScrewAxis> axes{{JointType::Linear, {1, 0, 0}, {}},
                                    {JointType::Linear, {0, 1, 0}, {}},
                                    {JointType::Linear, {0, 0, 1}, {}},
                                    {JointType::Rotary, {1, 0, 0}, {0, 0, -60}},
                                    {JointType::Rotary, {0, 0, 1}, {}}};
  return {axes, {4, 3, 0, 1, 2}, Frame{{3, -2, 5}, {0.6, 0, 0.8, 0}}};
}

const Names kNames{"X", "Y", "Z", "A", "C"};
const std::vector<std::pair<double, double>> kLimits{{-250, 250}, {-250, 250}, {-100, 250}, {-110, 110}, {-720, 720}};

TEST(LinkNumber, CountsJointsFromTheTableOnBothSidesOfTheBase) {
  const Names chain{"C", "A", "base", "X", "Y", "Z"};
  EXPECT_EQ(link_number(chain, "table"), 0u);
  EXPECT_EQ(link_number(chain, "C"), 0u) << "what C turns against the cradle is the table";
  EXPECT_EQ(link_number(chain, "A"), 1u);
  EXPECT_EQ(link_number(chain, "base"), 2u);
  EXPECT_EQ(link_number(chain, "X"), 3u);
  EXPECT_EQ(link_number(chain, "Z"), 5u);
  EXPECT_EQ(link_number(chain, "spindle"), 5u);
  EXPECT_FALSE(link_number(chain, "x"));
}

TEST(LinkChain, CarriesWhatStandsOnEachLinkAsItsJointsMove) {
  const auto chain = LinkChain::make(trunnion(), Names{"C", "A", "base", "X", "Y", "Z"}, kNames, kLimits);
  ASSERT_TRUE(chain) << chain.error().message;
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) {
    std::array<double, 5> q{};
    for (std::size_t j = 0; j < q.size(); ++j) {
      q[j] = std::uniform_real_distribution<double>(kLimits[j].first, kLimits[j].second)(random);
    }
    std::array<Frame, 6> frames;
    chain->displace(q, frames);
    // By hand: seen from the table, the base turns by C about z and by A about the cradle's line.
    const double a = q[3] * std::numbers::pi / 180, c = q[4] * std::numbers::pi / 180;
    const auto by_hand = [&](Vector p) {
      const Vector tilted{p[0], std::cos(a) * p[1] - std::sin(a) * (p[2] + 60),
                          std::sin(a) * p[1] + std::cos(a) * (p[2] + 60) - 60};
      return Vector{std::cos(c) * tilted[0] - std::sin(c) * tilted[1],
                    std::sin(c) * tilted[0] + std::cos(c) * tilted[1], tilted[2]};
    };
    const Vector point{11, -7, 23};
    const Vector base = apply_to_point(frames[2], point), wanted = by_hand(point);
    const Vector ram = apply_to_point(frames[4], point),
                 carried = by_hand({point[0] + q[0], point[1] + q[1], point[2]});
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(base[k], wanted[k], 1e-9) << i;
      EXPECT_NEAR(ram[k], carried[k], 1e-9) << i;
    }
  }
}

TEST(LinkChain, IsRefusedWhereTheOrderOfTurnsIsNotTheModules) {
  const auto chain = LinkChain::make(trunnion(), Names{"A", "C", "base", "X", "Y", "Z"}, kNames, kLimits);
  ASSERT_FALSE(chain);
  EXPECT_THAT(chain.error().message, testing::HasSubstr("the kinematics module moves the tool otherwise"));
  EXPECT_FALSE(LinkChain::make(trunnion(), Names{"base", "X", "Y", "Z", "C", "A"}, kNames, kLimits));
}

TEST(LinkChain, TellsHowEachJointMovesWhatItCarries) {
  const auto chain = LinkChain::make(trunnion(), Names{"C", "A", "base", "X", "Y", "Z"}, kNames, kLimits);
  ASSERT_TRUE(chain);
  EXPECT_NEAR(chain->motion(1).slides, 1, 1e-12);
  EXPECT_NEAR(chain->motion(1).turns, 0, 1e-12);
  EXPECT_NEAR(chain->motion(3).turns, std::numbers::pi / 180, 1e-12);
  EXPECT_NEAR(std::abs(chain->motion(3).direction[0]), 1, 1e-12);
  EXPECT_NEAR(chain->motion(3).point[2], -60, 1e-9);
  EXPECT_NEAR(chain->motion(3).slides, 0, 1e-12);
}

}  // namespace
}  // namespace rmac::gateway
