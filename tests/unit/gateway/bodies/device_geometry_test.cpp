#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "gateway/bodies/link_chain.hpp"
#include "gateway/device_database/device_database.hpp"
#include "gateway/modules/module_loader.hpp"
#include "gateway/processes/temporary_folder.hpp"
#include "places.hpp"
#include "rmac/motion/ports/kinematics.hpp"

namespace rmac::gateway {
namespace {

using nlohmann::json;
using testing::HasSubstr;
namespace fs = std::filesystem;

std::vector<fs::path> machines() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(RMAC_SOURCE_DIR) / "drivers")) {
    if (entry.path().filename() == "device.json") files.push_back(entry.path());
  }
  return files;
}

/// What is wrong with SuginoXYZAC changed by `edit`.
template <typename Edit>
std::string problem_with(Edit edit) {
  const TemporaryFolder folder("device");
  json device;
  std::ifstream(fs::path(RMAC_SOURCE_DIR) / "drivers/mill/5-axis/SuginoXYZAC/device.json") >> device;
  edit(device);
  std::ofstream(folder.path() / "device.json") << device.dump();
  const auto read = read_device_json(folder.path() / "device.json");
  return read ? "" : read.error().message;
}

TEST(DeviceGeometry, OfEachMachineOfTheTreeStandsOnLinksThatItsModuleMovesSo) {
  ASSERT_GE(machines().size(), 9u);
  for (const fs::path& file : machines()) {
    SCOPED_TRACE(file.string());
    const auto database = read_device_json(file);
    ASSERT_TRUE(database) << database.error().message;
    EXPECT_GE(database->bodies.bodies.size(), 5u);
    const fs::path tree = fs::path(RMAC_BINARY_DIR) / "drivers";
    const ModuleLoader loader(
        {tree / fs::relative(file.parent_path(), fs::path(RMAC_SOURCE_DIR) / "drivers"), tree / "modules"});
    const auto kinematics = loader.load<Kinematics>(database->device.kinematics);
    ASSERT_TRUE(kinematics) << kinematics.error().message;
    std::vector<std::string> names;
    std::vector<std::pair<double, double>> limits;
    for (const sdk::Joint& joint : database->device.joints) {
      names.push_back(joint.limits.name);
      limits.emplace_back(-300, 300);
    }
    const auto chain = LinkChain::make(*kinematics->object, database->bodies.chain, names, limits);
    EXPECT_TRUE(chain) << chain.error().message;
  }
}

TEST(DeviceGeometry, MayBeLeftOut) {
  EXPECT_EQ(problem_with([](json& d) { d.erase("Geometry"), d.erase("Chain"); }), "");
}

TEST(DeviceGeometry, IsRefusedWithWhatIsWrongAndWhatIsAllowed) {
  EXPECT_THAT(problem_with([](json& d) { d["Geometry"][0]["Link"] = "c"; }),
              HasSubstr("/Geometry/0/Link is \"c\", which is no link of this machine; did you mean \"C\"?"));
  EXPECT_THAT(problem_with([](json& d) { d["Geometry"][0]["Link"] = "W"; }),
              HasSubstr("there are table, spindle, C, A"));
  EXPECT_THAT(problem_with([](json& d) { d.erase("Chain"); }), HasSubstr("/Geometry needs the key \"Chain\""));
  EXPECT_THAT(problem_with([](json& d) {
                d["Chain"] = {"C", "A", "X", "Y", "Z"};
              }),
              HasSubstr("it must name base and each"));
  EXPECT_THAT(problem_with([](json& d) {
                d["Joints"][2]["Name"] = "spindle";
                d["Chain"] = {"C", "A", "base", "X", "Y", "spindle"};
              }),
              HasSubstr("/Joints has one that is called \"spindle\""));
  EXPECT_THAT(problem_with([](json& d) { d["Geometry"][1]["Name"] = d["Geometry"][0]["Name"]; }),
              HasSubstr("/Geometry/1/Name"));
  EXPECT_THAT(problem_with([](json& d) { d["Geometry"][0]["Shape"] = json::object(); }),
              HasSubstr("/Geometry/0/Shape"));
  EXPECT_THAT(problem_with([](json& d) {
                d["Geometry"][0]["Shape"] = {{"Box", {{"Size", {1, 0, 2}}}}};
              }),
              HasSubstr("/Geometry/0/Shape/Box/Size/1"));
  EXPECT_THAT(problem_with([](json& d) {
                d["Geometry"][0]["Pose"] = {{"p", {0, 0, 0}}, {"q", {0.7, 0, 0, 0.7}}};
              }),
              HasSubstr("/Geometry/0/Pose: the quaternion q has length 0.98"));
  EXPECT_THAT(problem_with([](json& d) {
                d["Geometry"][0]["Pose"] = {{"p", {0, 0, 0}}, {"axis", {0, 0, 90}}};
              }),
              HasSubstr("/Geometry/0/Pose/axis"));
  EXPECT_THAT(problem_with([](json& d) { d["Geometry"][0]["Pose"] = {{"p", {0, 0, 0}}}; }), HasSubstr("either \"q\""));
}

TEST(DeviceGeometry, ReadsMeshesFromTheMachinesFolderAlone) {
  const auto with_file = [](const char* file) {
    return problem_with([&](json& d) { d["Geometry"][0]["Shape"] = {{"Mesh", {{"File", file}}}}; });
  };
  EXPECT_THAT(with_file("../../etc/passwd"),
              HasSubstr("/Geometry/0/Shape/Mesh/File is \"../../etc/passwd\"; allowed is a file in"));
  EXPECT_THAT(with_file("/etc/passwd"), HasSubstr("allowed is a file in the folder"));
  EXPECT_THAT(with_file("head.stl"), HasSubstr("there is no such file"));
}

TEST(DeviceGeometry, DoesNotFollowALinkOutOfTheMachinesFolder) {
  const TemporaryFolder folder("device"), elsewhere("elsewhere");
  std::ofstream(elsewhere.path() / "a.stl") << "solid";
  fs::create_symlink(elsewhere.path(), folder.path() / "meshes");
  json device;
  std::ifstream(fs::path(RMAC_SOURCE_DIR) / "drivers/mill/5-axis/SuginoXYZAC/device.json") >> device;
  device["Geometry"][0]["Shape"] = {{"Mesh", {{"File", "meshes/a.stl"}}}};
  std::ofstream(folder.path() / "device.json") << device.dump();
  const auto read = read_device_json(folder.path() / "device.json");
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("allowed is a file in the folder"));
}

}  // namespace
}  // namespace rmac::gateway
