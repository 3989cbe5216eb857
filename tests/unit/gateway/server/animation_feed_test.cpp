#include "gateway/server/animation_feed.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "animated_machine.hpp"

namespace rmac::gateway {
namespace {

using fakes::slides_drawing;
using nlohmann::json;

CycleSample moving_sample(std::int64_t cycle) {
  CycleSample sample;
  sample.cycle = cycle;
  sample.t_s = static_cast<double>(cycle) / 1000;
  sample.joint_count = 2;
  sample.joint_count_with_held = 3;
  sample.move_id = 5;
  sample.position = {0.1 * static_cast<double>(cycle), -2, 77};
  sample.position_set = {1e9, 1e9, 1e9};
  sample.pose_actual = {{1, 2, 3}, {0, 0, 1}};
  return sample;
}

/// The feed of one client, and how often it looked at the machine.
struct Feed : AnimationFeed {
  Feed() : AnimationFeed([this] { return ++looks, scene; }) {}

  std::vector<json> after(std::int64_t first, std::int64_t count) {
    for (std::int64_t cycle = first; cycle < first + count; ++cycle) take(moving_sample(cycle));
    std::vector<std::string> lines;
    take_out(lines);
    std::vector<json> told;
    for (const std::string& line : lines) told.push_back(json::parse(line));
    return told;
  }

  Scene scene{.drawing = slides_drawing(), .tool = 0};
  int looks = 0;
};

TEST(AnimationFeed, SendsSixtySamplesOfAThousandCyclesEvenlyApart) {
  Feed feed;
  feed.start(1000.0 / 60, -1);
  const auto told = feed.after(1, 60'000);
  ASSERT_EQ(told.size(), 1U);
  const json& samples = told[0]["params"]["samples"];
  EXPECT_NEAR(static_cast<double>(samples.size()), 3600, 1);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const auto apart = samples[i]["cycle"].get<int>() - samples[i - 1]["cycle"].get<int>();
    ASSERT_TRUE(apart == 16 || apart == 17) << apart << " cycles before " << samples[i]["cycle"];
  }
}

TEST(AnimationFeed, LooksAtNothingWhileNobodyWatches) {
  Feed feed;
  EXPECT_TRUE(feed.after(1, 1000).empty());
  feed.start(100, -1);
  EXPECT_EQ(feed.after(1001, 1000).size(), 1U);
  EXPECT_EQ(feed.looks, 10) << "once a sample that is due";
  feed.pace().stop();
  EXPECT_TRUE(feed.after(2001, 1000).empty());
  EXPECT_EQ(feed.looks, 10);
}

TEST(AnimationFeed, TellsWhereMeasuredJointsHaveEachLink) {
  Feed feed;
  feed.scene.virtual_mode = true;
  feed.scene.tool = 7;
  feed.scene.frames = {{{1, 2, 3}, {1, 0, 0, 0}}, {{0, 0, -80}, {1, 0, 0, 0}}};
  feed.start(1, -1);
  const json params = feed.after(30, 1).at(0).at("params");
  EXPECT_EQ(params["geometry"], 1);
  EXPECT_EQ(params["machine"], "Slides");
  EXPECT_EQ(params["missing"], "");
  EXPECT_EQ(params["virtual"], true);
  EXPECT_EQ(params["tool"], 7);
  EXPECT_EQ(params["part_frame"], json::parse(R"({"p": [1, 2, 3], "q": [1, 0, 0, 0]})"));
  EXPECT_EQ(params["tool_frame"]["p"], json::parse("[0, 0, -80]"));
  const json sample = params["samples"].at(0);
  EXPECT_EQ(sample["cycle"], 30);
  EXPECT_EQ(sample["t_s"], 0.03);
  EXPECT_EQ(sample["moving"], false);
  EXPECT_EQ(sample["move_id"], 5);
  EXPECT_EQ(sample["pose"], json::parse("[1, 2, 3, 0, 0, 1]"));
  EXPECT_EQ(sample["joints"], json::parse("[3, -2]"));
  EXPECT_EQ(sample["held"], json::parse("[77]"));
  const json& links = sample["links"];
  EXPECT_EQ(links.size(), 5U);
  const auto near = [&](const char* link, const std::array<double, 3>& wanted) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(links[link]["p"][k].get<double>(), wanted[k], 1e-9) << link;
  };
  near("base", {0, 0, 0});
  near("X", {-3, 0, 0});  // the table, against which the tool goes by +3
  near("table", {-3, 0, 0});
  near("Z", {0, 0, -2});
  near("spindle", {0, 0, -2});
  EXPECT_EQ(links["spindle"]["q"], json::parse("[1, 0, 0, 0]"));
}

TEST(AnimationFeed, BeginsANotificationWhereTheToolOrAFrameIsAnother) {
  Feed feed;
  feed.start(1, -1);
  feed.take(moving_sample(1));
  feed.scene.tool.reset();
  feed.take(moving_sample(2));
  feed.scene.frames.part.p = {9, 0, 0};
  feed.take(moving_sample(3));
  const auto told = feed.after(4, 1);
  ASSERT_EQ(told.size(), 3U);
  EXPECT_EQ(told[0]["params"]["tool"], 0);
  EXPECT_TRUE(told[1]["params"]["tool"].is_null()) << "not known";
  EXPECT_EQ(told[1]["params"]["samples"].size(), 1U);
  EXPECT_EQ(told[2]["params"]["part_frame"]["p"][0], 9);
  EXPECT_EQ(told[2]["params"]["samples"].size(), 2U);
}

TEST(AnimationFeed, FollowsASwapAndDropsWhatTheMachineBeforeLeftBehind) {
  Feed feed;
  feed.start(1, -1);
  feed.take(moving_sample(1));
  feed.scene.drawing = slides_drawing(2, 10);
  const auto told = feed.after(2, 11);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0]["params"]["geometry"], 1);
  EXPECT_EQ(told[1]["params"]["geometry"], 2);
  ASSERT_EQ(told[1]["params"]["samples"].size(), 2U);
  EXPECT_EQ(told[1]["params"]["samples"][0]["cycle"], 11);
}

TEST(AnimationFeed, SaysOnceWhatIsMissingOfAMachineAndAgainToWhoStartsAnew) {
  Feed feed;
  MachineDrawing bare;
  bare.number = 3;
  bare.machine = "Bare";
  bare.missing = "device.json of Bare has no \"Chain\"";
  feed.scene.drawing = std::make_shared<const MachineDrawing>(bare);
  feed.start(1, -1);
  const auto told = feed.after(1, 100);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0]["params"]["missing"], bare.missing);
  EXPECT_EQ(told[0]["params"]["machine"], "Bare");
  EXPECT_TRUE(told[0]["params"]["samples"].empty());
  EXPECT_TRUE(feed.after(101, 100).empty());
  feed.start(1, -1);
  EXPECT_EQ(feed.after(201, 100).size(), 1U);
  feed.scene.drawing = slides_drawing(4);
  EXPECT_EQ(feed.after(301, 1).at(0)["params"]["samples"].size(), 1U);
  bare.number = 5;
  bare.machine.clear();
  feed.scene.drawing = std::make_shared<const MachineDrawing>(bare);
  EXPECT_TRUE(feed.after(302, 1).at(0)["params"]["machine"].is_null());
}

}  // namespace
}  // namespace rmac::gateway
