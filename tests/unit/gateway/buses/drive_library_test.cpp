#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "gateway/buses/drive_library_file.hpp"
#include "gateway/json/schemas.hpp"
#include "places.hpp"
#include "rmac/fieldbus/eds/device_description.hpp"
#include "unit/gateway/device_driver_manager/fixtures.hpp"

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;
using fieldbus::canopen::DriveDescription;
using fieldbus::canopen::DriveLibrary;
using fieldbus::canopen::Identity;
using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const fs::path kDrives = fs::path(RMAC_SOURCE_DIR) / "etc" / "drives";

json sound() {
  return {{"Name", "maker drive"},
          {"Manual", "manual, revision 3"},
          {"Tried", "never"},
          {"VendorId", "1A2h"},
          {"ProductCode", 515}};
}

/// Files of a library that is there for as long as this is.
class Library {
 public:
  Library& hold(const std::string& name, const json& document) {
    folder_.write(name, document.dump());
    return *this;
  }
  Library& hold_text(const std::string& name, const std::string& text) {
    folder_.write(name, text);
    return *this;
  }
  [[nodiscard]] DriveLibrary read() const { return read_drive_library(folder_.path()); }
  [[nodiscard]] std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

 private:
  test::TemporaryFolder folder_;
};

/// Why a library of this file alone refuses the drive that it is for.
std::string refusal(const json& changed) {
  Library library;
  const DriveLibrary read = library.hold("maker-drive.json", changed).read();
  const DriveDescription* drive = read.find({0x1A2, 515, 7, 0});
  if (drive == nullptr) return "no such drive";
  return drive->refusal.empty() ? "no error" : drive->refusal.substr(library.file("").size());
}

TEST(DriveLibraries, AreSoundAsShipped) {
  const DriveLibrary library = read_drive_library(kDrives);
  const auto checked = check(library);
  ASSERT_TRUE(checked) << checked.error().message;
  for (const DriveDescription& drive : library.drives) {
    EXPECT_GT(json::parse(std::ifstream(drive.file))["Manual"].get<std::string>().size(), 20U) << "it cites its manual";
  }
}

TEST(DriveLibraries, KnowTheDrivesOfTheBench) {
  const auto sheet =
      fieldbus::eds::read_device_description(fs::path(RMAC_SOURCE_DIR) / "gateway/simulators/vdrive/rmac-vdrive.eds");
  ASSERT_TRUE(sheet);
  const DriveLibrary library = read_drive_library(kDrives);
  const DriveDescription* drive = library.find({sheet->vendor_number, sheet->product_number, 0x00010000, 0});
  ASSERT_NE(drive, nullptr);
  EXPECT_EQ(drive->name, "rmac-vdrive");
}

TEST(DriveLibraries, AreReadAsTheyAreWritten) {
  json document = sound();
  document.update({{"RevisionNumber", {{"Min", 3}, {"Max", "FFh"}}},
                   {"Skip", {"6502h", "60c2h:02"}},
                   {"SdoTimeout", 1.25},
                   {"SdoRetries", 4},
                   {"BootTimeout", 12},
                   {"StoreAfterMapping", true},
                   {"NoHeartbeatConsumer", "it goes on"},
                   {"NoAbortConnection", true},
                   {"QuickStopInverted", true},
                   {"HomingWithoutTargetReached", true},
                   {"AnswerDelay", 3},
                   {"InterpolationTimePeriod", {{"Index", -4}, {"Values", {5, 10}}}},
                   {"Pages", {{"Skip", "page 12"}}}});
  Library library;
  const DriveLibrary read = library.hold("maker-drive.json", document).read();
  EXPECT_EQ(read.find({0x1A2, 515, 2, 0}), nullptr);
  EXPECT_EQ(read.find({0x1A2, 515, 0x100, 0}), nullptr);
  const DriveDescription* drive = read.find({0x1A2, 515, 0xFF, 0});
  ASSERT_NE(drive, nullptr);
  EXPECT_EQ(drive->refusal, "");
  EXPECT_EQ(read.find_name("maker-drive"), drive);
  EXPECT_EQ(read.find_product(0x1A2, 515), drive);
  const auto& manners = drive->manners;
  ASSERT_EQ(manners.skip.size(), 2U);
  EXPECT_EQ(manners.skip[0].index, 0x6502);
  EXPECT_EQ(manners.skip[0].sub, std::nullopt);
  EXPECT_EQ(manners.skip[1].index, 0x60C2);
  EXPECT_EQ(manners.skip[1].sub, 2);
  EXPECT_EQ(manners.sdo_timeout, std::chrono::milliseconds(1250));
  EXPECT_EQ(manners.sdo_retries, 4);
  EXPECT_EQ(manners.boot_timeout, std::chrono::seconds(12));
  EXPECT_FALSE(manners.fixed_mapping);
  EXPECT_TRUE(manners.store_after_mapping);
  EXPECT_TRUE(manners.no_abort_connection);
  EXPECT_EQ(manners.no_heartbeat_consumer, "it goes on");
  EXPECT_TRUE(manners.quick_stop_inverted);
  EXPECT_TRUE(manners.homing_without_target_reached);
  EXPECT_EQ(manners.answer_delay, 3);
  EXPECT_FALSE(manners.node_guarding);
  EXPECT_EQ(manners.interpolation->index, -4);
  EXPECT_EQ(manners.interpolation->values, (std::vector<std::uint8_t>{5, 10}));
}

TEST(DriveLibraries, SayWhoIsGuarded) {
  json document = sound();
  document["NodeGuarding"] = true;
  Library library;
  const DriveLibrary read = library.hold("maker-drive.json", document).read();
  ASSERT_NE(read.find_name("maker-drive"), nullptr);
  EXPECT_EQ(read.find_name("maker-drive")->refusal, "");
  EXPECT_TRUE(read.find_name("maker-drive")->manners.node_guarding);
}

// Red when a mistake passes, or a message lacks file, key or what is allowed.
TEST(DriveLibraries, RefuseWhatIsWrongByFileKeyAndReason) {
  const auto with = [](const std::string& key, const json& value) {
    json document = sound();
    document[key] = value;
    return refusal(document);
  };
  EXPECT_EQ(refusal(sound()), "no error");
  EXPECT_THAT(with("SkipX", {"6502h"}),
              AllOf(HasSubstr("maker-drive.json: "), HasSubstr("unknown key \"SkipX\"; did you mean \"Skip\"")));
  EXPECT_THAT(with("Answer", true), HasSubstr("unknown key \"Answer\""));
  for (const int delay : {0, 9})
    EXPECT_THAT(with("AnswerDelay", delay), HasSubstr("allowed is an integer from 1 to 8"));
  EXPECT_EQ(with("SdoTimeout", 0), "maker-drive.json: /SdoTimeout is 0; allowed is a number from 0.01 to 60 (s)");
  EXPECT_THAT(with("SdoRetries", 2.5), HasSubstr("/SdoRetries is 2.5"));
  EXPECT_THAT(with("Skip", {"0x6502"}), HasSubstr("as in 60C2h or 60C2h:02"));
  EXPECT_THAT(with("Skip", {"1016h"}),
              HasSubstr("/Skip names 1016h; a drive without it is told by NoHeartbeatConsumer"));
  EXPECT_THAT(with("NoHeartbeatConsumer", true), HasSubstr("/NoHeartbeatConsumer is true"));
  EXPECT_THAT(with("InterpolationTimePeriod", {{"Values", {1}}}), HasSubstr("Index"));
  EXPECT_THAT(with("Pages", {{"Skip", "page 3"}}), HasSubstr("/Pages/Skip is of a key that is not given"));
  EXPECT_THAT(with("RevisionNumber", {{"Min", 8}, {"Max", 7}}), HasSubstr("no such drive"));
  json both = sound();
  both["FixedMapping"] = both["StoreAfterMapping"] = true;
  EXPECT_THAT(refusal(both), HasSubstr("/StoreAfterMapping and /FixedMapping are both true"));
  for (const char* needed : {"Name", "Manual", "Tried"}) {
    json less = sound();
    less.erase(needed);
    EXPECT_THAT(refusal(less), HasSubstr(needed));
  }
}

// Red when one wrong file keeps others from being read, or nobody hears of it.
TEST(DriveLibraries, KeepAWrongFileApart) {
  Library library;
  json other = sound();
  other["ProductCode"] = 516;
  json nobody = sound();
  nobody.erase("VendorId");
  const DriveLibrary read = library.hold("a.json", other)
                                .hold_text("b.json", "{\"Name\": ")
                                .hold("c.json", nobody)
                                .hold_text("d.json", "[]")
                                .hold("e.json", sound())
                                .hold_text("notes.txt", "no description")
                                .read();
  EXPECT_EQ(read.drives.size(), 2U);
  for (const DriveDescription& drive : read.drives) EXPECT_EQ(drive.refusal, "");
  ASSERT_EQ(read.unreadable.size(), 3U);
  EXPECT_THAT(read.unreadable[0], AllOf(HasSubstr(library.file("b.json")), HasSubstr("line 1, column")));
  EXPECT_THAT(read.unreadable[1], AllOf(HasSubstr(library.file("c.json")), HasSubstr("VendorId")));
  const auto checked = check(read);
  ASSERT_FALSE(checked);
  for (const char* file : {"b.json", "c.json", "d.json"}) EXPECT_THAT(checked.error().message, HasSubstr(file));
}

TEST(DriveLibraries, RefuseTwoFilesForOneDriveAndNameBoth) {
  Library library;
  json third = sound();
  third["RevisionNumber"] = {{"Min", 10}, {"Max", 20}};
  const DriveLibrary read = library.hold("a.json", sound()).hold("b.json", sound()).hold("c.json", third).read();
  for (const DriveDescription& drive : read.drives) {
    EXPECT_THAT(drive.refusal,
                AllOf(HasSubstr("are for the same drive (vendor 1A2h, product 203h)"), HasSubstr(drive.file)));
  }
}

TEST(DriveLibraries, OfAFolderThatIsNotThereSaySo) {
  const DriveLibrary read = read_drive_library("/no/such/folder");
  EXPECT_THAT(read.drives, IsEmpty());
  EXPECT_THAT(read.unreadable, ElementsAre("/no/such/folder: no drive is known: No such file or directory"));
  EXPECT_THAT(read_drive_library({}).unreadable, IsEmpty());
}

// Red when some text makes the reader throw, whatever it is for.
TEST(DriveLibraries, PutUpWithAnyText) {
  json document = sound();
  document.update(
      {{"RevisionNumber", {{"Min", 3}, {"Max", "FFh"}}}, {"Skip", {"6502h", "60C2h:02"}}, {"SdoTimeout", 1}});
  const std::string text = document.dump();
  for (unsigned seed = 0; seed < 500; ++seed) {
    std::mt19937 random(seed);
    std::string changed = text;
    for (int i = 0; i < 3; ++i) {
      const std::size_t at = random() % changed.size();
      const std::size_t from = random() % text.size();
      changed.replace(at, random() % 4, text.substr(from, random() % 12));
    }
    Library library;
    const DriveLibrary read = library.hold_text("x.json", changed).read();
    EXPECT_EQ(read.drives.size() + read.unreadable.size(), 1U) << "seed " << seed << ": " << changed;
  }
}

}  // namespace
}  // namespace rmac::gateway
