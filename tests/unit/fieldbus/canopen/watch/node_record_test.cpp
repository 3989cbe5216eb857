#include "canopen/watch/node_record.hpp"

#include <gtest/gtest.h>

#include "canopen/watch/identity_record.hpp"
#include "rmac/fieldbus/canopen/sdo_step.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using namespace std::chrono_literals;
using Octets = std::vector<std::uint8_t>;

TEST(NodeRecord, TellsAnEmergencyWithItsRegisterAndItsAge) {
  NodeRecord record(1ms);
  record.emergency({.id = 0x85, .size = 8, .data = {0x11, 0x86, 0xA5}}, 1500ms);
  record.emergency({.id = 0x85, .size = 2, .data = {0x00, 0x10, 0xFF}}, 100h + 2ms);
  const NodeReport told = record.report(100h + 1s);
  EXPECT_EQ(told.emergency_count, 2U);
  ASSERT_EQ(told.emergencies.size(), 2U);
  EXPECT_EQ(told.emergencies[0].code, 0x1000);
  EXPECT_EQ(told.emergencies[0].error_register, 0) << "it is too short to have one";
  EXPECT_NEAR(told.emergencies[0].age_s, 0.998, 1e-9);
  EXPECT_EQ(told.emergencies[1].code, 0x8611);
  EXPECT_EQ(told.emergencies[1].text, "following error");
  EXPECT_EQ(told.emergencies[1].error_register, 0xA5);
  EXPECT_NEAR(told.emergencies[1].age_s, 360000 - 0.5, 1e-6);
  EXPECT_EQ(record.report(1s).emergencies[1].age_s, 0) << "none comes from the future";
  record.emergency({.id = 0x85, .size = 3, .data = {0x00, 0x10, 0x21}}, 1s);
  EXPECT_EQ(record.report(1s).emergencies[0].error_register, 0x21);
}

TEST(NodeRecord, KeepsAbortsAmongAllSdoAnswers) {
  NodeRecord record(1ms);
  record.sdo_answer({.id = 0x585, .size = 8, .data = {0x43, 0x41, 0x60, 0, 1, 2, 3, 4}});
  record.sdo_answer({.id = 0x585, .size = 7, .data = {0x80, 0x41, 0x60, 0, 1, 2, 3, 4}});
  EXPECT_EQ(record.report(1s).abort_count, 0U);
  record.sdo_answer({.id = 0x585, .size = 8, .data = {0x80, 0xCD, 0xAB, 0xEF, 0x23, 0x00, 0x0A, 0xF6}});
  const NodeReport told = record.report(1s);
  EXPECT_EQ(told.abort_count, 1U);
  ASSERT_EQ(told.aborts.size(), 1U);
  EXPECT_EQ(told.aborts[0].object, (ObjectAddress{0xABCD, 0xEF}));
  EXPECT_EQ(told.aborts[0].code, 0xF60A0023U);
}

TEST(NodeRecord, CountsEachThingAsItselfAndForgetsAll) {
  NodeRecord record(1ms);
  for (int i = 0; i < 1; ++i) record.missed();
  for (int i = 0; i < 2; ++i) record.lost();
  for (int i = 0; i < 3; ++i) record.recovered();
  record.answer(1000ms);
  record.answer(1001ms + 10us);
  record.emergency({.size = 2, .data = {1, 0x10}}, 1s);
  record.sdo_answer({.size = 8, .data = {0x80}});
  const NodeReport told = record.report(2s);
  EXPECT_EQ(told.missed_answers, 1U);
  EXPECT_EQ(told.lost, 2U);
  EXPECT_EQ(told.recovered, 3U);
  EXPECT_EQ(told.answers, 1U);
  EXPECT_NEAR(told.jitter_mean_s, 10e-6, 1e-12);
  EXPECT_NEAR(told.jitter_most_s, 10e-6, 1e-12);
  record.forget();
  const NodeReport anew = record.report(2s);
  EXPECT_EQ(anew.missed_answers + anew.lost + anew.recovered + anew.answers, 0U);
  EXPECT_EQ(anew.emergency_count + anew.abort_count, 0U);
  EXPECT_EQ(anew.jitter_mean_s + anew.jitter_most_s, 0);
}

CanFrame told(std::uint8_t command, ObjectAddress object, std::uint32_t value, std::uint8_t size = 8) {
  SdoBytes bytes = sdo_frame(command, object);
  put_long(&bytes[4], value);
  return {.id = 0x585, .size = size, .data = bytes};
}

// Red when what is no number of the identity, or no answer, has a drive taken for two.
TEST(IdentityRecord, HoldsTheFirstValueOfEachNumberAgainstLaterOnes) {
  for (const ObjectAddress object : {ObjectAddress{0x1000, 0}, ObjectAddress{0x1018, 1}, ObjectAddress{0x1018, 2},
                                     ObjectAddress{0x1018, 3}, ObjectAddress{0x1018, 4}}) {
    IdentityRecord record;
    EXPECT_FALSE(record.take(told(0x43, object, 0x11223344)));
    EXPECT_FALSE(record.take(told(0x43, object, 0x11223344)));
    const auto other = record.take(told(0x43, object, 0x11223345));
    ASSERT_TRUE(other) << to_string(object);
    EXPECT_EQ(other->object, object);
    EXPECT_EQ(other->first, 0x11223344U);
    EXPECT_EQ(other->second, 0x11223345U);
    EXPECT_FALSE(record.take(told(0x43, object, 0x11223344))) << "the first stays";
    record.forget();
    EXPECT_FALSE(record.take(told(0x43, object, 0x11223345)));
  }
  for (const ObjectAddress object : {ObjectAddress{0x1000, 1}, ObjectAddress{0x1018, 0}, ObjectAddress{0x1018, 5},
                                     ObjectAddress{0x1017, 0}, ObjectAddress{0x6041, 0}, ObjectAddress{0x6041, 1}}) {
    IdentityRecord record;
    EXPECT_FALSE(record.take(told(0x43, object, 1)));
    EXPECT_FALSE(record.take(told(0x43, object, 2))) << to_string(object) << " changes";
  }
}

TEST(IdentityRecord, TakesAsMuchOfANumberAsCounts) {
  struct Case {
    std::uint8_t command;
    std::uint32_t value;
  };
  for (const Case& one : {Case{0x4F, 0x44}, Case{0x4B, 0x3344}, Case{0x47, 0x223344}, Case{0x43, 0x11223344},
                          Case{0x42, 0x11223344}, Case{0x4E, 0x11223344}}) {
    IdentityRecord record;
    EXPECT_FALSE(record.take(told(one.command, {0x1018, 2}, 0x11223344)));
    EXPECT_EQ(record.identity().product_code, one.value) << int{one.command};
    EXPECT_EQ(record.identity().vendor_id | record.identity().serial_number, 0U);
  }
}

TEST(IdentityRecord, TakesAnswersToReadingAloneAndWhole) {
  IdentityRecord record;
  for (const std::uint8_t command : Octets{0x41, 0x60, 0x80, 0x03, 0x23, 0x63, 0xC3}) {
    EXPECT_FALSE(record.take(told(command, {0x1018, 1}, 7)));
  }
  EXPECT_FALSE(record.take(told(0x43, {0x1018, 1}, 7, 7)));
  EXPECT_EQ(record.identity().vendor_id, 0U);
  EXPECT_FALSE(record.take(told(0x43, {0x1018, 1}, 8)));
  EXPECT_EQ(record.identity().vendor_id, 8U);
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
