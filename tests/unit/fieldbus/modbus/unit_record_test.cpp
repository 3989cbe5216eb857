#include "modbus/unit_record.hpp"

#include <gmock/gmock.h>

namespace rmac::fieldbus::modbus {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::Pair;

TEST(ModbusUnitRecord, TellsWhatCameOfTheQuestionsOfEachUnit) {
  UnitRecords records;
  const Clock::time_point begun{1h};
  const auto ask = [&](int unit, const Answer<>& answer) {
    records.asked(unit);
    records.ended(unit, answer, begun);
  };
  const auto fails = [](Failure::Kind kind, int code = 0, const char* why = "") {
    return tl::unexpected<Failure>({kind, code, why});
  };
  for (int i = 0; i < 5; ++i) ask(1, {});
  ask(1, fails(Failure::Kind::Exception, 2));
  ask(1, fails(Failure::Kind::Exception, 6));
  ask(1, fails(Failure::Kind::Exception, 6));
  ask(1, fails(Failure::Kind::WrongAnswer));
  ask(1, fails(Failure::Kind::Disconnected));
  ask(1, fails(Failure::Kind::Timeout, 0, "no whole answer"));
  ask(2, {});

  const UnitTraffic first = records.traffic(1, begun + 90s);
  EXPECT_EQ(first.requests, 11U);
  EXPECT_EQ(first.answers, 5U);
  EXPECT_THAT(first.exceptions, ElementsAre(Pair(2, 1U), Pair(6, 2U)));
  EXPECT_EQ(first.wrong_answers, 1U);
  EXPECT_EQ(first.disconnects, 1U);
  EXPECT_EQ(first.timeouts, 1U);
  ASSERT_TRUE(first.last_trouble);
  EXPECT_EQ(first.last_trouble->message, "no whole answer");
  EXPECT_DOUBLE_EQ(first.last_trouble->age_s, 90);

  const UnitTraffic second = records.traffic(2, begun);
  EXPECT_EQ(second.requests, 1U);
  EXPECT_FALSE(second.last_trouble);
  EXPECT_EQ(records.traffic(3, begun).requests, 0U);
}

}  // namespace
}  // namespace rmac::fieldbus::modbus
