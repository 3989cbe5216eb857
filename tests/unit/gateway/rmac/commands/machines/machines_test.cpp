// What is asked of the database of machines, and how it is shown.
#include <gmock/gmock.h>

#include "gateway/rmac/wire/authority.hpp"
#include "unit/gateway/rmac/command_bench.hpp"

namespace rmac::cli {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kSearch = "DeviceDriverManager.SearchDatabaseRecordSet";

class MachinesCommand : public CommandBench {
 protected:
  /// The database has so many machines, M1, M2 and so on, all alike.
  void knows(int machines) {
    appliance_.answers(kSearch, machines);
    const auto answer = [this](const std::string& function, const json& value) {
      appliance_.answers("DeviceDriverManager." + function, value);
    };
    answer("Machine_GetMechanismID", 1);
    answer("Machine_GetMechanismName", "M1");
    answer("Machine_GetMechanismDeviceDriver", "mill");
    answer("Machine_GetMechanismDeviceDriverVersion", 10203);
    answer("Machine_GetMechanismType", "Mill");
    answer("Machine_GetMechanismConfigurationType", "3-axis");
    answer("Machine_GetMechanismNumberOfJoints", 3);
    answer("Machine_GetMechanismWorkingVolume", "100x100x50");
    answer("Machine_GetMechanismSpindleHorsePower", 1.5);
    answer("Machine_GetMechanismSpindleMaxSpeed", 24000.0);
    answer("Machine_GetMechanismSpindleMaxTorque", 0.25);
    answer("Machine_GetMechanismMaxFeedrate", 6000.0);
    answer("Machine_GetMechanismMaxPalletLoad", 20.0);
    answer("Machine_GetMechanismPositioningTolerance", 0.01);
    answer("Machine_GetMechanismRepeatabilityTolerance", 0.005);
    appliance_.handles("DeviceDriverManager.OnNextRecord", [this](const json&) {
      appliance_.answers("DeviceDriverManager.Machine_GetMechanismName", "M2");
      return gateway::Answer(true);
    });
  }
  std::string sql() {
    const auto searches = appliance_.params_of(kSearch);
    return searches.empty() ? "" : searches.back().at("MachineSQLStatement").get<std::string>();
  }
};
using ShowCommand = MachinesCommand;
using LoadCommand = CommandBench;
using VerifyCommand = CommandBench;

TEST_F(MachinesCommand, ListsAllOfThem) {
  knows(2);
  EXPECT_EQ(run({"machines"}).out,
            "name  type  configuration  joints   volume mm  spindle hp  feed mm/min\n"
            "M1    Mill         3-axis       3  100x100x50         1.5         6000\n"
            "M2    Mill         3-axis       3  100x100x50         1.5         6000\n");
  EXPECT_EQ(sql(), "SELECT * FROM DeviceDrivers ORDER BY MechanismID");
}

TEST_F(MachinesCommand, SearchByWhatIsGiven) {
  knows(0);
  ASSERT_EQ(run({"machines", "--type", "mi'll", "--configuration", "3-axis", "--joints", "3", "--volume", "150x100x50",
                 "--spindle-hp", "1.5"})
                .exit_code,
            0);
  EXPECT_EQ(sql(),
            "SELECT * FROM DeviceDrivers WHERE lower(Type) = lower('mi''ll') AND lower(ConfigurationType) = "
            "lower('3-axis') AND NumberOfJoints = 3 AND Length >= 150 AND Width >= 100 AND Depth >= 50 AND "
            "SpindleHorsePower >= 1.5 ORDER BY MechanismID");
}

TEST_F(MachinesCommand, SearchByAPersonsOwnStatementAlone) {
  knows(0);
  ASSERT_EQ(run({"machines", "--sql", "SELECT 1"}).exit_code, 0);
  EXPECT_EQ(sql(), "SELECT 1");
  for (const char* other : {"--type", "--configuration", "--joints", "--volume", "--spindle-hp"}) {
    EXPECT_EQ(run({"machines", "--sql", "SELECT 1", other, "3"}).exit_code, 2) << other;
  }
}

TEST_F(MachinesCommand, RefuseAVolumeThatIsNone) {
  for (const char* volume : {"150", "150x100", "150x100x", "axbxc", "150x100x50x2"}) {
    const auto failed = run({"machines", "--volume", volume});
    EXPECT_EQ(failed.exit_code, 1) << volume;
    EXPECT_THAT(failed.err, HasSubstr("write length x width x depth in mm"));
  }
  EXPECT_EQ(sql(), "");
}

TEST_F(MachinesCommand, ReadAVersionFromTheNumberOfTheApi) {
  knows(1);
  EXPECT_EQ(json::parse(run({"machines", "--json"}).out).at(0).at("DriverVersion"), "1.2.3");
}

TEST_F(MachinesCommand, SayWhichMachineMakesWhatOfAProgram) {
  knows(1);
  const auto failed = run({"machines", "--fits", "/nonexistent.rmac"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, HasSubstr("/nonexistent.rmac: cannot be read"));
}

TEST_F(ShowCommand, ShowsTheJointsOfTheLoadedMachineToo) {
  knows(1);
  appliance_.answers("Device.Machine_GetMechanismName", "M1");
  appliance_.answers("Device.Machine_GetMechanismNumberOfJoints", 1);
  appliance_.answers("Device.Machine_GetMechanismJntTypes", 1);
  for (const char* limit : {"MinLimit", "MaxLimit", "MaxSpeed", "MaxAccel", "MaxJerk"}) {
    appliance_.answers("Device.Machine_GetMechanismJnt" + std::string(limit), 12.5);
  }
  appliance_.answers("Device.Machine_GetMechanismJntServoControlLaw", "DMAC_PID_CONTROL");
  const auto shown = run({"show", "M1"});
  EXPECT_THAT(shown.out, HasSubstr("spindle torque         0.25        N·m\n"));
  EXPECT_THAT(shown.out,
              HasSubstr("joint  Type     Min   Max  MaxSpeed  MaxAcceleration  MaxJerk  ServoControlLaw\n"
                        "    0  linear  12.5  12.5      12.5             12.5     12.5  DMAC_PID_CONTROL\n"));
  EXPECT_EQ(sql(), "SELECT * FROM DeviceDrivers WHERE Name = 'M1'");
}

TEST_F(ShowCommand, ShowsNoJointsOfAMachineThatIsNotLoaded) {
  knows(1);
  appliance_.answers("Device.Machine_GetMechanismName", "M2");
  EXPECT_THAT(run({"show", "M1"}).out, testing::Not(HasSubstr("ServoControlLaw")));
  appliance_.refuses("Device.Machine_GetMechanismName", -32001, "none is loaded");
  EXPECT_EQ(run({"show", "M1"}).exit_code, 0);
}

TEST_F(ShowCommand, SaysThatThereIsNoSuchMachine) {
  knows(0);
  EXPECT_EQ(run({"show", "it's"}).err, "rmac: no machine is called \"it's\": `rmac machines` lists them\n");
  EXPECT_EQ(sql(), "SELECT * FROM DeviceDrivers WHERE Name = 'it''s'");
}

TEST_F(LoadCommand, LoadsAndUnloadsWithTheLease) {
  ASSERT_EQ(run({"load", "M1"}).exit_code, 0);
  ASSERT_EQ(run({"load", "M1", "--virtual"}).exit_code, 0);
  ASSERT_EQ(run({"unload"}).exit_code, 0);
  EXPECT_THAT(appliance_.params_of("Device.Load"),
              ElementsAre(json{{"Name", "M1"}, {"Virtual", false}}, json{{"Name", "M1"}, {"Virtual", true}}));
  EXPECT_THAT(appliance_.methods(),
              ElementsAre(kAcquireAuthority, "Device.Load", kReleaseAuthority, kAcquireAuthority, "Device.Load",
                          kReleaseAuthority, kAcquireAuthority, "Device.Unload", kReleaseAuthority));
}

TEST_F(LoadCommand, TellsWhyAMachineIsNotLoaded) {
  appliance_.refuses("Device.Load", -32014, "M9 is not in the device tree");
  const auto failed = run({"load", "M9"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.err, "rmac: M9 is not in the device tree\n");
}

TEST_F(VerifyCommand, AsksTheApplianceForAName) {
  appliance_.refuses("Device.Verify", -32014, "M9 is not in the device tree");
  EXPECT_EQ(run({"verify", "M9"}).err, "rmac: M9 is not in the device tree\n");
  EXPECT_THAT(appliance_.params_of("Device.Verify"), ElementsAre(json{{"Name", "M9"}}));
}

TEST_F(VerifyCommand, AsksNobodyForAPath) {
  for (const char* path : {"./M9", "/nonexistent/M9", "M9.json"}) {
    EXPECT_EQ(run({"verify", path}).exit_code, 1) << path;
  }
  EXPECT_THAT(appliance_.methods(), testing::IsEmpty());
}

}  // namespace
}  // namespace rmac::cli
