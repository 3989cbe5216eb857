#include "gateway/rmac/simulator/fits.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace rmac::cli {
namespace {

using gateway::Body;
using gateway::BoxShape;
using gateway::ConeShape;
using gateway::MachineBodies;
using gateway::MeshShape;
using testing::ElementsAre;

/// On its side or upright, a quarter of a turn at most.
Frame upright(const Vector& p) {
  return {p, {1, 0, 0, 0}};
}
Frame along_x(const Vector& p) {
  return {p, {std::sqrt(0.5), 0, std::sqrt(0.5), 0}};
}

MachineBodies with_table(std::vector<Body> table) {
  MachineBodies machine;
  machine.bodies = std::move(table);
  machine.bodies.push_back({"column", "base", BoxShape{{900, 900, 2000}}, upright({0, 0, 500}), ""});
  return machine;
}

const MachineBodies kBox = with_table({{"table", "table", BoxShape{{300, 200, 30}}, upright({0, 0, -135}), ""}});

TEST(PartFrameOn, IsAsFarFromTheMiddleOfTheOtherTablesTop) {
  const MachineBodies round = with_table({{"turntable", "table", ConeShape{60, 60, 20}, upright({10, -5, -110}), ""}});
  const Frame there = part_frame_on(kBox, round, {{20, 30, -110}, {0, 0, 0, 1}});
  EXPECT_THAT(there.p, ElementsAre(30, 25, -90)) << "10 above the top of either";
  EXPECT_THAT(there.q, ElementsAre(0, 0, 0, 1));
  EXPECT_THAT(part_frame_on(round, kBox, there).p, ElementsAre(20, 30, -110));
}

TEST(PartFrameOn, GoesByAllThatTheTableIsMadeOf) {
  const MachineBodies rail = with_table({{"table", "table", BoxShape{{300, 200, 30}}, upright({0, 0, -135}), ""},
                                         {"rail", "table", ConeShape{10, 4, 400}, along_x({100, 0, -110}), ""}});
  const Vector there = part_frame_on(kBox, rail, upright({0, 0, -120})).p;
  EXPECT_NEAR(there[0], (-150 + 300) / 2, 1e-9);
  EXPECT_NEAR(there[1], 0, 1e-9);
  EXPECT_NEAR(there[2], -100, 1e-9) << "the wide end of the rail";
}

TEST(PartFrameOn, StaysWhereATableIsNotKnown) {
  const MachineBodies none = with_table({});
  const MachineBodies mesh = with_table({{"table", "table", MeshShape{"table.stl"}, upright({0, 0, 7}), ""}});
  for (const MachineBodies& other : {none, mesh}) {
    EXPECT_THAT(part_frame_on(kBox, other, upright({1, 2, 3})).p, ElementsAre(1, 2, 3));
    EXPECT_THAT(part_frame_on(other, kBox, upright({1, 2, 3})).p, ElementsAre(1, 2, 3));
  }
}

}  // namespace
}  // namespace rmac::cli
