// Drives whose mapping or identifiers cannot be changed.
#include <gmock/gmock.h>

#include "unit/fieldbus/canopen/drives/known_drive.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using test::KnownDrive;
using test::Texts;
using test::VirtualDrive;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::uint32_t kReadOnly = 0x06010002;

class FixedMapping : public KnownDrive {
 protected:
  VirtualDrive& fixed_drive() {
    VirtualDrive& drive = fresh_drive();
    const auto fix = [&](std::uint16_t contents, std::initializer_list<std::uint32_t> entries) {
      std::uint8_t sub = 0;
      for (const std::uint32_t entry : entries) {
        drive.set_bytes({contents, ++sub},
                        {static_cast<std::uint8_t>(entry), static_cast<std::uint8_t>(entry >> 8),
                         static_cast<std::uint8_t>(entry >> 16), static_cast<std::uint8_t>(entry >> 24)});
      }
      drive.set_bytes({contents, 0}, {sub});
      for (std::uint8_t i = 0; i <= 8; ++i) drive.refuse_writing({contents, i}, kReadOnly);
    };
    fix(0x1600, {0x60400010, 0x607A0020});
    fix(0x1A00, {0x60410010, 0x60640020});
    return drive;
  }
};

TEST_F(FixedMapping, IsTakenAsItIs) {
  fixed_drive();
  make_known({.fixed_mapping = true}, {{"node", {1}}, {"mode", {8}}}, {{"tpdo", "6041:00/16 6064:00/32"}});
  ASSERT_EQ(start_error(), "it started");
  enable_all();
}

// Red when words land in other objects than device.json says: each way in which a mapping may differ.
TEST_F(FixedMapping, IsRefusedWhereItIsNotWhatIsWanted) {
  const auto refusal = [&](double mode, const Texts& texts) {
    fixed_drive();
    make_known({.fixed_mapping = true}, {{"node", {1}}, {"mode", {mode}}}, texts);
    return start_error();
  };
  const std::string why =
      "; it is needed because its mapping is fixed (FixedMapping): rpdo and tpdo must say what it has. It is treated "
      "as etc/drives/maker-drive.json says";
  EXPECT_EQ(refusal(8, {}),
            "node 1 (axis 0) does not support what is asked of it: 1A00h:00 is 2h, and 3h is needed in it" + why);
  EXPECT_EQ(
      refusal(9, {{"tpdo", "6041:00/16 6064:00/32"}}),
      "node 1 (axis 0) does not support what is asked of it: 1600h:02 is 607A0020h, and 60FF0020h is needed in it" +
          why);
  EXPECT_THAT(refusal(8, {{"tpdo", "6064:00/32 6041:00/16"}}), HasSubstr("1A00h:01 is 60410010h"));
}

// Red when a drive is refused that has what is wanted, or its constants are not told of.
TEST_F(FixedMapping, OfADriveThatIsNotKnownIsReadBack) {
  fixed_drive();
  make({{"node", {1}}, {"mode", {8}}}, {{"tpdo", "6041:00/16 6064:00/32"}});
  ASSERT_EQ(start_error(), "it started");
  EXPECT_THAT(master_->start_notes(),
              ElementsAre("node 1 (axis 0) keeps 1600h as it is, which will do: attempt to write a read-only object "
                          "(06010002h)",
                          "node 1 (axis 0) keeps 1A00h as it is, which will do: attempt to write a read-only object "
                          "(06010002h)"));
  cycle();
  enable_all();
  commands_[0].target_position_counts = 4711;
  cycles(4, DriveWish::Operational);
  EXPECT_EQ(feedback_[0].position_counts, 4711);
}

// Red when words land in other objects than device.json says.
TEST_F(FixedMapping, OfADriveThatIsNotKnownIsRefusedWhereItIsNotWhatIsWanted) {
  fixed_drive();
  make({{"node", {1}}, {"mode", {9}}}, {{"tpdo", "6041:00/16 6064:00/32"}});
  EXPECT_EQ(start_error(),
            "node 1 (axis 0) refused 60FF0020h for 1600h:02: attempt to write a read-only object (06010002h), and has "
            "607A0020h there; it is needed to send it its setpoints (rpdo)");
}

class FixedIdentifiers : public KnownDrive {
 protected:
  /// 1400h or 1800h with an identifier that cannot be changed, refused by `code`.
  VirtualDrive& fixed_drive(std::uint16_t communication, std::uint32_t cob_id, std::uint32_t code) {
    VirtualDrive& drive = fresh_drive();
    std::vector<std::uint8_t> bytes;
    for (unsigned bit = 0; bit < 32; bit += 8) bytes.push_back(static_cast<std::uint8_t>(cob_id >> bit));
    drive.set_bytes({communication, 1}, bytes);
    drive.refuse_writing({communication, 1}, code);
    for (const int index : {0x1600, 0x1A00}) {  // a mapping changes only while its PDO is not valid
      if (index != communication + 0x200) continue;
      drive.set_bytes({static_cast<std::uint16_t>(index), 0}, {2});
      const bool setpoints = index == 0x1600;
      drive.set_bytes({static_cast<std::uint16_t>(index), 1},
                      {0x10, 0, setpoints ? std::uint8_t{0x40} : std::uint8_t{0x41}, 0x60});
      drive.set_bytes({static_cast<std::uint16_t>(index), 2},
                      {0x20, 0, setpoints ? std::uint8_t{0x7A} : std::uint8_t{0x64}, 0x60});
    }
    return drive;
  }
  std::string start_with_it() {
    make({{"node", {1}}, {"mode", {8}}}, {{"tpdo", "6041:00/16 6064:00/32"}});
    return start_error();
  }
};

// Red when a constant that is as wanted is refused, whatever the abort code, or with a remote request that nobody
// makes.
TEST_F(FixedIdentifiers, AreTakenWhereTheyAreWhatIsWanted) {
  for (const std::uint32_t code : {0x06010002U, 0x06090030U, 0x08000022U, 0x08000000U}) {
    for (const auto& [communication, cob_id] :
         {std::pair(0x1400, 0x201U), std::pair(0x1800, 0x181U), std::pair(0x1800, 0x40000181U)}) {
      fixed_drive(static_cast<std::uint16_t>(communication), cob_id, code);
      ASSERT_EQ(start_with_it(), "it started") << communication << ", " << code;
      ASSERT_THAT(master_->start_notes().at(0), HasSubstr(communication == 0x1400 ? "keeps 1400h" : "keeps 1800h"));
      cycle();
      enable_all();
    }
  }
}

// Red when a drive is taken that listens to another identifier, or to none.
TEST_F(FixedIdentifiers, AreRefusedWhereTheyAreNotWhatIsWanted) {
  for (const std::uint32_t cob_id : {0x205U, 0x80000201U, 0x20000201U}) {
    fixed_drive(0x1400, cob_id, 0x06010002);
    ASSERT_THAT(start_with_it(), HasSubstr("refused 80000201h for 1400h:01: attempt to write a read-only object "
                                           "(06010002h), and has"))
        << cob_id;
  }
}

// Red when a drive is taken that acts on its setpoints as they come, or answers otherwise than at each SYNC.
TEST_F(FixedIdentifiers, NorATransmissionTypeThatIsNotEverySync) {
  for (const int type : {0x00, 0x01, 0xF0, 0xFE, 0xFF}) {
    for (const std::uint16_t communication : {std::uint16_t{0x1400}, std::uint16_t{0x1800}}) {
      VirtualDrive& drive = fresh_drive();
      drive.set_bytes({communication, 2}, {static_cast<std::uint8_t>(type)});
      drive.refuse_writing({communication, 2}, 0x06010002);
      const std::string started = start_with_it();
      if (type == 1) {
        ASSERT_EQ(started, "it started");
        enable_all();
      } else {
        ASSERT_THAT(started,
                    HasSubstr(communication == 0x1400 ? "refused 1h for 1400h:02" : "refused 1h for 1800h:02"));
      }
    }
  }
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
