#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "gateway/collision/checker.hpp"
#include "gateway/device_database/device_database.hpp"
#include "gateway/modules/module_loader.hpp"
#include "places.hpp"
#include "rmac/motion/ports/kinematics.hpp"

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;

/// Slides reach into all corners of their travel. What turns is left at 0: a head at the end of its turn may meet the
/// machine, which is what the checks are for. So may a spindle that goes down beside a cradle, between its bearings.
TEST(MachinesOfTheTree, MeetNoneOfTheirOwnBodiesWithinTheTravelOfTheirSlides) {
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(RMAC_SOURCE_DIR) / "drivers")) {
    if (entry.path().filename() != "device.json" || entry.path().parent_path().filename() == "SuginoXYZAC") continue;
    const auto database = read_device_json(entry.path());
    ASSERT_TRUE(database) << database.error().message;
    const fs::path tree = fs::path(RMAC_BINARY_DIR) / "drivers";
    const fs::path folder = fs::relative(entry.path().parent_path(), fs::path(RMAC_SOURCE_DIR) / "drivers");
    const auto kinematics =
        ModuleLoader({tree / folder, tree / "modules"}).load<Kinematics>(database->device.kinematics);
    ASSERT_TRUE(kinematics) << kinematics.error().message;
    std::vector<std::string> names;
    std::vector<std::pair<double, double>> limits;
    for (const sdk::Joint& joint : database->device.joints) {
      names.push_back(joint.limits.name);
      const bool turns = joint.limits.type == JointType::Rotary;
      limits.emplace_back(turns ? -100 : joint.limits.min, turns ? 100 : joint.limits.max);
    }
    auto chain = LinkChain::make(*kinematics->object, database->bodies.chain, names, limits);
    ASSERT_TRUE(chain) << entry.path() << chain.error().message;
    const auto bodies = scene_bodies(database->bodies, gateway::Setup{});
    ASSERT_TRUE(bodies) << bodies.error().message;
    CollisionChecker checker(*chain, *bodies, Frame{}, 1);
    std::mt19937_64 random(5);
    std::vector<double> joints(names.size(), 0.0);
    for (int i = 0; i < 100; ++i) {
      for (std::size_t j = 0; j < joints.size(); ++j) {
        if (database->device.joints[j].limits.type == JointType::Rotary) continue;
        joints[j] = random() % 2 == 0 ? limits[j].first : limits[j].second;
      }
      checker.advance(i * 0.001, joints, {.id = i});
    }
    for (const Finding& f : checker.findings().sorted()) {
      ADD_FAILURE() << database->device.name << ": " << f.first << " and " << f.second << ", " << f.depth_mm
                    << " mm deep, in move " << f.move_id;
    }
  }
}

}  // namespace
}  // namespace rmac::gateway
