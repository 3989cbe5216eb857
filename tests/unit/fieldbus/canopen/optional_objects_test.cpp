// What a drive may refuse: an object that is not needed, by whatever code, and what it is told about one that is.
#include <gmock/gmock.h>

#include <cstdio>

#include "unit/fieldbus/canopen/canopen_bench.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using test::CanopenBench;
using test::CanWire;
using test::Object;
using test::VirtualDrive;
using testing::HasSubstr;

/// Codes of CiA 301, table 22, and one of a maker's own.
constexpr std::array<std::uint32_t, 16> kAbortCodes{
    0x05040001, 0x06010000, 0x06010001, 0x06010002, 0x06020000, 0x06040043, 0x06040047, 0x06060000,
    0x06070010, 0x06090011, 0x06090030, 0x06090031, 0x08000000, 0x08000021, 0x08000022, 0x0F00FFC0};

constexpr bool says_absent(std::uint32_t code) {
  return code == 0x06020000 || code == 0x06090011;
}

std::string hex_of(std::uint32_t code) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "(%08Xh)", code);
  return text.data();
}

class OptionalObjects : public CanopenBench {
 protected:
  VirtualDrive& fresh_drive() {
    master_.reset();
    wire_ = CanWire();
    return wire_.add(1);
  }
  /// The only note, once the machine has started.
  [[nodiscard]] std::string note_of_start() {
    if (const auto started = master_->start(); !started) return "did not start: " + started.error().message;
    const auto notes = master_->start_notes();
    return notes.empty() ? "" : notes.size() == 1 ? notes[0] : std::to_string(notes.size()) + " notes";
  }
};

// Red when only "does not exist" passes: each of these refused a drive that does all that is asked of it.
TEST_F(OptionalObjects, MayBeRefusedByAnyCodeAndAreNoted) {
  struct Case {
    Object object;
    bool writes;
  };
  constexpr std::array kCases{Case{{0x60C2, 1}, true},  Case{{0x60C2, 2}, true},  Case{{0x6502, 0}, false},
                              Case{{0x608F, 1}, false}, Case{{0x6091, 2}, false}, Case{{0x1018, 4}, false},
                              Case{{0x1402, 1}, true},  Case{{0x1802, 1}, true},  Case{{0x1803, 1}, true},
                              Case{{0x603F, 0}, false}};
  for (const Case& one : kCases) {
    for (const std::uint32_t code : kAbortCodes) {
      VirtualDrive& drive = fresh_drive();
      one.writes ? drive.refuse_writing(one.object, code) : drive.refuse_reading(one.object, code);
      make({{"node", {1}}, {"mode", {1}}});
      const std::string note = note_of_start();
      const std::string named = to_string(one.object);
      if (says_absent(code)) {
        ASSERT_EQ(note, "") << named << " is not there, which is nothing to note";
      } else {
        ASSERT_THAT(note, HasSubstr("node 1 (axis 0) refused ")) << named;
        ASSERT_THAT(note, HasSubstr(named));
        ASSERT_THAT(note, HasSubstr(hex_of(code) + "; it is not needed, and was passed over"));
      }
      enable_all();
      ASSERT_FALSE(HasFailure()) << named;
    }
  }
}

TEST_F(OptionalObjects, MayBeRefusedInTorqueModeToo) {
  for (const std::uint32_t code : kAbortCodes) {
    VirtualDrive& drive = fresh_drive();
    drive.refuse_reading({0x6502, 0}, code);
    make({{"node", {1}}});
    ASSERT_EQ(start_error(), "it started");
    ASSERT_EQ(master_->start_notes().size(), says_absent(code) ? 0U : 1U);
  }
}

// Red when a drive that has a polarity and does not tell it is taken: it may run away.
TEST_F(OptionalObjects, AreNotThePolarityInTorqueModeWhereThereIsOne) {
  for (const std::uint32_t code : kAbortCodes) {
    fresh_drive().refuse_reading({0x607E, 0}, code);
    make({{"node", {1}}});
    if (says_absent(code)) {
      ASSERT_EQ(start_error(), "it started");
    } else {
      ASSERT_THAT(start_error(), HasSubstr("it is needed to know that its positions run with its torques"));
    }
  }
}

// Red when a drive whose second default PDO stays is taken: what is sent to its second axis, its first one takes.
TEST_F(OptionalObjects, AreNotPdosWhoseIdentifierIsAnotherAxiss) {
  for (const std::uint16_t pdo : {std::uint16_t{0x1401}, std::uint16_t{0x1801}}) {
    fresh_drive().refuse_writing({pdo, 1}, 0x06010002);
    make({{"node", {1, 1}}, {"axis_in_node", {0, 1}}});
    EXPECT_THAT(start_error(), HasSubstr("it is needed because another axis has its identifier"));
  }
}

TEST_F(OptionalObjects, ThatSendUncountedSaySo) {
  fresh_drive().refuse_writing({0x1802, 1}, 0x06010002);
  make({{"node", {1}}});
  EXPECT_EQ(
      note_of_start(),
      "node 1 (axis 0) refused C0000381h for 1802h:01: attempt to write a read-only object (06010002h); it is not "
      "needed, and was passed over. What that PDO sends is not counted in the load");
}

// Red when a refusal does not say what the object is for.
TEST_F(OptionalObjects, AreNotThoseWithoutWhichItDoesNotGo) {
  struct Case {
    Object object;
    const char* needed;
  };
  constexpr std::array kCases{Case{{0x1400, 1}, "to send it its setpoints (rpdo)"},
                              Case{{0x1600, 0}, "to send it its setpoints (rpdo)"},
                              Case{{0x1800, 2}, "to have its answers (tpdo)"},
                              Case{{0x1A00, 1}, "to have its answers (tpdo)"},
                              Case{{0x1016, 1}, "for it to stop when the master dies"},
                              Case{{0x1017, 0}, "to notice when it dies"},
                              Case{{0x6060, 0}, "to set its mode"},
                              Case{{0x6085, 0}, "because device.json sets it"}};
  for (const Case& one : kCases) {
    for (const std::uint32_t code : kAbortCodes) {
      VirtualDrive& drive = fresh_drive();
      drive.set_bytes({0x1400, 1}, {5, 2, 0, 0});  // one that is already as wanted is no matter
      drive.refuse_writing(one.object, code);
      make({{"node", {1}}}, {{"setup", "6085:00/32=70000"}});
      const std::string error = start_error();
      ASSERT_THAT(error, HasSubstr("node 1 (axis 0) refused "));
      ASSERT_THAT(error, HasSubstr(to_string(one.object)));
      ASSERT_THAT(error, HasSubstr(std::string("; it is needed ") + one.needed));
    }
  }
}

TEST_F(OptionalObjects, OfTheNodesIdentityAreNeededWhereTheyAreGiven) {
  fresh_drive().refuse_reading({0x1018, 4}, 0x06010000);
  make({{"node", {1}}, {"serial_number", {7}}});
  EXPECT_EQ(
      start_error(),
      "node 1 (axis 0) refused to tell 1018h:04: unsupported access to an object (06010000h); it is needed to know "
      "that it is the device that device.json names");
}

/// A drive whose interpolation time cannot be set: `value` times ten to `exponent`.
void fix_interpolation(VirtualDrive& drive, std::uint32_t value, std::int8_t exponent) {
  drive.set_bytes({0x60C2, 1}, {static_cast<std::uint8_t>(value)});
  drive.set_bytes({0x60C2, 2}, {static_cast<std::uint8_t>(exponent)});
  for (const auto sub : {std::uint8_t{1}, std::uint8_t{2}}) drive.refuse_writing({0x60C2, sub}, 0x06010002);
}

// Red when a drive that interpolates over another time than the cycle's is taken, or one that does over this is not.
TEST_F(OptionalObjects, HoldTheCycleWhereADriveInterpolatesOverIt) {
  for (const double mode : {7.0, 8.0}) {
    VirtualDrive& right = fresh_drive();
    right.set(0x60C1, 1, 0, 4);
    right.set_bytes({0x60C1, 1}, {0, 0, 0, 0});
    right.set_bytes({0x6502, 0}, {0xFF, 0x03, 0, 0});
    fix_interpolation(right, 1, -3);
    make({{"node", {1}}, {"mode", {mode}}});
    EXPECT_EQ(start_error(), "it started");
    EXPECT_EQ(master_->start_notes().size(), 2U);
    master_->stop();
    fix_interpolation(right, 2, -3);
    EXPECT_EQ(
        start_error(),
        "node 1 (axis 0) does not support what is asked of it: 60C2h:01 is 2h, and 1h is needed in it; it is needed "
        "to interpolate between setpoints over a cycle (modes 7 and 8)");
    right.refuse_reading({0x60C2, 1}, 0x08000000);
    EXPECT_EQ(start_error(), "it started") << "it has none that anybody could know of";
    master_->stop();
    right.allow({0x60C2, 1});
    right.allow({0x60C2, 2});
    EXPECT_EQ(start_error(), "it started");
    EXPECT_THAT(master_->start_notes(), testing::IsEmpty()) << "what it refused before is no news of this start";
  }
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
