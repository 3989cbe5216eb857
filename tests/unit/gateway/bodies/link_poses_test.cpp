#include "gateway/bodies/link_poses.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>

#include "gateway/bodies/link.hpp"
#include "gateway/device_database/device_database.hpp"
#include "gateway/modules/module_loader.hpp"
#include "places.hpp"
#include "rmac/modules/chain_kinematics.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;
using modules::ChainKinematics;
using modules::ScrewAxis;
using Names = std::vector<std::string>;

/// The place of a link among the names; one past the end: it has none.
std::size_t place_of(const LinkPoses& links, const std::string& name) {
  return static_cast<std::size_t>(std::find(links.names().begin(), links.names().end(), name) - links.names().begin());
}

/// A turntable C on a cradle A about a line 60 mm below, under a spindle that X, Y and Z carry.
LinkPoses trunnion_links() {
  const std::vector<ScrewAxis> axes{{JointType::Linear, {1, 0, 0}, {}},
                                    {JointType::Linear, {0, 1, 0}, {}},
                                    {JointType::Linear, {0, 0, 1}, {}},
                                    {JointType::Rotary, {1, 0, 0}, {0, 0, -60}},
                                    {JointType::Rotary, {0, 0, 1}, {}}};
  const ChainKinematics kinematics(axes, {4, 3, 0, 1, 2}, Frame{{3, -2, 5}, {0.6, 0, 0.8, 0}});
  const Names chain{"C", "A", "base", "X", "Y", "Z"}, joints{"X", "Y", "Z", "A", "C"};
  return {LinkChain::make(kinematics, chain, joints, std::vector<std::pair<double, double>>(5, {-200, 200})).value(),
          chain};
}

/// Turned about x through a point on it, by so many degrees.
Vector turned_about_x(const Vector& p, const Vector& point, double degrees) {
  const double c = std::cos(degrees * std::numbers::pi / 180), s = std::sin(degrees * std::numbers::pi / 180);
  const double y = p[1] - point[1], z = p[2] - point[2];
  return {p[0], point[1] + c * y - s * z, point[2] + s * y + c * z};
}

TEST(LinkPoses, HaveANameForTheBaseEachJointTheSpindleAndTheTable) {
  EXPECT_EQ(trunnion_links().names(), (Names{"base", "C", "A", "X", "Y", "Z", "spindle", "table"}));
  EXPECT_EQ(trunnion_links().joint_count(), 5U);
}

TEST(LinkPoses, AreThoseOfAMachineThatStandsOnTheGround) {
  const LinkPoses links = trunnion_links();
  std::vector<Frame> poses(links.names().size());
  links.at(std::array{30.0, -20.0, 7.0, 25.0, 0.0}, poses);
  const auto at = [&](const char* name) { return poses[place_of(links, name)]; };
  EXPECT_EQ(at("base").p, (Vector{0, 0, 0}));
  EXPECT_EQ(at("base").q, (std::array<double, 4>{1, 0, 0, 0}));
  const auto expect = [](const Vector& place, const Vector& wanted, const char* name) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(place[k], wanted[k], 1e-9) << name;
  };
  expect(at("X").p, {30, 0, 0}, "X moves by itself alone");
  expect(at("Y").p, {30, -20, 0}, "Y stands on X");
  expect(at("Z").p, {30, -20, 7}, "Z stands on Y");
  expect(at("spindle").p, {30, -20, 7}, "is on Z");
  // The tool turns by A as the table sees it, so that the table turns the other way round.
  const Vector corner{50, 40, -110}, tilted = turned_about_x(corner, {0, 0, -60}, -25);
  for (const char* name : {"A", "C", "table"}) expect(apply_to_point(at(name), corner), tilted, name);
}

TEST(LinkPoses, OfEachMachineOfTheTreeLeadToTheTipThatItsModuleHas) {
  std::size_t machines = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(RMAC_SOURCE_DIR) / "drivers")) {
    if (entry.path().filename() != "device.json") continue;
    SCOPED_TRACE(entry.path().string());
    const auto database = read_device_json(entry.path());
    ASSERT_TRUE(database) << database.error().message;
    if (database->bodies.chain.empty()) continue;
    ++machines;
    const fs::path tree = fs::path(RMAC_BINARY_DIR) / "drivers";
    const ModuleLoader loader(
        {tree / fs::relative(entry.path().parent_path(), fs::path(RMAC_SOURCE_DIR) / "drivers"), tree / "modules"});
    const auto kinematics = loader.load<Kinematics>(database->device.kinematics);
    ASSERT_TRUE(kinematics) << kinematics.error().message;
    std::vector<JointLimits> limits;
    for (const sdk::Joint& joint : database->device.joints) limits.push_back(joint.limits);
    auto chain = LinkChain::make(*kinematics->object, database->bodies.chain, limits);
    ASSERT_TRUE(chain) << chain.error().message;
    const LinkPoses links(std::move(*chain), database->bodies.chain);
    for (const Body& body : database->bodies.bodies) {
      EXPECT_LT(place_of(links, body.link), links.names().size()) << body.name << " stands on no link that is told";
    }
    const std::size_t spindle = place_of(links, kSpindle), table = place_of(links, kTable);
    std::mt19937_64 random(2005);
    const auto between = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    std::vector<Frame> poses(links.names().size());
    std::vector<double> joints(limits.size());
    for (int i = 0; i < 500; ++i) {
      for (std::size_t j = 0; j < joints.size(); ++j) {
        joints[j] = between(ends_below(limits[j]) ? limits[j].min : -720, ends_above(limits[j]) ? limits[j].max : 720);
      }
      const Frame tool = normalized({{between(-20, 20), between(-20, 20), between(-150, 0)},
                                     {between(0.5, 1), between(-1, 1), between(-1, 1), between(-1, 1)}});
      links.at(joints, poses);
      const Frame tip = compose(inverse(poses[table]), compose(poses[spindle], compose(links.interface_home(), tool)));
      const ToolPose wanted = pose_of(*kinematics->object, joints, tool);
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_NEAR(tip.p[k], wanted.tip[k], 1e-6) << "joints of try " << i << ": " << testing::PrintToString(joints);
        ASSERT_NEAR(z_axis(tip)[k], wanted.axis[k], 1e-9) << "joints of try " << i;
      }
    }
  }
  EXPECT_GE(machines, 9U);
}

}  // namespace
}  // namespace rmac::gateway
