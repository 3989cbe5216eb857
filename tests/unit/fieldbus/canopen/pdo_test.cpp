#include "canopen/pdo.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace rmac::fieldbus::canopen {
namespace {

AxisConfig axis_of(std::vector<MappedObject> setpoints, std::vector<MappedObject> answers = {}) {
  AxisConfig axis;
  axis.node = 5;
  axis.setpoints = std::move(setpoints);
  axis.answers = std::move(answers);
  return axis;
}

/// The number of a frame's bytes from `at` on, the least significant first (CiA 301, 7.1.4).
std::uint32_t number_in(const CanFrame& frame, std::size_t at, unsigned bits) {
  std::uint32_t number = 0;
  for (unsigned i = 0; i < bits / 8; ++i) number |= std::uint32_t{frame.data.at(at + i)} << (8 * i);
  return number;
}
CanFrame frame_of(std::uint64_t number, std::uint8_t size) {
  CanFrame frame{.id = 0x185, .size = size};
  for (std::uint8_t i = 0; i < size; ++i) frame.data.at(i) = static_cast<std::uint8_t>(number >> (8 * i));
  return frame;
}
constexpr std::uint32_t mask_of(unsigned bits) {
  return bits == 32 ? 0xFFFFFFFF : (1U << bits) - 1;
}

// Red when a word goes under the object of another, or its bytes the other way round.
TEST(Setpoints, StandInTheirObjectsOneBehindTheOther) {
  std::mt19937 random(301);
  for (int run = 0; run < 200; ++run) {
    DriveCommand command;
    command.controlword = static_cast<std::uint16_t>(random());
    command.mode = static_cast<DriveMode>(random() % 11);
    command.target_torque_permille = static_cast<std::int16_t>(random());
    command.target_position_counts = static_cast<std::int32_t>(random());
    command.target_velocity_rpm = static_cast<std::int32_t>(random());
    command.velocity_offset_rpm = static_cast<std::int32_t>(random());
    command.torque_offset_permille = static_cast<std::int16_t>(random());
    command.touch_probe = static_cast<std::uint16_t>(random());
    const auto unsigned_of = [](double number) {
      return static_cast<std::uint32_t>(static_cast<std::int64_t>(number));
    };
    const std::vector<std::pair<MappedObject, std::uint32_t>> words{
        {{{0x6040, 0}, 16}, command.controlword},
        {{{0x6060, 0}, 8}, static_cast<std::uint32_t>(command.mode)},
        {{{0x6071, 0}, 16}, unsigned_of(command.target_torque_permille)},
        {{{0x607A, 0}, 32}, unsigned_of(command.target_position_counts)},
        {{{0x60C1, 1}, 32}, unsigned_of(command.target_position_counts)},
        {{{0x60FF, 0}, 32}, unsigned_of(command.target_velocity_rpm)},
        {{{0x60B1, 0}, 32}, unsigned_of(command.velocity_offset_rpm)},
        {{{0x60B2, 0}, 16}, unsigned_of(command.torque_offset_permille)},
        {{{0x60B8, 0}, 16}, command.touch_probe},
        {{{0x0005, 0}, 8}, 0},
        {{{0x0006, 0}, 16}, 0},
        {{{0x0007, 0}, 32}, 0}};
    for (const auto& [first, one] : words) {
      for (const auto& [second, other] : words) {
        const AxisConfig axis = axis_of({first, second});
        const CanFrame frame = pack_setpoints(axis, command);
        EXPECT_EQ(frame.id, 0x205);
        ASSERT_EQ(frame.size, (first.bits + second.bits) / 8);
        ASSERT_EQ(number_in(frame, 0, first.bits), one & mask_of(first.bits)) << to_string(first.object);
        ASSERT_EQ(number_in(frame, first.bits / 8, second.bits), other & mask_of(second.bits))
            << to_string(second.object);
      }
    }
  }
}

TEST(Setpoints, OfVelocityAreInTheDrivesUnitsRoundedAndBounded) {
  for (const MappedObject object : {MappedObject{{0x60FF, 0}, 32}, MappedObject{{0x60B1, 0}, 32}}) {
    AxisConfig axis = axis_of({object});
    axis.velocity_units_per_rpm = 2.5;
    const auto sent = [&](double rpm) {
      DriveCommand command;
      (object.object.index == 0x60FF ? command.target_velocity_rpm : command.velocity_offset_rpm) = rpm;
      return static_cast<std::int32_t>(number_in(pack_setpoints(axis, command), 0, 32));
    };
    EXPECT_EQ(sent(4), 10);
    EXPECT_EQ(sent(-4), -10);
    EXPECT_EQ(sent(0.3), 1) << "0.75 is nearer to 1";
    EXPECT_EQ(sent(-0.3), -1);
    EXPECT_EQ(sent(1e9), 2147483647) << "and not what is left of it";
    EXPECT_EQ(sent(-1e9), -2147483647 - 1);
    EXPECT_EQ(sent(2147483647 / 2.5), 2147483647);
    EXPECT_EQ(sent(-2147483648.0 / 2.5), -2147483647 - 1);
    EXPECT_EQ(sent(2147483646 / 2.5), 2147483646);
  }
}

TEST(Setpoints, OfASecondPdoHaveItsIdentifier) {
  AxisConfig axis = axis_of({{{0x6040, 0}, 16}});
  axis.more_setpoints = {{{0x60B8, 0}, 16}};
  DriveCommand command;
  command.controlword = 0x0F;
  command.touch_probe = 0x1234;
  const CanFrame frame = pack_more_setpoints(axis, command);
  EXPECT_EQ(frame, (CanFrame{.id = 0x305, .size = 2, .data = {0x34, 0x12}}));
}

TEST(Setpoints, OfTwoAxesShareAFrameByTheirDummies) {
  DriveCommand first, second;
  first.controlword = 0x0F0F;
  second.controlword = 0xA5A5;
  CanFrame shared = pack_setpoints(axis_of({{{0x6040, 0}, 16}, {{0x0006, 0}, 16}}), first);
  add_setpoints(shared, pack_setpoints(axis_of({{{0x0006, 0}, 16}, {{0x6040, 0}, 16}}), second));
  EXPECT_EQ(shared, (CanFrame{.id = 0x205, .size = 4, .data = {0x0F, 0x0F, 0xA5, 0xA5}}));
}

/// An object of answers, and the word of the feedback that it is.
struct Told {
  MappedObject object;
  std::function<std::int64_t(const DriveFeedback&)> word;
  bool has_sign;
};
const std::vector<Told>& all_told() {
  static const std::vector<Told> kTold{
      {{{0x6041, 0}, 16}, [](const DriveFeedback& told) { return std::int64_t{told.statusword}; }, false},
      {{{0x603F, 0}, 16}, [](const DriveFeedback& told) { return std::int64_t{told.error_code}; }, false},
      {{{0x6061, 0}, 8}, [](const DriveFeedback& told) { return static_cast<std::int64_t>(told.mode); }, true},
      {{{0x6064, 0}, 32}, [](const DriveFeedback& told) { return std::int64_t{told.position_counts}; }, true},
      {{{0x606C, 0}, 32}, [](const DriveFeedback& told) { return std::int64_t{told.velocity_rpm}; }, true},
      {{{0x6077, 0}, 16}, [](const DriveFeedback& told) { return std::int64_t{told.torque_permille}; }, true},
      {{{0x60FD, 0}, 32}, [](const DriveFeedback& told) { return std::int64_t{told.inputs}; }, false},
      {{{0x60B9, 0}, 16}, [](const DriveFeedback& told) { return std::int64_t{told.touch_probe}; }, false},
      {{{0x60BA, 0}, 32}, [](const DriveFeedback& told) { return std::int64_t{told.latched_counts[0]}; }, true},
      {{{0x60BB, 0}, 32}, [](const DriveFeedback& told) { return std::int64_t{told.latched_counts[1]}; }, true},
      {{{0x60BC, 0}, 32}, [](const DriveFeedback& told) { return std::int64_t{told.latched_counts[2]}; }, true},
      {{{0x60BD, 0}, 32}, [](const DriveFeedback& told) { return std::int64_t{told.latched_counts[3]}; }, true}};
  return kTold;
}
std::int64_t meant(std::uint32_t number, unsigned bits, bool has_sign) {
  const std::int64_t cut = number & mask_of(bits);
  return has_sign && cut >> (bits - 1) != 0 ? cut - (std::int64_t{1} << bits) : cut;
}

// Red when a word is taken for another, loses its sign, or takes a byte of its neighbour.
TEST(Answers, AreTakenFromTheirObjectsAndNothingElseChanges) {
  std::mt19937 random(402);
  for (int run = 0; run < 200; ++run) {
    for (const Told& first : all_told()) {
      for (const Told& second : all_told()) {
        if (first.object == second.object) continue;
        const std::uint32_t one = static_cast<std::uint32_t>(random()), other = static_cast<std::uint32_t>(random());
        const unsigned bits = first.object.bits;
        const std::uint64_t number = (one & mask_of(bits)) | std::uint64_t{other} << bits;
        const AxisConfig axis = axis_of({}, {first.object, second.object});
        DriveFeedback told;
        const auto size = static_cast<std::uint8_t>((bits + second.object.bits) / 8);
        ASSERT_TRUE(unpack_answers(axis, axis.answers, frame_of(number, size), told));
        for (const Told& any : all_told()) {
          const std::int64_t expected = any.object == first.object ? meant(one, bits, first.has_sign)
                                        : any.object == second.object
                                            ? meant(other, second.object.bits, second.has_sign)
                                            : 0;
          ASSERT_EQ(any.word(told), expected) << to_string(any.object.object) << " of " << std::hex << number;
        }
        EXPECT_FALSE(told.sensor_valid);
      }
    }
  }
}

TEST(Answers, OfVelocityAreInRevolutionsRounded) {
  AxisConfig axis = axis_of({}, {{{0x606C, 0}, 32}});
  axis.velocity_units_per_rpm = 4;
  DriveFeedback told;
  for (const auto& [units, rpm] : {std::pair{400, 100}, {-400, -100}, {3, 1}, {-3, -1}, {1, 0}}) {
    ASSERT_TRUE(unpack_answers(axis, axis.answers, frame_of(static_cast<std::uint32_t>(units), 4), told));
    EXPECT_EQ(told.velocity_rpm, rpm) << units;
  }
}

// Red when half a frame moves a machine.
TEST(Answers, OfAFrameThatIsTooShortChangeNothing) {
  const AxisConfig axis = axis_of({}, {{{0x6041, 0}, 16}, {{0x6064, 0}, 32}});
  for (std::uint8_t size = 0; size <= 8; ++size) {
    DriveFeedback told;
    told.statusword = 1;
    told.position_counts = 2;
    EXPECT_EQ(unpack_answers(axis, axis.answers, frame_of(0x1122334455667788, size), told), size >= 6) << int{size};
    EXPECT_EQ(told.statusword, size >= 6 ? 0x7788 : 1);
    EXPECT_EQ(told.position_counts, size >= 6 ? 0x33445566 : 2);
  }
}

TEST(Answers, HoldASensorsReadingWithItsSign) {
  for (const std::uint8_t bits : {std::uint8_t{8}, std::uint8_t{16}, std::uint8_t{24}, std::uint8_t{32}}) {
    AxisConfig axis = axis_of({}, {{{0x6041, 0}, 16}, {{0x6401, 1}, bits}});
    axis.sensor = axis.answers.back();
    const std::int64_t half = std::int64_t{1} << (bits - 1);
    for (const std::int64_t reading : {std::int64_t{0}, std::int64_t{1}, std::int64_t{-1}, half - 1, -half}) {
      DriveFeedback told;
      const std::uint64_t number = 0x0637 | (static_cast<std::uint64_t>(reading) & mask_of(bits)) << 16U;
      ASSERT_TRUE(unpack_answers(axis, axis.answers, frame_of(number, static_cast<std::uint8_t>(2 + bits / 8)), told));
      EXPECT_EQ(told.sensor_counts, reading) << int{bits} << " bits";
      EXPECT_TRUE(told.sensor_valid);
      EXPECT_EQ(told.statusword, 0x0637);
    }
  }
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
