#include "gateway/server/subscriptions.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "animated_machine.hpp"

namespace rmac::gateway {
namespace {

using nlohmann::json;
using testing::HasSubstr;

CycleSample sample_of_cycle(std::int64_t cycle) {
  CycleSample sample;
  sample.cycle = cycle;
  sample.joint_count = sample.joint_count_with_held = 2;
  return sample;
}

/// The subscriptions of one client of a machine with 1000 cycles a second.
struct Topics : Subscriptions {
  Topics()
      : Subscriptions(
            1000, [](const CycleSample& sample) { return std::to_string(sample.cycle); },
            [this] { return Scene{.drawing = drawing}; }) {}

  void start(const std::vector<std::string>& topics, double rate_hz) { Subscriptions::start(topics, rate_hz, cycle); }
  void animate(bool on) { Subscriptions::animate(on, cycle); }

  /// How many samples each topic has in the batches after `count` cycles.
  std::map<std::string, std::size_t> batched(std::int64_t count) {
    for (std::int64_t end = cycle + count; cycle < end;) {
      if (auto line = take(sample_of_cycle(++cycle))) states.push_back(json::parse(*line)["params"]);
    }
    std::map<std::string, std::size_t> samples;
    for (const std::string& line : batches()) {
      const json message = json::parse(line);
      samples[message["method"]] += message["params"]["samples"].size();
    }
    return samples;
  }

  std::int64_t cycle = 0;
  std::vector<std::int64_t> states;
  std::shared_ptr<const MachineDrawing> drawing = fakes::slides_drawing();
};

using Counts = std::map<std::string, std::size_t>;

TEST(Subscriptions, KnowFiveTopicsAndNameAnotherAsItIsShown) {
  EXPECT_TRUE(Subscriptions::check({"state", "joints", "drives", "animation", "events"}));
  const auto refused = Subscriptions::check({"state", "wea\nther"});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "parameter \"topics\" has \"wea?ther\", expected state, joints, drives, animation or events");
}

TEST(Subscriptions, HaveARateUnlessTheyAreOfEvents) {
  EXPECT_FALSE(Subscriptions::has_rate({"events"}));
  for (const char* topic : {"state", "joints", "drives", "animation"})
    EXPECT_TRUE(Subscriptions::has_rate({"events", topic}));
}

TEST(Subscriptions, CollectEachTopicAtItsOwnPace) {
  Topics topics;
  topics.start({"joints"}, 1000);
  topics.start({"drives"}, 100);
  topics.start({"animation"}, 250);
  topics.start({"state"}, 10);
  EXPECT_EQ(topics.batched(200), (Counts{{"joints", 200}, {"drives", 20}, {"animation", 50}}));
  EXPECT_EQ(topics.states, (std::vector<std::int64_t>{1, 101})) << "a state is no batch";
  EXPECT_EQ(topics.batched(0), Counts{}) << "batches go once";
}

TEST(Subscriptions, EndForTheTopicsThatAreNamedOrForAll) {
  Topics topics;
  topics.start({"joints", "drives", "state", "events"}, 1000);
  topics.stop({"drives"});
  EXPECT_TRUE(topics.has_events());
  EXPECT_EQ(topics.batched(10), (Counts{{"joints", 10}}));
  topics.stop({"events"});
  EXPECT_FALSE(topics.has_events());
  topics.start({"events"}, 100);
  topics.stop({});
  topics.states.clear();
  EXPECT_EQ(topics.batched(10), Counts{});
  EXPECT_TRUE(topics.states.empty());
  EXPECT_FALSE(topics.has_events());
}

TEST(Subscriptions, AreFastAboveTheWatchersRateOnly) {
  for (const char* topic : {"joints", "drives", "animation", "state"}) {
    SCOPED_TRACE(topic);
    Topics topics;
    topics.start({topic}, 100);
    EXPECT_FALSE(topics.is_fast());
    topics.start({topic}, 112);
    EXPECT_TRUE(topics.is_fast());
    topics.stop({topic});
    EXPECT_FALSE(topics.is_fast());
  }
}

TEST(Subscriptions, TellNothingOfCyclesBeforeTheyWereAskedFor) {
  for (const char* topic : {"joints", "drives", "animation", "state"}) {
    SCOPED_TRACE(topic);
    Topics topics;
    topics.Subscriptions::start({topic}, 200, 700);
    topics.cycle = 100;  // the samples of a second wait still to be told
    EXPECT_EQ(topics.batched(600), Counts{});
    EXPECT_THAT(topics.states, testing::IsEmpty());
    EXPECT_EQ(topics.batched(21).size() + topics.states.size(), topic == std::string("state") ? 5U : 1U);
  }
}

TEST(Subscriptions, GoOnWithoutAGapWhenTheyAreAskedForAnew) {
  for (const char* topic : {"joints", "drives", "animation"}) {
    SCOPED_TRACE(topic);
    Topics topics;
    topics.start({topic}, 1000);
    EXPECT_EQ(topics.batched(100), (Counts{{topic, 100}}));
    topics.Subscriptions::start({topic}, 1000, 130);  // while the samples of 30 cycles wait still to be told
    EXPECT_EQ(topics.batched(100), (Counts{{topic, 100}}));
    topics.start({topic}, 10);
    EXPECT_EQ(topics.batched(100), (Counts{{topic, 1}}));
    topics.start({topic}, 1000);
    EXPECT_EQ(topics.batched(100), (Counts{{topic, 100}}));
  }
}

TEST(Subscriptions, AskedForTwiceBeforeTheFirstSampleTellNothingOfCyclesBefore) {
  Topics topics;
  topics.Subscriptions::start({"joints"}, 10, 700);
  topics.Subscriptions::start({"joints"}, 1000, 750);
  EXPECT_EQ(topics.batched(700), Counts{});
  EXPECT_EQ(topics.batched(100), (Counts{{"joints", 100}}));
}

TEST(Subscriptions, OweTheFirstStateWithoutACycleAndTheLastOne) {
  Topics topics;
  topics.owe_state();
  EXPECT_FALSE(topics.owes_state()) << "nobody asked for it";
  topics.start({"state"}, 100);
  EXPECT_TRUE(topics.owes_state());
  EXPECT_EQ(json::parse(topics.state_line(sample_of_cycle(7))),
            json::parse(R"({"jsonrpc":"2.0","method":"state","params":7})"));
  EXPECT_FALSE(topics.owes_state()) << "told";
  topics.owe_state();
  EXPECT_TRUE(topics.owes_state());
  EXPECT_EQ(topics.batched(1), Counts{});
  EXPECT_FALSE(topics.owes_state()) << "a cycle's state is one, too";
  topics.start({"state"}, 100);
  topics.stop({"state"});
  EXPECT_FALSE(topics.owes_state());
}

TEST(Subscriptions, AreFullBeforeABatchIsLargerThanASocketLikes) {
  Topics topics;
  topics.start({"joints", "drives"}, 1000);
  std::int64_t cycle = 0;
  while (!topics.is_full()) {
    EXPECT_FALSE(topics.take(sample_of_cycle(++cycle)));
    ASSERT_LT(cycle, 10'000);
  }
  std::size_t bytes = 0;
  for (const std::string& line : topics.batches()) bytes += line.size();
  EXPECT_GT(bytes, 256U * 1024);
  EXPECT_LT(bytes, 260U * 1024);
  EXPECT_FALSE(topics.is_full());
}

TEST(Subscriptions, AnimateWithSixtyPosesAndFiftySamplesOfJointsASecondAndThenGoOnAsBefore) {
  Topics topics;
  topics.animate(true);
  EXPECT_EQ(topics.batched(100), (Counts{{"animation", 6}, {"joints", 5}}));
  topics.animate(true);
  topics.animate(false);
  EXPECT_EQ(topics.batched(100), Counts{});
  topics.start({"joints"}, 10);
  topics.animate(true);
  EXPECT_EQ(topics.batched(100), (Counts{{"animation", 6}, {"joints", 5}}));
  topics.animate(false);
  EXPECT_EQ(topics.batched(200), (Counts{{"joints", 2}}));
}

TEST(Subscriptions, AskedForDuringAnAnimationOutlastIt) {
  Topics topics;
  topics.animate(true);
  topics.start({"joints"}, 200);
  topics.animate(false);
  EXPECT_EQ(topics.batched(100), (Counts{{"joints", 20}}));
}

}  // namespace
}  // namespace rmac::gateway
