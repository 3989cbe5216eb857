#include "gateway/rmac/wire/connection.hpp"

#include <gmock/gmock.h>

#include "unit/gateway/rmac/fake_appliance.hpp"

namespace rmac::cli {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

class ConnectionTest : public testing::Test {
 protected:
  std::unique_ptr<Connection> open() { return std::move(*Connection::open(appliance_.endpoint())); }

  FakeAppliance appliance_;
};

TEST_F(ConnectionTest, KeepsWhatTheApplianceSaidOfItself) {
  appliance_.answers("hello", {{"name", "rmacd"}});
  EXPECT_EQ(open()->greeting(), (json{{"name", "rmacd"}}));
}

TEST_F(ConnectionTest, IsRefusedByAnApplianceThatRefusesTheGreeting) {
  appliance_.refuses("hello", -32000, "too many clients");
  const auto refused = Connection::open(appliance_.endpoint());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "too many clients");
}

TEST_F(ConnectionTest, SaysWhereNoApplianceAnswers) {
  Endpoint endpoint;
  endpoint.socket = "/nonexistent/socket";
  const auto refused = Connection::open(endpoint);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "no appliance answers at /nonexistent/socket (No such file or directory): start rmacd, or name its place "
            "with --host, --port or --socket");
  endpoint.socket = "/" + std::string(200, 'x');
  EXPECT_FALSE(Connection::open(endpoint)) << "longer than an address may be";
}

TEST_F(ConnectionTest, TellsTheCodeOfARefusal) {
  appliance_.refuses("RMAC_CAM.Home", -32040, "needs motion authority");
  const auto refused = open()->call("RMAC_CAM.Home");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().rpc_code, -32040);
}

TEST_F(ConnectionTest, HandsNotificationsOutInTheirOrder) {
  appliance_.handles("RMAC_CAM.Ok", [&](const json&) {
    appliance_.push("state", {{"n", 1}});
    appliance_.push("events", {{"n", 2}});
    return gateway::Answer(true);
  });
  const auto connection = open();
  std::vector<std::string> heard;
  connection->on_notification(
      [&](const std::string& topic, const json& params) { heard.push_back(topic + params.at("n").dump()); });
  ASSERT_TRUE(connection->call("RMAC_CAM.Ok"));
  ASSERT_TRUE(connection->wait([&] { return heard.size() == 2; }));
  EXPECT_THAT(heard, ElementsAre("state1", "events2"));
}

TEST_F(ConnectionTest, AnswersAllOpenRequestsWithAFailureWhenItEnds) {
  appliance_.handles("RMAC_CAM.StopNow", [&](const json&) {
    appliance_.hang_up();
    return gateway::Answer(true);
  });
  const auto connection = open();
  std::vector<std::string> failures;
  const auto note = [&](const Connection::Answer& answer) { failures.push_back(answer ? "" : answer.error().message); };
  connection->send("RMAC_CAM.StopNow", json::object(), note);
  connection->send("RMAC_CAM.Ok", json::object(), note);
  const auto waited = connection->wait([] { return false; });
  ASSERT_FALSE(waited);
  ASSERT_EQ(failures.size(), 2U);
  EXPECT_THAT(failures[0], HasSubstr("the connection to " + appliance_.endpoint().socket + " ended: "));
  EXPECT_EQ(failures[1], failures[0]);
  connection->send("RMAC_CAM.Ok", json::object(), note);
  EXPECT_EQ(failures.size(), 3U) << "and so is what is asked later";
}

TEST_F(ConnectionTest, HearsAPersonWhileItWaits) {
  const auto connection = open();
  std::vector<std::string> lines;
  connection->on_entered_line(appliance_.terminal(), [&](const std::string& line) { lines.push_back(line); });
  appliance_.type("2.5");
  appliance_.type("");
  ASSERT_TRUE(connection->wait([&] { return lines.size() == 2; }));
  EXPECT_THAT(lines, ElementsAre("2.5", ""));
}

}  // namespace
}  // namespace rmac::cli
