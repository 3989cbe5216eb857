#include "gateway/tools/tool_rack.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>
#include <random>

#include "rmac/motion/frame.hpp"

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ToolRackTest : public testing::Test {
 protected:
  ToolRackTest() {
    std::string name = (fs::temp_directory_path() / "rmac-tools-XXXXXX").string();
    EXPECT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  ~ToolRackTest() override { fs::remove_all(folder_); }

  static Tool random_tool(int number, std::mt19937& random) {
    std::uniform_real_distribution<double> any(-1, 1);
    const Frame frame = frame_from_axis({100 * any(random), 100 * any(random), 100 * any(random)},
                                        {any(random), any(random), 1.5 + any(random)});
    return {.number = number,
            .name = "tool \"" + std::to_string(number) + "\" µ",
            .length_mm = 100 + 100 * any(random),
            .radius_mm = 5 + 5 * any(random),
            .frame = frame,
            .max_rpm = 10000 + 10000 * any(random),
            .max_torque_nm = 5 + 5 * any(random),
            .needs_spindle = any(random) > 0};
  }
  static void expect_same(const Tool& a, const Tool& b) {
    EXPECT_EQ(a.number, b.number);
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.length_mm, b.length_mm);
    EXPECT_EQ(a.radius_mm, b.radius_mm);
    EXPECT_EQ(a.frame.p, b.frame.p);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(a.frame.q[i], b.frame.q[i], 1e-15);
    EXPECT_EQ(a.max_rpm, b.max_rpm);
    EXPECT_EQ(a.max_torque_nm, b.max_torque_nm);
    EXPECT_EQ(a.needs_spindle, b.needs_spindle);
  }
  [[nodiscard]] fs::path file() const { return folder_ / "Mill.json"; }

  fs::path folder_;
};

TEST_F(ToolRackTest, GivesBackEveryDigitOfWhatItWrote) {
  std::mt19937 random(20261121);
  ToolTable table;
  for (const int number : {1, 17, 9999}) table.tools[number] = random_tool(number, random);
  for (const std::optional<int> mounted : {std::optional<int>(17), std::optional<int>(kNoTool), std::optional<int>()}) {
    table.mounted = mounted;
    const auto written = write_tool_table(file(), table);
    ASSERT_TRUE(written) << written.error().message;
    const auto read = read_tool_table(file());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->mounted, mounted);
    ASSERT_EQ(read->tools.size(), 3U);
    for (const auto& [number, tool] : table.tools) expect_same(read->tools.at(number), tool);
  }
}

TEST_F(ToolRackTest, KeepsTheShapeOfAToolThatIsSetAnew) {
  ToolTable table;
  table.tools[7] = {.number = 7, .length_mm = 30};
  table.tools[7].shape =
      ToolShape{.dc = 6, .re = 3, .apmx = 8, .lcf = 10, .oal = 30, .zefp = 2, .shank = {}, .holder = {}};
  ASSERT_TRUE(write_tool_table(file(), table));
  ToolRack rack(folder_);
  rack.adopt("Mill", *rack.read("Mill"), ToolRack::Keeps::Everything);
  ASSERT_TRUE(rack.set({.number = 7, .length_mm = 29.5}));
  const auto read = read_tool_table(file());
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_TRUE(read->tools.at(7).shape);
  EXPECT_EQ(read->tools.at(7).shape->re, 3);
  EXPECT_EQ(read->tools.at(7).length_mm, 29.5);
}

TEST_F(ToolRackTest, KeepsTheOldTableWhenAWriteWasCutShort) {
  ToolTable table;
  table.tools[3] = {.number = 3, .length_mm = 30};
  ASSERT_TRUE(write_tool_table(file(), table));
  std::ofstream(file().string() + ".part") << R"({"Mounted": 0, "To)";
  const auto read = read_tool_table(file());
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(read->tools.contains(3));
  table.mounted = 3;
  ASSERT_TRUE(write_tool_table(file(), table)) << "what was left over is written over";
  EXPECT_EQ(read_tool_table(file())->mounted, 3);
}

TEST_F(ToolRackTest, ChangesNothingWhereTheFileCannotBeWritten) {
  std::ofstream(folder_ / "taken") << "no folder";
  ToolRack rack(folder_ / "taken");
  rack.adopt("Mill", {}, ToolRack::Keeps::Everything);
  const auto set = rack.set({.number = 3, .length_mm = 30});
  ASSERT_FALSE(set);
  EXPECT_THAT(set.error().message, HasSubstr("taken"));
  EXPECT_TRUE(rack.tools().empty());
  EXPECT_FALSE(rack.set_mounted(std::nullopt));
  EXPECT_EQ(rack.mounted(), kNoTool);
}

TEST_F(ToolRackTest, LeavesNoPartOfATableThatCannotBeWritten) {
  fs::create_directories(folder_ / "Mill.json" / "in the way");
  ToolRack rack(folder_);
  rack.adopt("Mill", {}, ToolRack::Keeps::Everything);
  EXPECT_FALSE(rack.set({.number = 3, .length_mm = 30}));
  EXPECT_FALSE(fs::exists(folder_ / "Mill.json.part"));
}

TEST_F(ToolRackTest, RemovesNoToolThatIsInTheSpindleHereOrInTheFile) {
  ToolRack rack(folder_);
  ToolTable table;
  for (const int number : {3, 4, 5}) table.tools[number] = {.number = number, .length_mm = 1};
  table.mounted = 3;
  rack.adopt("Mill", table, ToolRack::Keeps::Tools);
  ASSERT_TRUE(rack.set_mounted(4)) << "in virtual mode";
  EXPECT_THAT(rack.remove(3).error().message, HasSubstr("in the spindle"));
  EXPECT_THAT(rack.remove(4).error().message, HasSubstr("in the spindle"));
  ASSERT_TRUE(rack.remove(5));
  const auto read = rack.read("Mill");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->mounted, 3);
  EXPECT_EQ(read->tools.size(), 2U);
}

TEST(Tool, TipIsDownItsOwnAxisByItsLength) {
  const Frame straight = tip_on_interface({.length_mm = 40});
  EXPECT_EQ(straight.p, (Vector{0, 0, -40}));
  // An angle head: 50 mm out along x, its tool along +x (the axis points from the tip to the spindle).
  const Frame turned = tip_on_interface({.length_mm = 40, .frame = frame_from_axis({50, 0, -100}, {-1, 0, 0})});
  EXPECT_NEAR(turned.p[0], 90, 1e-12);
  EXPECT_NEAR(turned.p[1], 0, 1e-12);
  EXPECT_NEAR(turned.p[2], -100, 1e-12);
  EXPECT_NEAR(z_axis(turned)[0], -1, 1e-12);
}

}  // namespace
}  // namespace rmac::gateway
