// Drives that are known: what the library says of one is how it is brought up, unless device.json says otherwise.
#include <gmock/gmock.h>

#include "unit/fieldbus/canopen/drives/known_drive.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using std::chrono::milliseconds;
using test::CanWire;
using test::description_of;
using test::KnownDrive;
using test::Numbers;
using test::Texts;
using test::VirtualDrive;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST_F(KnownDrive, IsFoundByItsIdentityAndSaidToBe) {
  fresh_drive();
  make_known(DriveManners(), {{"node", {1}}});
  ASSERT_EQ(start_error(), "it started");
  EXPECT_THAT(master_->start_notes(),
              ElementsAre("node 1 is treated as maker drive, by etc/drives/maker-drive.json (tried: never)"));
}

// Red when a description counts for drives that it is not for: each part of an identity that is another's.
TEST_F(KnownDrive, IsNoOtherDrive) {
  for (const int part : {0, 1, 2, 3}) {
    fresh_drive();
    DriveDescription other = description_of({.skip = {{0x6502, {}}}});
    if (part == 0) other.vendor_id = 0x102;
    if (part == 1) other.product_code = 0x202;
    if (part == 2) other.first_revision = 0x302;
    if (part == 3) other.last_revision = 0x300;
    make_known(DriveLibrary{{other}, {}}, {{"node", {1}}});
    ASSERT_EQ(start_error(), "it started");
    EXPECT_THAT(master_->start_notes(), IsEmpty()) << part;
  }
}

TEST_F(KnownDrive, MayHaveOneDescriptionForEachRange) {
  fresh_drive();
  DriveDescription old = description_of({}, "old.json"), present = description_of({}, "present.json");
  old.last_revision = 0x300;
  present.first_revision = present.last_revision = 0x301;
  make_known(DriveLibrary{{old, present}, {}}, {{"node", {1}}});
  ASSERT_EQ(start_error(), "it started");
  EXPECT_THAT(master_->start_notes(), ElementsAre(HasSubstr("by present.json")));
}

// Red when a drive is brought up in a way that nobody can vouch for.
TEST_F(KnownDrive, IsRefusedWithAFileThatIsWrong) {
  fresh_drive();
  DriveDescription wrong = description_of({});
  wrong.refusal = "maker-drive.json: /SdoTimeout is 0; allowed is a number from 0.01 to 60 (s)";
  make_known(DriveLibrary{{wrong}, {}}, {{"node", {1}}});
  EXPECT_EQ(start_error(),
            "node 1 (axis 0) cannot be taken: maker-drive.json: /SdoTimeout is 0; allowed is a number from 0.01 to 60 "
            "(s)");
  EXPECT_EQ(writes(0x1400), 0) << "it was written to all the same";
}

// Red when a machine that says who its drives are is refused only once their bus was reset.
TEST_F(KnownDrive, IsRefusedBeforeAnythingIsSentWhereDeviceJsonSaysWhoItIs) {
  DriveDescription wrong = description_of({});
  wrong.refusal = "wrong";
  const auto library = std::make_shared<DriveLibrary>(DriveLibrary{{wrong}, {}});
  const auto refusal = [&](const Numbers& numbers, const Texts& texts) {
    const auto config = read_canopen_config("can0", numbers, texts, kPeriodS, {}, library);
    return config ? "no error" : config.error().message;
  };
  const Numbers named{{"node", {1}}, {"vendor_id", {0x101}}, {"product_code", {0x201}}};
  EXPECT_EQ(refusal(named, {}), "CANopenInterface, bus can0: wrong");
  EXPECT_EQ(refusal(named, {{"drive", "none"}}), "no error");
  EXPECT_EQ(refusal({{"node", {1}}}, {{"drive", "maker-drive"}}), "CANopenInterface, bus can0: wrong");
  EXPECT_EQ(refusal({{"node", {1}}}, {}), "no error");
}

TEST_F(KnownDrive, IsRefusedWithTwoFilesThatAreBothNamed) {
  fresh_drive();
  DriveLibrary library{{description_of({}, "a.json"), description_of({}, "b.json")}, {}};
  library.refuse_doubles();
  make_known(library, {{"node", {1}}});
  EXPECT_EQ(start_error(),
            "node 1 (axis 0) cannot be taken: a.json and b.json are for the same drive (vendor 101h, product 201h); "
            "remove one, or give them revisions apart");
}

// Red when a file that is not for any drive of the bus keeps the machine from starting, or is not told of.
TEST_F(KnownDrive, DoesNotCareForFilesOfOthersThatAreWrong) {
  fresh_drive();
  DriveDescription wrong = description_of({});
  wrong.product_code = 0x999;
  wrong.refusal = "wrong";
  make_known(DriveLibrary{{wrong}, {"x.json: line 1, column 1 is not JSON"}}, {{"node", {1}}});
  ASSERT_EQ(start_error(), "it started");
  EXPECT_THAT(master_->start_notes(), ElementsAre("x.json: line 1, column 1 is not JSON"));
}

// Red when an object that is left alone is read or written: a drive that hangs itself up on it would not come up.
// Red when a drive whose answers are old is taken for one that measures at SYNC, or device.json does not go before.
TEST_F(KnownDrive, SaysHowOldItsAnswersAre) {
  fresh_drive();
  make({{"node", {1}}});
  start();
  EXPECT_EQ(master_->answer_delay(0), 1);
  fresh_drive();
  make_known(DriveManners{.answer_delay = 3}, {{"node", {1}}});
  start();
  EXPECT_EQ(master_->answer_delay(0), 3);
  fresh_drive();
  make_known(DriveManners{.answer_delay = 3}, {{"node", {1}}, {"answer_delay", {2}}});
  start();
  EXPECT_EQ(master_->answer_delay(0), 2);
  for (const double wrong : {0.0, 9.0, 1.5}) {
    const auto config = canopen::read_canopen_config("can0", {{"node", {1}}, {"answer_delay", {wrong}}}, {}, kPeriodS);
    ASSERT_FALSE(config) << wrong;
    EXPECT_THAT(config.error().message, HasSubstr("answer_delay"));
  }
}

TEST_F(KnownDrive, IsNotAskedForWhatItDoesNotStand) {
  const std::vector<SkippedObject> skipped{{0x6502, {}}, {0x60C2, {}}, {0x1402, 1}, {0x1803, {}},
                                           {0x608F, 1},  {0x6091, {}}, {0x603F, {}}};
  for (const bool known : {false, true}) {
    VirtualDrive& drive = fresh_drive();
    drive.set_bytes({0x60C2, 1}, {1});
    drive.set_bytes({0x60C2, 2}, {0xFD});
    std::map<std::uint32_t, int> asked;
    wire_.listen = [&](const CanFrame& frame) {
      if (frame.id != 0x601) return;
      const std::uint32_t low = frame.data[1], high = frame.data[2], sub = frame.data[3];
      ++asked[high << 16U | low << 8U | sub];
    };
    known ? make_known({.skip = skipped}, {{"node", {1}}, {"mode", {8}}}) : make({{"node", {1}}, {"mode", {8}}});
    ASSERT_EQ(start_error(), "it started");
    constexpr std::array<std::uint32_t, 8> kObjects{0x650200, 0x60C201, 0x60C202, 0x140201,
                                                    0x180301, 0x608F01, 0x609101, 0x603F00};
    for (const std::uint32_t object : kObjects) {
      EXPECT_EQ(asked.contains(object), !known) << std::hex << object;
    }
    EXPECT_TRUE(asked.contains(0x608F02) && asked.contains(0x140101)) << "more is left alone than was said";
    wire_.listen = nullptr;
  }
}

TEST_F(KnownDrive, IsWrittenWhatDeviceJsonSetsAllTheSame) {
  fresh_drive();
  make_known({.skip = {{0x6085, {}}}}, {{"node", {1}}}, {{"setup", "6085:00/32=70000"}});
  ASSERT_EQ(start_error(), "it started");
  EXPECT_EQ(writes(0x6085), 1);
}

TEST_F(KnownDrive, MayLackTheObjectsThatStopItWhenTheMasterDies) {
  VirtualDrive& drive = fresh_drive();
  drive.remove(0x6007);
  drive.remove(0x1016);
  make({{"node", {1}}});
  EXPECT_THAT(start_error(), HasSubstr("for it to stop when the master dies"));
  make_known({.no_abort_connection = true, .no_heartbeat_consumer = "it goes on as it was told last"}, {{"node", {1}}});
  ASSERT_EQ(start_error(), "it started");
  EXPECT_THAT(master_->start_notes(),
              ElementsAre(HasSubstr("is treated as"),
                          "node 1 does not watch its master (it has no 1016h). When the master dies: it goes on as it "
                          "was told last",
                          HasSubstr("node 1 has no 6007h")));
}

// Red when the library goes before device.json.
TEST_F(KnownDrive, IsToldWhatDeviceJsonGives) {
  VirtualDrive& drive = fresh_drive();
  drive.sdo_time = milliseconds(700);
  const DriveManners manners{.sdo_timeout = milliseconds(1000), .no_abort_connection = true};
  make_known(manners, {{"node", {1}}, {"product_code", {0x201}}, {"vendor_id", {0x101}}, {"sdo_timeout_ms", {100}}});
  EXPECT_THAT(start_error(), HasSubstr("did not answer when 1000h:00 was read"));
  make_known(manners, {{"node", {1}}, {"product_code", {0x201}}, {"vendor_id", {0x101}}, {"abort_connection", {2}}});
  ASSERT_EQ(start_error(), "it started");
  EXPECT_EQ(drive.value(0x6007, 0), 2U);
}

// Red when a drive that is slow from its first answer on is waited for only once it told who it is.
TEST_F(KnownDrive, IsWaitedForFromItsBootOnWhereDeviceJsonSaysWhoItIs) {
  const DriveManners slow{.sdo_timeout = milliseconds(1000), .boot_timeout = milliseconds(9000)};
  for (const Texts& texts : {Texts(), Texts{{"drive", "maker-drive"}}}) {
    VirtualDrive& drive = fresh_drive();
    drive.sdo_time = milliseconds(700);
    drive.boot_time = milliseconds(8000);
    const Numbers by_identity{{"node", {1}}, {"product_code", {0x201}}, {"vendor_id", {0x101}}};
    make_known(slow, texts.empty() ? by_identity : Numbers{{"node", {1}}}, texts);
    EXPECT_EQ(start_error(), "it started") << (texts.empty() ? "by identity" : "by name");
  }
  VirtualDrive& drive = fresh_drive();
  drive.boot_time = milliseconds(8000);
  make_known(slow, {{"node", {1}}});
  EXPECT_THAT(start_error(), HasSubstr("no boot-up message in 5 s"));
}

TEST_F(KnownDrive, IsAskedAsOftenAsItsDescriptionSays) {
  for (const int retries : {0, 2, 6}) {
    fresh_drive();
    int answers = 0;
    wire_.gateway = [&](const CanFrame& frame) {
      const bool lost = frame.id == 0x581 && ++answers > 20;
      return lost ? std::vector<CanWire::Time>() : std::vector<CanWire::Time>{{}};
    };
    int asked = 0;
    std::array<std::uint8_t, 64> last{};
    wire_.listen = [&](const CanFrame& frame) {
      if (frame.id != 0x601 || frame.data[0] == 0x80) return;
      asked = std::equal(frame.data.begin(), frame.data.begin() + 8, last.begin()) ? asked + 1 : 1;
      std::copy_n(frame.data.begin(), 8, last.begin());
    };
    make_known({.sdo_retries = retries}, {{"node", {1}}});
    EXPECT_THAT(start_error(), HasSubstr("did not answer"));
    EXPECT_EQ(asked, 1 + retries);
    wire_.gateway = nullptr;
    wire_.listen = nullptr;
  }
}

class StoredMapping : public KnownDrive {
 protected:
  VirtualDrive& storing_drive() {
    VirtualDrive& drive = fresh_drive();
    drive.set_bytes({0x1010, 1}, {1, 0, 0, 0});
    drive.stores = true;
    drive.maps_by_memory = true;
    return drive;
  }
};

// Red when the mapping is only written: the drive goes on with the one that it has stored.
TEST_F(StoredMapping, HoldsAfterItWasStored) {
  storing_drive();
  make({{"node", {1}}});
  ASSERT_EQ(start_error(), "it started");
  cycles(20, DriveWish::Off);
  EXPECT_GT(master_->counters().short_answers, 0U) << "this drive has no need of what is tried here";
  storing_drive();
  make_known({.store_after_mapping = true}, {{"node", {1}}});
  ASSERT_EQ(start_error(), "it started");
  enable_all();
  EXPECT_EQ(writes(0x1010), 1);
}

// Red when each start wears the memory.
TEST_F(StoredMapping, IsStoredOnlyWhereItIsAnother) {
  VirtualDrive& drive = storing_drive();
  make_known({.store_after_mapping = true}, {{"node", {1}}});
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(start_error(), "it started");
    EXPECT_EQ(writes(0x1010), 1) << "start " << i;
    cycle();
    drive.power_on(wire_.now());  // also when it comes back
    for (int k = 0; k < 2000 && writes(0x1010) == 1; ++k) cycle();
    master_->stop();
  }
  EXPECT_EQ(writes(0x1A00), 5) << "no entries, three of them, their number, once";
}

// Red when a drive that keeps nothing has it stored again and again, by a start or by the cycle.
TEST_F(StoredMapping, IsStoredOnceWhereItIsNotKept) {
  VirtualDrive& drive = storing_drive();
  make_known({.store_after_mapping = true}, {{"node", {1}}});
  ASSERT_EQ(start_error(), "it started");
  cycle();
  drive.stores = false;
  drive.set_bytes({0x1A00, 0}, {1});
  drive.power_on(wire_.now());
  for (int k = 0; k < 30000; ++k) cycle();
  EXPECT_LE(writes(0x1010), 2);
  EXPECT_FALSE(feedback_[0].online);
  master_->stop();
  EXPECT_EQ(
      start_error(),
      "node 1 (axis 0) does not support what is asked of it: 1A00h:00 is 1h, and 3h is needed in it; it is needed "
      "to be kept, and was not though it was stored (StoreAfterMapping). It is treated as "
      "etc/drives/maker-drive.json says");
}

class NarrowInterpolation : public KnownDrive {
 protected:
  /// What it is told for a cycle of `period_ms`, or why it is refused.
  [[nodiscard]] std::string told(double period_ms, double mode, const InterpolationTimes& times,
                                 const Texts& texts = {}) {
    VirtualDrive& drive = fresh_drive();
    drive.set_bytes({0x60C2, 1}, {77});
    drive.set_bytes({0x60C2, 2}, {0xFD});
    auto config = read_canopen_config(
        "can0", {{"node", {1}}, {"mode", {mode}}}, texts, period_ms * 1e-3, {},
        std::make_shared<DriveLibrary>(DriveLibrary{{description_of({.interpolation = times})}, {}}));
    EXPECT_TRUE(config.has_value());
    make_from(*config);
    const std::string error = start_error();
    if (error != "it started") return error;
    return std::to_string(drive.value(0x60C2, 1)) + " E" +
           std::to_string(static_cast<int>(drive.value(0x60C2, 2)) - 256);
  }
};

TEST_F(NarrowInterpolation, IsToldAsTheDriveTakesIt) {
  EXPECT_EQ(told(10, 8, {-3, {}}), "10 E-3");
  EXPECT_EQ(told(10, 8, {-4, {}}), "100 E-4");
  EXPECT_EQ(told(4, 8, {-3, {1, 2, 4, 8}}), "4 E-3");
  EXPECT_EQ(told(2.5, 8, {-4, {10, 25}}), "25 E-4");
}

// Red when a drive interpolates over another time than its cycle, or one that does not interpolate is refused.
TEST_F(NarrowInterpolation, RefusesACycleThatIsNoneOfThem) {
  const std::string refused =
      "node 1 (axis 0) cannot be taken: the cycle (period_s) is none of the times that it takes in 60C2h "
      "(InterpolationTimePeriod)";
  EXPECT_EQ(told(3, 8, {-3, {1, 2, 4, 8}}), refused);
  EXPECT_EQ(told(2.5, 8, {-3, {}}), refused);
  EXPECT_EQ(told(3, 9, {-3, {1, 2, 4, 8}}), "77 E-3") << "it does not interpolate";
  EXPECT_EQ(told(3, 8, {-3, {1, 2, 4, 8}}, {{"setup", "60C2:01/8=3"}}), "3 E-3") << "device.json goes before";
}

TEST_F(KnownDrive, CanBeTreatedAsAnyOther) {
  fresh_drive();
  make_known({.skip = {{0x6502, {}}}}, {{"node", {1}}}, {{"drive", "none"}});
  ASSERT_EQ(start_error(), "it started");
  EXPECT_THAT(master_->start_notes(), IsEmpty());
}

TEST_F(KnownDrive, IsNotNamedByWhatIsNotThere) {
  const auto library = std::make_shared<DriveLibrary>(DriveLibrary{{description_of({})}, {}});
  const auto refused = [&](const std::string& name) {
    const auto config = read_canopen_config("can0", {{"node", {1}}}, {{"drive", name}}, kPeriodS, {}, library);
    return config ? "no error" : config.error().message;
  };
  EXPECT_EQ(refused("maker-drive"), "no error");
  EXPECT_EQ(refused("other"),
            "CANopenInterface, bus can0: drive is \"other\" for node 1, and there is no such description; leave it out "
            "to have it found by the node's identity (1018h), or say \"none\"");
}

TEST(DriveManners, RefuseToSkipWhatIsNeeded) {
  const auto refusal = [](std::uint16_t index) {
    const auto checked = check(DriveManners{.skip = {{index, {}}}});
    return checked ? "no error" : checked.error().message;
  };
  // Who it is, how it is watched and stored, its PDOs, its words, its mode and where it is.
  constexpr std::array<std::uint16_t, 14> kNeeded{0x1000, 0x1018, 0x1017, 0x100C, 0x100D, 0x1010, 0x1400,
                                                  0x1440, 0x1800, 0x1840, 0x6040, 0x6041, 0x6060, 0x6064};
  for (const std::uint16_t needed : kNeeded) {
    EXPECT_NE(refusal(needed), "no error") << std::hex << needed;
  }
  EXPECT_THAT(refusal(0x1016), HasSubstr("NoHeartbeatConsumer"));
  EXPECT_THAT(refusal(0x6007), HasSubstr("NoAbortConnection"));
  EXPECT_THAT(refusal(0x1A00), HasSubstr("FixedMapping"));
  constexpr std::array<std::uint16_t, 9> kFree{0x1401, 0x1803, 0x6502, 0x60C2, 0x603F, 0x608F, 0x6061, 0x6065, 0x2000};
  for (const std::uint16_t free : kFree) {
    EXPECT_EQ(refusal(free), "no error") << std::hex << free;
  }
  EXPECT_FALSE(check(DriveManners{.fixed_mapping = true, .store_after_mapping = true}).has_value());
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
