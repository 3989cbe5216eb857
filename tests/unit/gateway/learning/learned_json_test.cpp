#include "gateway/learning/learned_json.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace rmac::gateway {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

Json sent() {
  return to_json(Learned{"Mill", "17", {{{5, 0}, {6, 2.5}}, 4, {0, 1, 2.5}, 2, {0, 0, 0.01, -0.02, 0.00312345, 0}}});
}

std::string refusal_of(const std::function<void(Json&)>& change) {
  Json object = sent();
  change(object);
  const auto read = read_learned(object);
  return read ? "none" : read.error().message;
}

TEST(LearnedJson, ReadsWhatWasWrittenToAHundredthOfAMicrometre) {
  const auto read = read_learned(Json::parse(sent().dump()));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->machine, "Mill");
  EXPECT_EQ(read->configuration, "17");
  ASSERT_EQ(read->path.moves.size(), 2U);
  EXPECT_EQ(read->path.moves[1].id, 6);
  EXPECT_EQ(read->path.moves[1].begin_mm, 2.5);
  EXPECT_EQ(read->path.end_mm, 4);
  EXPECT_THAT(read->path.places, testing::ElementsAre(0, 1, 2.5));
  EXPECT_THAT(read->path.offsets, testing::ElementsAre(0, 0, 0.01, -0.02, testing::DoubleNear(0.00312, 1e-9), 0));
}

TEST(LearnedJson, NamesTheMemberThatIsWrong) {
  const double nan = std::nan("");
  EXPECT_THAT(refusal_of([](Json& o) { o = 5; }), HasSubstr("one object"));
  EXPECT_THAT(refusal_of([](Json& o) { o.erase("End"); }), HasSubstr("/End is missing"));
  EXPECT_THAT(refusal_of([](Json& o) { o["Machine"] = 5; }), HasSubstr("/Machine is no text"));
  EXPECT_THAT(refusal_of([](Json& o) { o["Places"] = "all"; }), HasSubstr("/Places is no list"));
  EXPECT_THAT(refusal_of([](Json& o) { o["Places"][1] = "far"; }), HasSubstr("/Places[1] is no number"));
  EXPECT_THAT(refusal_of([&](Json& o) { o["Places"][1] = nan; }), HasSubstr("/Places[1] is no number"));
  EXPECT_THAT(refusal_of([](Json& o) { o["Moves"][1] = Json{6.5, 2}; }), HasSubstr("/Moves/1 is no MoveID"));
  EXPECT_THAT(refusal_of([](Json& o) { o["Joints"][1] = 3; }), HasSubstr("/Joints/1/Offsets is no list"));
  EXPECT_THAT(refusal_of([&](Json& o) { o["Joints"][0]["Offsets"][2] = nan; }), HasSubstr("Offsets[2] is no number"));
  EXPECT_THAT(refusal_of([](Json& o) { o["Joints"] = std::vector<int>(200); }), HasSubstr("/Joints has 200"));
  EXPECT_THAT(refusal_of([](Json& o) { o["Places"] = std::vector<int>(1'000'000); }), HasSubstr("1000000 numbers"));
  EXPECT_THAT(refusal_of([](Json& o) { o["Moves"] = std::vector<int>(1'000'000); }), HasSubstr("1000000 moves"));
}

}  // namespace
}  // namespace rmac::gateway
