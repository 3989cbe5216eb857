#include "gateway/device_driver_manager/device_driver_manager.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "places.hpp"
#include "unit/gateway/device_driver_manager/fixtures.hpp"

namespace rmac::gateway {
namespace {

using nlohmann::json;
using test::sound_device;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

class DeviceDriverManagerTest : public testing::Test {
 protected:
  std::unique_ptr<DeviceDriverManager> open() {
    auto manager = DeviceDriverManager::open(options());
    EXPECT_TRUE(manager) << (manager ? "" : manager.error().message);
    return manager ? std::move(*manager) : nullptr;
  }
  [[nodiscard]] DeviceDriverManager::Options options() const {
    return {.device_tree = folder_.path() / "tree",
            .database = (folder_.path() / "state/drivers.sqlite").string(),
            .searcher = test::kSearcher};
  }
  static std::vector<std::pair<std::int64_t, std::string>> numbers(const DeviceDriverManager& manager) {
    std::vector<std::pair<std::int64_t, std::string>> found;
    const std::vector<DriverRecord> records = manager.all().value();
    for (const DriverRecord& record : records) found.emplace_back(record.mechanism_id, record.name);
    return found;
  }

  const TemporaryFolder folder_;
};

TEST_F(DeviceDriverManagerTest, ListsTable41InItsOrderWithItsValues) {
  write_tree(folder_, test::table_4_1());
  const auto manager = open();
  ASSERT_TRUE(manager);
  EXPECT_TRUE(manager->problems().empty());
  EXPECT_THAT(numbers(*manager), ElementsAre(Pair(1, "DMACXYZ"), Pair(2, "TarusXYZCA"), Pair(3, "SuginoXYZ"),
                                             Pair(4, "SuginoXYZAC"), Pair(5, "CMM"), Pair(6, "DMACXY")));
  const DriverRecord tarus = manager->all().value().at(1);
  EXPECT_EQ(tarus.device_driver, "TarusXYZCA");
  EXPECT_EQ(tarus.type, "Mill");
  EXPECT_EQ(tarus.configuration_type, "5-axis");
  EXPECT_EQ(tarus.number_of_joints, 5);
  EXPECT_EQ(tarus.length, 800);
  EXPECT_EQ(tarus.width, 800);
  EXPECT_EQ(tarus.depth, 800);
  EXPECT_EQ(tarus.spindle_horse_power, 10);
  EXPECT_EQ(tarus.spindle_max_speed, 5000);
  EXPECT_EQ(tarus.spindle_max_torque, 50);
  EXPECT_EQ(tarus.max_feedrate, 20000);
  EXPECT_EQ(tarus.max_pallet_load, 1000);
  EXPECT_EQ(tarus.positioning_tolerance, 0.005);
  EXPECT_EQ(tarus.repeatability_tolerance, 0.0025);
  EXPECT_EQ(tarus.speed_capability, "fast");
  EXPECT_EQ(tarus.driver_version, "1.2.3");
}

TEST_F(DeviceDriverManagerTest, ListsAMechanismWithoutSpindleOrModules) {
  json device = sound_device();
  device["Spindles"] = json::array();
  write_tree(folder_, {device});
  const auto manager = open();
  ASSERT_TRUE(manager);
  ASSERT_EQ(manager->all().value().size(), 1U);
  EXPECT_EQ(manager->all().value().front().spindle_horse_power, 0);
}

TEST_F(DeviceDriverManagerTest, LeavesABadFolderOutAndReportsIt) {
  write_tree(folder_, {sound_device("Good")});
  folder_.write("tree/mill/3-axis/Broken/device.json", "{");
  json misplaced = sound_device("Other");
  folder_.write("tree/mill/3-axis/Misplaced/device.json", misplaced.dump());
  folder_.write("tree/cmm/3-axis/Other/device.json", misplaced.dump());
  folder_.write("tree/mill/9-axis/Other/device.json", misplaced.dump());
  folder_.write("tree/sdk/include/rmac/module.hpp", "");
  folder_.write("tree/README.md", "");
  const auto manager = open();
  ASSERT_TRUE(manager);
  EXPECT_THAT(numbers(*manager), ElementsAre(Pair(1, "Good")));
  ASSERT_EQ(manager->problems().size(), 4U);
  EXPECT_EQ(manager->problems()[0].file, folder_.path() / "tree/cmm/3-axis/Other/device.json");
  EXPECT_THAT(manager->problems()[0].message, HasSubstr("/Type is \"Mill\"; allowed is \"cmm\""));
  EXPECT_THAT(manager->problems()[1].message, HasSubstr("Broken/device.json: line 1, column 1 is not JSON"));
  EXPECT_THAT(manager->problems()[2].message, HasSubstr("/MechanismName is \"Other\"; allowed is \"Misplaced\""));
  EXPECT_THAT(manager->problems()[3].message, HasSubstr("/ConfigurationType is \"3-axis\"; allowed is \"9-axis\""));
}

TEST_F(DeviceDriverManagerTest, TakesLinksWithinTheTreeAlone) {
  write_tree(folder_, {sound_device("Good")});
  const std::filesystem::path mills = folder_.path() / "tree/mill/3-axis";
  folder_.write("elsewhere/Strange/device.json", sound_device("Strange").dump());
  folder_.write("tree/shelf/Kept/device.json", sound_device("Kept").dump());  // no mechanism at this depth
  std::filesystem::create_directory_symlink(folder_.path() / "elsewhere/Strange", mills / "Strange");
  std::filesystem::create_directory_symlink("../../shelf/Kept", mills / "Kept");
  const auto manager = open();
  ASSERT_TRUE(manager);
  EXPECT_THAT(numbers(*manager), ElementsAre(Pair(1, "Good"), Pair(2, "Kept")));
  ASSERT_EQ(manager->problems().size(), 1U);
  EXPECT_THAT(manager->problems()[0].message, HasSubstr("a link leads out of the device tree"));
}

TEST_F(DeviceDriverManagerTest, ANameThatStandsTwiceIsListedOnce) {
  json mill = sound_device("Twin");
  json cmm = sound_device("Twin");
  cmm["Type"] = "CMM";
  write_tree(folder_, {mill, cmm});
  const auto manager = open();
  ASSERT_TRUE(manager);
  ASSERT_EQ(manager->all().value().size(), 1U);
  EXPECT_EQ(manager->all().value().front().type, "CMM");
  EXPECT_THAT(manager->problems().front().message, HasSubstr("\"Twin\", which "));
}

TEST_F(DeviceDriverManagerTest, ANameKeepsItsNumberOverRescansAndRestarts) {
  write_tree(folder_, {sound_device("A"), sound_device("B"), sound_device("C")});
  {
    const auto manager = open();
    ASSERT_TRUE(manager);
    EXPECT_THAT(numbers(*manager), ElementsAre(Pair(1, "A"), Pair(2, "B"), Pair(3, "C")));
    std::filesystem::remove_all(folder_.path() / "tree/mill/3-axis/B");
    EXPECT_EQ(manager->rescan().value(), 2);
    EXPECT_THAT(numbers(*manager), ElementsAre(Pair(1, "A"), Pair(3, "C")));
    EXPECT_FALSE(manager->folder_of("B"));
  }
  write_tree(folder_, {sound_device("AA"), sound_device("B")});
  const auto manager = open();
  ASSERT_TRUE(manager);
  EXPECT_THAT(numbers(*manager), ElementsAre(Pair(1, "A"), Pair(2, "B"), Pair(3, "C"), Pair(4, "AA")));
}

TEST_F(DeviceDriverManagerTest, AClaimedNumberIsKeptFreeForItsMechanism) {
  json late = sound_device("Z");
  late["MechanismID"] = 1;
  write_tree(folder_, {sound_device("A"), late});
  const auto manager = open();
  ASSERT_TRUE(manager);
  EXPECT_THAT(numbers(*manager), ElementsAre(Pair(1, "Z"), Pair(2, "A")));
}

TEST_F(DeviceDriverManagerTest, AClaimOnAnothersNumberIsReported) {
  json first = sound_device("First");
  json second = sound_device("Second");
  first["MechanismID"] = 7;
  second["MechanismID"] = 7;
  write_tree(folder_, {first, second});
  const auto manager = open();
  ASSERT_TRUE(manager);
  EXPECT_THAT(numbers(*manager), ElementsAre(Pair(7, "First")));
  EXPECT_THAT(manager->problems().front().message,
              HasSubstr("/MechanismID is 7; allowed is a number of its own; First has this one"));

  first["MechanismID"] = 8;
  write_tree(folder_, {first});
  EXPECT_TRUE(manager->rescan());
  EXPECT_THAT(manager->problems().front().message,
              HasSubstr("/MechanismID is 8; allowed is 7, the number that First has had so far"));
}

TEST_F(DeviceDriverManagerTest, FindsTheFolderOrListsTheNames) {
  write_tree(folder_, {sound_device("A"), sound_device("B")});
  const auto manager = open();
  ASSERT_TRUE(manager);
  EXPECT_EQ(manager->folder_of("B").value(), folder_.path() / "tree/mill/3-axis/B");
  EXPECT_THAT(manager->folder_of("C").error().message, HasSubstr("there is no mechanism \"C\""));
  EXPECT_THAT(manager->folder_of("C").error().message, HasSubstr("there are: A, B"));
  EXPECT_EQ(manager->folder_of("C").error().code, MinorCode::InvalidParameterValue);
}

TEST_F(DeviceDriverManagerTest, MissingTreeUnusableDatabaseAndPostgresqlAreErrors) {
  EXPECT_THAT(DeviceDriverManager::open(options()).error().message, HasSubstr("set device_tree in rmacd.json"));
  write_tree(folder_, {});
  EXPECT_THAT(DeviceDriverManager::open({folder_.path() / "tree", "postgresql://plant/rmac"}).error().message,
              HasSubstr("not supported yet"));
  folder_.write("file", "text");
  EXPECT_FALSE(DeviceDriverManager::open({folder_.path() / "tree", (folder_.path() / "file/db.sqlite").string()}));
  const auto garbage = folder_.write("garbage.sqlite", std::string(4096, 'x'));
  EXPECT_THAT(DeviceDriverManager::open({folder_.path() / "tree", garbage.string()}).error().message,
              HasSubstr("not a database"));
}

TEST_F(DeviceDriverManagerTest, AFailedRescanLeavesTheOldListAlone) {
  write_tree(folder_, {sound_device("A")});
  const auto manager = open();
  ASSERT_TRUE(manager);
  std::filesystem::remove_all(folder_.path() / "tree");
  EXPECT_FALSE(manager->rescan());
  EXPECT_THAT(numbers(*manager), ElementsAre(Pair(1, "A")));
  EXPECT_TRUE(manager->folder_of("A"));
}

TEST_F(DeviceDriverManagerTest, KeepsItsFileWhateverTheFoldersName) {
  write_tree(folder_, {sound_device("A")});
  const auto file = folder_.path() / "a folder; with=signs & 'quotes'" / "drivers.sqlite";
  const auto manager = DeviceDriverManager::open(
      {.device_tree = folder_.path() / "tree", .database = file.string(), .searcher = test::kSearcher});
  ASSERT_TRUE(manager) << manager.error().message;
  EXPECT_TRUE(std::filesystem::exists(file));
  EXPECT_EQ((*manager)->search("SELECT * FROM DeviceDrivers").value().size(), 1U);
}

/// The device tree of this repository.
TEST_F(DeviceDriverManagerTest, RepositorysTreeHoldsTable41) {
  auto opened = DeviceDriverManager::open({RMAC_SOURCE_DIR "/drivers", options().database});
  ASSERT_TRUE(opened) << opened.error().message;
  const auto& manager = **opened;
  for (const auto& problem : manager.problems()) ADD_FAILURE() << problem.message;
  EXPECT_THAT(numbers(manager), ElementsAre(Pair(1, "DMACXYZ"), Pair(2, "TarusXYZCA"), Pair(3, "SuginoXYZ"),
                                            Pair(4, "SuginoXYZAC"), Pair(5, "CMM"), Pair(6, "DMACXY"),
                                            Pair(7, "BenchXYZ"), Pair(8, "DMACXYZA"), Pair(9, "TarusXYZCATwin")));
  const std::vector<DriverRecord> records = manager.all().value();
  const std::vector<json> table = test::table_4_1();
  ASSERT_EQ(records.size(), table.size() + 3);
  for (std::size_t i = 0; i < table.size(); ++i) {
    SCOPED_TRACE(records[i].name);
    EXPECT_EQ(records[i].type, table[i]["Type"]);
    EXPECT_EQ(records[i].configuration_type, table[i]["ConfigurationType"]);
    EXPECT_EQ(records[i].number_of_joints, static_cast<int>(table[i]["Joints"].size()));
    EXPECT_EQ(records[i].length, table[i]["WorkingVolume"]["Length"]);
    EXPECT_EQ(records[i].width, table[i]["WorkingVolume"]["Width"]);
    EXPECT_EQ(records[i].depth, table[i]["WorkingVolume"]["Depth"]);
    EXPECT_EQ(records[i].spindle_horse_power, table[i]["Spindles"][0]["HorsePower"]);
    EXPECT_EQ(records[i].spindle_max_speed, table[i]["Spindles"][0]["MaxSpeed"]);
    EXPECT_EQ(records[i].spindle_max_torque, table[i]["Spindles"][0]["MaxTorque"]);
    EXPECT_EQ(records[i].max_feedrate, table[i]["MaxFeedrate"]);
    EXPECT_EQ(records[i].max_pallet_load, table[i]["MaxPalletLoad"]);
    EXPECT_EQ(records[i].positioning_tolerance, table[i]["PositioningTolerance"]);
    EXPECT_EQ(records[i].repeatability_tolerance, table[i]["RepeatabilityTolerance"]);
  }
}

}  // namespace
}  // namespace rmac::gateway
