#include "modbus/image.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "unit/fieldbus/modbus/modbus_wire.hpp"

namespace rmac::fieldbus::modbus {
namespace {

constexpr auto kRegisters = Table::HoldingRegisters;

std::size_t blocks_of(std::vector<Image::Wanted> wanted, std::size_t most_per_read) {
  return Image(std::move(wanted), most_per_read).blocks();
}

TEST(ModbusImage, ReadsTogetherWhatLiesSideBySide) {
  EXPECT_EQ(blocks_of({{kRegisters, 12, 2}, {kRegisters, 10, 2}}, 4), 1U) << "in whatever order they are named";
  EXPECT_EQ(blocks_of({{kRegisters, 10, 2}, {kRegisters, 13, 1}}, 4), 2U) << "what lies between was not asked for";
  EXPECT_EQ(blocks_of({{kRegisters, 10, 2}, {kRegisters, 12, 2}}, 3), 2U) << "so many it does not give at once";
  EXPECT_EQ(blocks_of({{kRegisters, 10, 2}, {Table::InputRegisters, 12, 1}}, 4), 2U)
      << "tables are asked each by itself";
  EXPECT_EQ(blocks_of({{kRegisters, 10, 4}, {kRegisters, 11, 1}}, 4), 1U) << "one inside another costs nothing";
  EXPECT_EQ(blocks_of({}, 4), 0U);
}

TEST(ModbusImage, FindsEachValueWhereItStands) {
  ModbusWire wire(ModbusPeer::Wire::Tcp);
  wire.bank.set(kRegisters, 10, 0x8001);
  wire.bank.set(kRegisters, 11, 0x1234);
  wire.bank.set(kRegisters, 12, 0xFFFE);
  wire.bank.set(kRegisters, 20, 0x5678);
  wire.bank.set(Table::Coils, 10, 1);
  Image image({{kRegisters, 10, 3}, {kRegisters, 20, 1}, {Table::Coils, 10, 1}}, 8);
  ASSERT_TRUE(image.read(*wire.client, 1));
  EXPECT_EQ(image.at(kRegisters, 10), 0x8001);
  EXPECT_EQ(image.at(kRegisters, 12), 0xFFFE);
  EXPECT_EQ(image.at(kRegisters, 20), 0x5678);
  EXPECT_EQ(image.at(Table::Coils, 10), 1);
  EXPECT_EQ(image.at(kRegisters, 9), 0) << "what was not read";
  EXPECT_EQ(image.at(kRegisters, 13), 0);
  EXPECT_EQ(image.at(Table::InputRegisters, 10), 0);

  EXPECT_EQ(image.raw({kRegisters, 10, 32}), 0x80011234U);
  EXPECT_EQ(image.raw({kRegisters, 10, 32, false, true}), 0x12348001U);
  EXPECT_EQ(image.raw({kRegisters, 10, 32, false, false, 0xFF00}), 0x1200U);
  EXPECT_EQ(image.number({kRegisters, 12}), 65534);
  EXPECT_EQ(image.number({kRegisters, 12, 16, true}), -2);
  EXPECT_EQ(image.number({kRegisters, 10, 32}), 2147553844.0);
  EXPECT_EQ(image.number({kRegisters, 10, 32, true}), -2147413452.0);
  const Place low_byte{kRegisters, 11, 16, false, false, 0xFF};
  EXPECT_TRUE(image.holds({low_byte, {7, 0x34}}));
  EXPECT_FALSE(image.holds({low_byte, {0x1234}}));
}

// Red when values are stamped with the time of a later question than their own: they would count as newer than they
// are.
TEST(ModbusImage, IsAsOldAsTheFirstOfItsQuestions) {
  ModbusWire wire(ModbusPeer::Wire::Tcp);
  wire.peer.respond([&wire](const Bytes& request) {
    wire.clock.pass(std::chrono::milliseconds(10));
    return wire.bank.answer(request);
  });
  Image image({{kRegisters, 10, 1}, {kRegisters, 20, 1}, {kRegisters, 30, 1}}, 8);
  const Clock::time_point begun = wire.client->now();
  const auto asked = image.read(*wire.client, 1);
  ASSERT_TRUE(asked);
  EXPECT_EQ(*asked, begun);
  EXPECT_EQ(wire.client->now(), begun + std::chrono::milliseconds(30));
}

// Red when the question that ends a doubt is as long as one that was asked before, whose answer may still come.
TEST(ModbusImage, EndsADoubtWithALongerQuestionThanAnyOfItsOwn) {
  ModbusWire wire(ModbusPeer::Wire::Rtu);
  const Image registers({{kRegisters, 10, 2}, {kRegisters, 20, 5}, {Table::InputRegisters, 0, 9}}, 8);
  ASSERT_TRUE(registers.resynchronise(*wire.client, 1));
  const auto asked = wire.peer.take_requests();
  ASSERT_EQ(asked.size(), 1U);
  EXPECT_EQ(asked[0], (Bytes{1, 4, 0, 0, 0, 10})) << "nine of the first table, and one more";
  const Image bits({{Table::Coils, 3, 9}}, 16);
  ASSERT_TRUE(bits.resynchronise(*wire.client, 2));
  const auto of_coils = wire.peer.take_requests();
  ASSERT_EQ(of_coils.size(), 1U);
  EXPECT_EQ(of_coils[0], (Bytes{2, 1, 0, 3, 0, 24})) << "bits by the byte: a question of nine is answered with two";
  const Image nothing({}, 8);
  EXPECT_TRUE(nothing.resynchronise(*wire.client, 3));
  EXPECT_TRUE(wire.peer.take_requests().empty());
}

TEST(ModbusWords, CarryANumberInItsPlace) {
  const Place word{kRegisters, 0}, signed_word{kRegisters, 0, 16, true}, two{kRegisters, 0, 32},
      low_first{kRegisters, 0, 32, false, true}, signed_two{kRegisters, 0, 32, true};
  EXPECT_EQ(to_words(word, 249.5), (Words{{250, 0}, 1}));
  EXPECT_EQ(to_words(word, 249.4), (Words{{249, 0}, 1}));
  EXPECT_EQ(to_words(two, 0x12345678), (Words{{0x1234, 0x5678}, 2}));
  EXPECT_EQ(to_words(low_first, 0x12345678), (Words{{0x5678, 0x1234}, 2}));
  EXPECT_EQ(to_words(signed_word, -2), (Words{{0xFFFE, 0}, 1}));
  EXPECT_EQ(to_words(signed_two, -2), (Words{{0xFFFF, 0xFFFE}, 2}));
}

TEST(ModbusWords, AreTheNearestThatFit) {
  const Place word{kRegisters, 0}, signed_word{kRegisters, 0, 16, true}, two{kRegisters, 0, 32},
      signed_two{kRegisters, 0, 32, true};
  EXPECT_EQ(to_words(word, 65535), (Words{{65535, 0}, 1}));
  EXPECT_EQ(to_words(word, 70000), (Words{{65535, 0}, 1}));
  EXPECT_EQ(to_words(word, -5), (Words{{0, 0}, 1}));
  EXPECT_EQ(to_words(signed_word, 40000), (Words{{0x7FFF, 0}, 1}));
  EXPECT_EQ(to_words(signed_word, -40000), (Words{{0x8000, 0}, 1}));
  EXPECT_EQ(to_words(two, 5e9), (Words{{0xFFFF, 0xFFFF}, 2}));
  EXPECT_EQ(to_words(signed_two, 5e9), (Words{{0x7FFF, 0xFFFF}, 2}));
  EXPECT_EQ(to_words(signed_two, -5e9), (Words{{0x8000, 0}, 2}));
  EXPECT_EQ(to_words(word, std::numeric_limits<double>::quiet_NaN()), (Words{{0, 0}, 1}));
  EXPECT_EQ(to_words(word, std::numeric_limits<double>::infinity()), (Words{{0, 0}, 1}));
  for (const double on : {1.0, -3.0, 0.25}) EXPECT_EQ(to_words({Table::Coils, 0, 1}, on), (Words{{1, 0}, 1})) << on;
  EXPECT_EQ(to_words({Table::Coils, 0, 1}, 0), (Words{{0, 0}, 1}));
}

}  // namespace
}  // namespace rmac::fieldbus::modbus
