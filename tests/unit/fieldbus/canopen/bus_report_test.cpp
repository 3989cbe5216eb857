#include "rmac/fieldbus/bus_report.hpp"

#include <gmock/gmock.h>

#include <random>

#include "canopen/watch/answer_jitter.hpp"
#include "unit/fieldbus/canopen/canopen_bench.hpp"

namespace {

using namespace rmac;
using namespace rmac::fieldbus;
using namespace rmac::fieldbus::canopen;
using namespace rmac::fieldbus::test;
using std::chrono::microseconds;
using testing::HasSubstr;

class BusReporting : public CanopenBench {
 protected:
  void SetUp() override {
    first_ = &wire_.add(3);
    second_ = &wire_.add(4);
    make({{"node", {3, 4}}, {"missed_answers", {3}}});
    start();
    enable_all();
  }
  [[nodiscard]] NodeReport node(std::size_t place) const { return master_->report().nodes.at(place); }

  VirtualDrive* first_ = nullptr;
  VirtualDrive* second_ = nullptr;
};

TEST_F(BusReporting, TellsASoundBus) {
  const BusReport told = master_->report();
  EXPECT_EQ(told.interface, "can0");
  EXPECT_EQ(told.cycles, master_->counters().cycles);
  EXPECT_GT(told.health.received, 0U);
  ASSERT_EQ(told.nodes.size(), 2U);
  for (const NodeReport& each : told.nodes) {
    EXPECT_EQ(each.state, "operational");
    EXPECT_EQ(each.problem, std::nullopt);
    EXPECT_EQ(each.lost + each.recovered + each.missed_answers + each.emergency_count, 0U);
  }
  EXPECT_EQ(told.nodes[1].node, 4);
  EXPECT_THAT(told.nodes[1].axes, testing::ElementsAre(1U));
}

TEST_F(BusReporting, CountsTheMissedAnswersOfTheNodeThatMissedThem) {
  second_->answers_sync = false;
  cycles(2, DriveWish::Operational);
  second_->answers_sync = true;
  cycles(5, DriveWish::Operational);
  EXPECT_EQ(node(0).missed_answers, 0U);
  EXPECT_EQ(node(1).missed_answers, master_->counters().missed_answers);
  EXPECT_GT(node(1).missed_answers, 0U);
}

TEST_F(BusReporting, KeepsTheLatestEmergenciesNewestFirst) {
  for (std::uint16_t code = 0x1000; code < 0x1014; ++code) {
    wire_.inject({.id = 0x84, .size = 8, .data = {static_cast<std::uint8_t>(code), 0x10, 0x21}});
    cycles(1, DriveWish::Operational);
  }
  wire_.inject({.id = 0x84, .size = 8, .data = {0x11, 0x86, 0x20}});
  cycles(100, DriveWish::Operational);
  EXPECT_EQ(node(0).emergency_count, 0U);
  const NodeReport told = node(1);
  EXPECT_EQ(told.emergency_count, 21U);
  ASSERT_EQ(told.emergencies.size(), 8U);
  EXPECT_EQ(told.emergencies[0].code, 0x8611);
  EXPECT_EQ(told.emergencies[0].text, "following error");
  EXPECT_EQ(told.emergencies[0].error_register, 0x20);
  EXPECT_NEAR(told.emergencies[0].age_s, 0.099, 0.003);
  EXPECT_EQ(told.emergencies[7].code, 0x100D);
  EXPECT_GT(told.emergencies[7].age_s, told.emergencies[6].age_s);
}

TEST_F(BusReporting, KeepsWhatWasRefusedByWhoeverAsked) {
  const std::uint64_t before = node(0).abort_count;
  wire_.inject({.id = 0x583, .size = 8, .data = {0x80, 0xFF, 0x5F, 0x02, 0x00, 0x00, 0x02, 0x06}});
  cycles(1, DriveWish::Operational);
  const NodeReport told = node(0);
  EXPECT_EQ(told.abort_count, before + 1);
  EXPECT_EQ(told.aborts.at(0).object, (ObjectAddress{0x5FFF, 2}));
  EXPECT_EQ(told.aborts.at(0).code, 0x06020000U);
  EXPECT_EQ(told.aborts.at(0).text, "object does not exist in the object dictionary");
}

TEST_F(BusReporting, SaysWhyANodeIsAwayAndThatItCameBack) {
  second_->power_off();
  cycles(200, DriveWish::Operational);
  EXPECT_EQ(node(1).lost, 1U);
  EXPECT_EQ(node(1).recovered, 0U);
  EXPECT_NE(node(1).state, "operational");
  EXPECT_EQ(node(0).state, "operational");
  second_->power_on(wire_.now());
  cycles(1000, DriveWish::Off);
  EXPECT_EQ(node(1).recovered, 1U);
  EXPECT_EQ(node(1).state, "operational");
  EXPECT_EQ(node(1).problem, std::nullopt);
}

TEST_F(BusReporting, BeginsAnewWithTheBus) {
  wire_.inject({.id = 0x84, .size = 8, .data = {0x11, 0x86, 0x20}});
  cycles(1, DriveWish::Operational);
  EXPECT_EQ(node(1).emergency_count, 1U);
  master_->stop();
  start();
  EXPECT_EQ(node(1).emergency_count, 0U);
  EXPECT_EQ(master_->report().cycles, 1U);
}

/// Against the same sums by hand; the gaps of missed answers count for nothing.
TEST(AnswerJitter, IsTheDistanceOfTwoAnswersFromTheCycle) {
  constexpr microseconds kPeriod(1000);
  std::mt19937 random(2);
  AnswerJitter jitter(kPeriod);
  std::chrono::nanoseconds stamp = std::chrono::seconds(1'700'000'000);
  jitter.take(stamp);
  std::uint64_t count = 0;
  double sum_s = 0, most_s = 0;
  for (int i = 0; i < 1000; ++i) {
    const bool missed = random() % 10 == 0;
    const microseconds off(static_cast<int>(random() % 400) - 200);
    stamp += (missed ? 2 : 1) * kPeriod + off;
    jitter.take(stamp);
    if (missed) continue;
    const double off_s = std::abs(std::chrono::duration<double>(off).count());
    ++count;
    sum_s += off_s;
    most_s = std::max(most_s, off_s);
  }
  EXPECT_EQ(jitter.count(), count);
  EXPECT_NEAR(jitter.mean_s(), sum_s / static_cast<double>(count), 1e-9);
  EXPECT_NEAR(jitter.most_s(), most_s, 1e-9);
}

TEST(AnswerJitter, MeasuresNothingWithoutStamps) {
  AnswerJitter jitter(microseconds(1000));
  for (int i = 0; i < 5; ++i) jitter.take({});
  EXPECT_EQ(jitter.count(), 0U);
  EXPECT_EQ(jitter.mean_s(), 0);
}

}  // namespace
