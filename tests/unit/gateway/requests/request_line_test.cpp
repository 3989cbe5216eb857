#include "gateway/requests/request_line.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

using nlohmann::json;
using testing::HasSubstr;

RequestLine read(const std::string& text, std::uint64_t position = 0) {
  RequestLine line(position, text.size(), {});
  line.read(text);
  return line;
}

std::string request(const std::string& id, const std::string& method) {
  return R"({"jsonrpc":"2.0",)" + (id.empty() ? "" : "\"id\":" + id + ",") + R"("method":")" + method + "\"}";
}

constexpr const char* kMove = R"({"jsonrpc":"2.0","id":1,"method":"RMAC_CAM.MoveToPathTarget","params":[]})";

TEST(RequestLine, CountsItsRequestsOnFromItsPlaceInTheInput) {
  RequestLine line = read("[" + request("1", "RMAC_CAM.Ok") + "," + request("2", "RMAC_CAM.Ok") + "]", 500);
  ASSERT_NE(line.next(), nullptr);
  EXPECT_EQ(line.next()->id, 1);
  EXPECT_EQ(line.next_position(), 500U);
  line.answer_next(json(true));
  ASSERT_NE(line.next(), nullptr);
  EXPECT_EQ(line.next()->id, 2);
  EXPECT_EQ(line.next_position(), 501U);
  line.answer_next(json(true));
  EXPECT_EQ(line.next(), nullptr);
}

TEST(RequestLine, AnswersItsStopsBeforeWhatStandsBeforeThem) {
  RequestLine line = read("[" + request("1", "RMAC_CAM.Ok") + "," + request("2", "RMAC_CAM.StopNow") + "]", 10);
  std::vector<std::uint64_t> places;
  line.answer_stops([&](const Request& stop, std::uint64_t position) -> Answer {
    EXPECT_EQ(stop.id, 2);
    places.push_back(position);
    return json(true);
  });
  EXPECT_EQ(places, (std::vector<std::uint64_t>{11}));
  ASSERT_NE(line.next(), nullptr);
  EXPECT_EQ(line.next()->id, 1);
  line.answer_next(json(false));
  EXPECT_EQ(line.next(), nullptr) << "the stop is answered already";
  EXPECT_EQ(json::parse(line.response().value())[0]["result"], false);
  EXPECT_EQ(json::parse(line.response().value())[1]["result"], true);
}

TEST(RequestLine, IsAnsweredAloneOnlyWhenItIsOneStop) {
  const auto yes = [](const Request&, std::uint64_t) -> Answer { return json(true); };
  RequestLine stop = read(request("1", "RMAC_CAM.StopNow"));
  stop.answer_stops(yes);
  EXPECT_TRUE(stop.is_answered_alone());
  RequestLine other = read(request("1", "RMAC_CAM.Ok"));
  other.answer_stops(yes);
  EXPECT_FALSE(other.is_answered_alone());
  RequestLine batch = read("[" + request("1", "RMAC_CAM.StopNow") + "]");
  batch.answer_stops(yes);
  EXPECT_FALSE(batch.is_answered_alone()) << "a batch keeps its turn";
}

TEST(RequestLine, RespondsToWhatWantsAnAnswerOnly) {
  RequestLine alone = read(request("", "RMAC_CAM.Ok"));
  alone.answer_next(json(true));
  EXPECT_FALSE(alone.response());
  RequestLine batch = read("[" + request("", "RMAC_CAM.Ok") + "," + request("5", "RMAC_CAM.Ok") + "]");
  batch.answer_next(json(1));
  batch.answer_next(json(2));
  EXPECT_EQ(json::parse(batch.response().value()), json::parse(R"([{"jsonrpc":"2.0","id":5,"result":2}])"));
  RequestLine quiet = read("[" + request("", "RMAC_CAM.Ok") + "]");
  quiet.answer_next(json(1));
  EXPECT_FALSE(quiet.response());
}

TEST(RequestLine, ThatIsNoRequestHasOneErrorToGive) {
  for (const char* text : {"{", "[]", "7"}) {
    SCOPED_TRACE(text);
    RequestLine line = read(text);
    ASSERT_NE(line.next(), nullptr);
    EXPECT_TRUE(line.next()->error);
    line.answer_next(tl::unexpected<RpcError>(*line.next()->error));
    EXPECT_EQ(line.next(), nullptr);
  }
}

TEST(RequestLine, RefusesMovesBehindOneThatWasRefusedAndNothingElse) {
  RequestLine line = read(std::string("[") + kMove + "," + request("2", "RMAC_CAM.Ok") + "]");
  EXPECT_FALSE(line.refusal_of_next());
  line.refuse_moves(refused(MinorCode::CommandQueueFull, "full"));
  ASSERT_TRUE(line.refusal_of_next());
  EXPECT_EQ(line.refusal_of_next()->error().minor, MinorCode::CommandQueueFull);
  line.answer_next(*line.refusal_of_next());
  EXPECT_FALSE(line.refusal_of_next());
}

TEST(RequestLine, RefusesTheRestOfABatchWhoseAnswersAreTooLong) {
  std::string text = "[" + request("1", "RMAC_CAM.Ok");
  for (int i = 0; i < 3; ++i) text += "," + request("1", "RMAC_CAM.Ok");
  RequestLine line = read(text + "]");
  const json large{{"text", std::string(std::size_t{5} << 20, 'x')}};
  line.answer_next(large);
  EXPECT_FALSE(line.refusal_of_next());
  line.answer_next(large);
  ASSERT_TRUE(line.refusal_of_next());
  EXPECT_THAT(line.refusal_of_next()->error().message, HasSubstr("exceed 8 MiB"));
}

TEST(RequestLine, KnowsWhichRequestsOfALongLineAreLarge) {
  const auto padded = [](const std::string& values) {
    return R"({"jsonrpc":"2.0","id":1,"method":"RMAC_CAM.Ok","params":[)" + values + "]" +
           std::string(RequestLine::kLongBytes, ' ') + "}";
  };
  std::string many = "0";
  for (int i = 1; i < 2001; ++i) many += ",0";
  EXPECT_TRUE(read(padded(many)).next()->large);
  EXPECT_FALSE(read(padded("0")).next()->large) << "a long text is no large move";
}

TEST(RequestLine, IsHereAgainAfterAnAnswer) {
  RequestLine line = read("[" + request("1", "RMAC_CAM.Ok") + "," + request("2", "RMAC_CAM.Ok") + "]");
  line.set_stage(RequestLine::Stage::Prepared);
  line.answer_next(json(true));
  EXPECT_EQ(line.stage(), RequestLine::Stage::Here) << "the next request is not prepared by it";
}

}  // namespace
}  // namespace rmac::gateway
