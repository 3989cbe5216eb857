#include "gateway/events/event_queue.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace rmac::gateway {
namespace {

Event event(std::int64_t cycle, const std::string& message) {
  Event made;
  made.cycle = cycle;
  made.message = message;
  return made;
}

std::vector<std::string> told_before(EventQueue& queue, std::int64_t cycle) {
  std::vector<std::string> told;
  while (auto next = queue.next_before(cycle)) told.push_back(next->message);
  return told;
}

TEST(EventQueue, IsInTheOrderOfCyclesWhoeverReportsFirst) {
  EventQueue queue;
  queue.add(event(7, "stopped"));
  queue.add(event(5, "fault"));
  queue.add(event(6, "dropped"));
  EXPECT_THAT(told_before(queue, 100), testing::ElementsAre("fault", "dropped", "stopped"));
}

TEST(EventQueue, KeepsTheOrderInWhichEventsOfACycleWereAdded) {
  EventQueue queue;
  queue.add(event(5, "fault"));
  queue.add(event(5, "to Faulted"));
  queue.add(event(4, "before"));
  queue.add(event(5, "stopped"));
  EXPECT_THAT(told_before(queue, 100), testing::ElementsAre("before", "fault", "to Faulted", "stopped"));
}

TEST(EventQueue, KeepsWhatHappenedInTheCycleOrLater) {
  EventQueue queue;
  queue.add(event(4, "before"));
  queue.add(event(5, "now"));
  EXPECT_THAT(told_before(queue, 5), testing::ElementsAre("before"));
  EXPECT_THAT(told_before(queue, 6), testing::ElementsAre("now"));
}

}  // namespace
}  // namespace rmac::gateway
