#include "canopen/watch/bus_record.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace rmac::fieldbus::canopen {
namespace {

using namespace std::chrono_literals;

TEST(BusRecord, TellsEachThingThatWasNotedAsItself) {
  BusRecord record;
  record.start(5s);
  CanopenCounters counters;
  counters.cycles = 1;
  counters.unsent = 2;
  counters.short_answers = 3;
  const CanHealth health{.sent = 4,
                         .received = 5,
                         .queue_full = 6,
                         .send_failures = 7,
                         .overflowed = 8,
                         .error_frames = 9,
                         .warnings = 10,
                         .passives = 11,
                         .bus_offs = 12,
                         .bus_off = true,
                         .link_down = false};
  record.note(counters, health, 7s);
  const BusReport told = record.report();
  EXPECT_EQ(record.run(), 2s);
  EXPECT_EQ(told.cycles, 1U);
  EXPECT_EQ(told.unsent, 2U);
  EXPECT_EQ(told.short_answers, 3U);
  EXPECT_EQ(told.health.sent, 4U);
  EXPECT_EQ(told.health.received, 5U);
  EXPECT_EQ(told.health.queue_full, 6U);
  EXPECT_EQ(told.health.send_failures, 7U);
  EXPECT_EQ(told.health.overflowed, 8U);
  EXPECT_EQ(told.health.error_frames, 9U);
  EXPECT_EQ(told.health.warnings, 10U);
  EXPECT_EQ(told.health.passives, 11U);
  EXPECT_EQ(told.health.bus_offs, 12U);
  EXPECT_TRUE(told.health.bus_off);
  EXPECT_FALSE(told.health.link_down);
  record.note(counters, {.link_down = true}, 8s);
  EXPECT_FALSE(record.report().health.bus_off);
  EXPECT_TRUE(record.report().health.link_down);
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
