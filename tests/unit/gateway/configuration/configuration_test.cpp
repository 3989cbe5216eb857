#include "gateway/configuration/configuration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "places.hpp"
#include "unit/gateway/device_driver_manager/fixtures.hpp"

namespace rmac::gateway {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;
using testing::StartsWith;

Configuration read(const std::string& text, const ConfigurationOverrides& overrides = {}) {
  const TemporaryFolder folder;
  const auto configuration = read_configuration(folder.write("rmacd.json", text), overrides);
  EXPECT_TRUE(configuration) << (configuration ? "" : configuration.error().message);
  return configuration ? *configuration : Configuration{};
}

std::string refusal_of(const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder.write("rmacd.json", text);
  const auto configuration = read_configuration(file);
  if (configuration) return "";
  EXPECT_THAT(configuration.error().message, StartsWith(file.string() + ": "));
  return configuration.error().message.substr(file.string().size() + 2);
}

TEST(Configuration, HasADefaultForEveryKey) {
  const Configuration configuration = read("{}");
  EXPECT_EQ(configuration.address, "127.0.0.1");
  EXPECT_EQ(configuration.port, 7402);
  EXPECT_EQ(configuration.unix_socket, default_folders().runtime_folder / "rmacd.sock");
  EXPECT_EQ(configuration.state_folder, default_folders().state_folder);
  EXPECT_EQ(configuration.device_tree, default_folders().device_tree);
  EXPECT_EQ(configuration.module_folders, std::vector{default_folders().device_tree / "modules"});
  EXPECT_EQ(configuration.drives_folder, default_folders().drives);
  EXPECT_EQ(configuration.database, (default_folders().state_folder / "device-drivers.sqlite").string());
  EXPECT_EQ(configuration.period, std::chrono::milliseconds(1));
  EXPECT_EQ(configuration.pace, Pace::RealTime);
  EXPECT_EQ(configuration.real_time.cpu, std::nullopt);
  EXPECT_EQ(configuration.real_time.priority, 80);
  EXPECT_TRUE(configuration.real_time.lock_memory);
  EXPECT_TRUE(configuration.real_time.degraded_allowed);
  EXPECT_EQ(configuration.queue_capacity, 10'000);
  EXPECT_EQ(configuration.lease_lost, StopCategory::StopKeepPower);
  EXPECT_EQ(configuration.lease_timeout, std::chrono::seconds(0));
  EXPECT_TRUE(configuration.operator_alone_resumes);
  EXPECT_FALSE(configuration.jog_while_waiting);
  EXPECT_EQ(configuration.flight_recorder.folder, default_folders().state_folder / "flight-records");
  EXPECT_EQ(configuration.flight_recorder.seconds, 10);
  EXPECT_EQ(configuration.flight_recorder.files_kept, 20U);
  EXPECT_EQ(configuration.real_time.max_cycles_lost, 0) << "missed deadlines stop nothing";
  EXPECT_EQ(configuration.autoload, std::nullopt);
}

TEST(Configuration, DefaultFoldersAreAbsolute) {
  EXPECT_TRUE(default_folders().device_tree.is_absolute());
  EXPECT_TRUE(default_folders().drives.is_absolute());
  EXPECT_TRUE(default_folders().state_folder.is_absolute());
  EXPECT_TRUE(default_folders().runtime_folder.is_absolute());
}

TEST(Configuration, TakesEveryKeyOfTheFile) {
  const Configuration configuration = read(R"({
    "listen": {"address": "::1", "port": 0, "unix_socket": ""},
    "state_folder": "/s", "device_tree": "/d", "module_folders": ["/m", "/n"], "database": "/b/x.sqlite",
    "period_s": 0.0005, "pace": "as-fast-as-computed",
    "real_time": {"cpu": 3, "priority": 42, "lock_memory": false, "degraded_allowed": false,
                  "max_cycles_lost": 9},
    "queue_capacity": 7,
    "lease_timeout_s": 2.5, "operator_alone_resumes": false, "jog_while_waiting": true,
    "stop_categories": {"LeaseLost": 1, "DriveHeartbeatLost": 1, "BusLost": 1, "FollowingError": 1, "SensorLost": 2,
                        "ContactLost": 1, "CycleDeadline": 2},
    "flight_recorder": {"folder": "/f", "seconds": 2.5, "files": 3},
    "autoload": {"mechanism": "DMACXYZ", "virtual": true}})");
  EXPECT_EQ(configuration.address, "::1");
  EXPECT_EQ(configuration.port, 0);
  EXPECT_TRUE(configuration.unix_socket.empty());
  EXPECT_EQ(configuration.state_folder, "/s");
  EXPECT_EQ(configuration.device_tree, "/d");
  EXPECT_EQ(configuration.module_folders, (std::vector<std::filesystem::path>{"/m", "/n"}));
  EXPECT_EQ(configuration.database, "/b/x.sqlite");
  EXPECT_EQ(configuration.period, std::chrono::microseconds(500));
  EXPECT_EQ(configuration.pace, Pace::AsFastAsComputed);
  EXPECT_EQ(configuration.real_time.cpu, 3);
  EXPECT_EQ(configuration.real_time.priority, 42);
  EXPECT_FALSE(configuration.real_time.lock_memory);
  EXPECT_FALSE(configuration.real_time.degraded_allowed);
  EXPECT_EQ(configuration.queue_capacity, 7);
  EXPECT_EQ(configuration.lease_lost, StopCategory::StopThenRemovePower);
  EXPECT_EQ(configuration.stop_categories.sensor_lost, StopCategory::StopKeepPower);
  EXPECT_EQ(configuration.stop_categories.contact_lost, StopCategory::StopThenRemovePower);
  EXPECT_EQ(configuration.stop_categories.force_limit, StopCategory::StopThenRemovePower) << "not said";
  EXPECT_EQ(configuration.stop_categories.cycles_lost, StopCategory::StopKeepPower);
  EXPECT_EQ(configuration.stop_categories.drive_silent, StopCategory::StopThenRemovePower);
  EXPECT_EQ(configuration.real_time.max_cycles_lost, 9);
  EXPECT_EQ(configuration.lease_timeout, std::chrono::milliseconds(2500));
  EXPECT_FALSE(configuration.operator_alone_resumes);
  EXPECT_TRUE(configuration.jog_while_waiting);
  EXPECT_EQ(configuration.flight_recorder.folder, "/f");
  EXPECT_EQ(configuration.flight_recorder.seconds, 2.5);
  EXPECT_EQ(configuration.flight_recorder.files_kept, 3U);
  ASSERT_TRUE(configuration.autoload);
  EXPECT_EQ(configuration.autoload->mechanism, "DMACXYZ");
  EXPECT_TRUE(configuration.autoload->virtual_mode);
}

TEST(Configuration, RefusesWhatCannotActYetAndSaysWhy) {
  EXPECT_EQ(refusal_of(R"({"stop_categories": {"FollowingError": 2}})"),
            "/stop_categories/FollowingError is 2; allowed is one of 1");
  EXPECT_EQ(refusal_of(R"({"stop_categories": {"SensorLost": 0}})"),
            "/stop_categories/SensorLost is 0; allowed is one of 1, 2");
}

TEST(Configuration, RelativePathsAreTheFilesNotTheWorkingFolders) {
  const TemporaryFolder folder;
  const auto file = folder.write("etc/rmacd.json", R"({"state_folder": "../state", "module_folders": ["m"]})");
  const auto configuration = read_configuration(file);
  ASSERT_TRUE(configuration) << configuration.error().message;
  EXPECT_EQ(configuration->state_folder, folder.path() / "state");
  EXPECT_EQ(configuration->module_folders.front(), folder.path() / "etc/m");
  EXPECT_EQ(configuration->database, (folder.path() / "state/device-drivers.sqlite").string());
  EXPECT_EQ(configuration->unix_socket, folder.path() / "state/rmacd.sock");
}

TEST(Configuration, CommandLineGoesOverTheFileAndWhatFollowsFromIt) {
  const Configuration configuration =
      read(R"({"listen": {"port": 1}, "state_folder": "/s", "device_tree": "/d", "pace": "real-time"})",
           {.port = 2, .state_folder = "/other", .device_tree = "/tree", .pace = Pace::AsFastAsComputed});
  EXPECT_EQ(configuration.port, 2);
  EXPECT_EQ(configuration.state_folder, "/other");
  EXPECT_EQ(configuration.database, "/other/device-drivers.sqlite");
  EXPECT_EQ(configuration.unix_socket, "/other/rmacd.sock");
  EXPECT_EQ(configuration.flight_recorder.folder, "/other/flight-records");
  EXPECT_EQ(configuration.device_tree, "/tree");
  EXPECT_EQ(configuration.module_folders.front(), "/tree/modules");
  EXPECT_EQ(configuration.pace, Pace::AsFastAsComputed);
}

TEST(Configuration, OtherThanLoopbackIsRefusedWithTheReason) {
  for (const char* address : {"0.0.0.0", "192.168.1.5", "::", "localhost", "127.0.0.1.evil.example", ""}) {
    const std::string problem = refusal_of(std::string(R"({"listen": {"address": ")") + address + "\"}}");
    EXPECT_THAT(problem,
                StartsWith(std::string("/listen/address is \"") + address + "\"; allowed is a loopback address"));
    EXPECT_THAT(problem, HasSubstr("not authenticated yet"));
  }
  EXPECT_EQ(read(R"({"listen": {"address": "127.5.0.1"}})").address, "127.5.0.1");
}

TEST(Configuration, ErrorNamesKeyValueAndAllowedRange) {
  EXPECT_EQ(refusal_of(R"({"period_s": 1})"), "/period_s is 1; allowed is a number from 0.0001 to 0.1 (s)");
  EXPECT_EQ(refusal_of(R"({"listen": {"port": 70000}})"),
            "/listen/port is 70000; allowed is an integer from 0 to 65535");
  EXPECT_EQ(refusal_of(R"({"pace": "slow"})"),
            "/pace is \"slow\"; allowed is one of \"real-time\", \"as-fast-as-computed\"");
  EXPECT_EQ(refusal_of(R"({"stop_categories": {"LeaseLost": 0}})"),
            "/stop_categories/LeaseLost is 0; allowed is one of 1, 2");
  EXPECT_THAT(refusal_of(R"({"listen": {"prot": 7402}})"),
              StartsWith("/listen has the unknown key \"prot\"; did you mean \"port\"?"));
  EXPECT_EQ(
      refusal_of(R"({"autoload": {}})"),
      "/autoload lacks the key \"mechanism\", a text of at most 100 characters (a letter, then letters, digits, - "
      "and _)");
  EXPECT_THAT(refusal_of("{\n\"pace\" \"slow\"}"), StartsWith("line 2, column 13 is not JSON: "));
}

TEST(Configuration, SocketPathThatTheSystemCannotTakeIsRefused) {
  const std::string path = "/" + std::string(107, 'a');
  EXPECT_THAT(refusal_of(R"({"listen": {"unix_socket": ")" + path + "\"}}"), HasSubstr("108 bytes"));
  EXPECT_EQ(read(R"({"listen": {"unix_socket": ")" + path.substr(0, 107) + "\"}}").unix_socket, path.substr(0, 107));
}

TEST(Configuration, MayHaveNoTcpPort) {
  EXPECT_TRUE(read("{}").tcp);
  EXPECT_FALSE(read(R"({"listen": {"tcp": false}})").tcp);
  ConfigurationOverrides port;
  port.port = 0;
  EXPECT_TRUE(read(R"({"listen": {"tcp": false}})", port).tcp) << "who names a port wants one";
  EXPECT_THAT(refusal_of(R"({"listen": {"tcp": false, "unix_socket": ""}})"), HasSubstr("nobody could connect"));
}

TEST(Configuration, TheOneThatIsInstalledIsSound) {
  const auto configuration = read_configuration(RMAC_SOURCE_DIR "/etc/rmacd.json");
  ASSERT_TRUE(configuration) << configuration.error().message;
}

}  // namespace
}  // namespace rmac::gateway
