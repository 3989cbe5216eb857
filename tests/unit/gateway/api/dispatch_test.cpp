#include <gtest/gtest.h>

#include "gateway/api/methods/method_table.hpp"
#include "session.hpp"

namespace rmac::gateway {
namespace {

using fakes::Api;
using nlohmann::json;
using testing::_;
using testing::HasSubstr;
using testing::Return;

TEST(ParseLine, NamesNanAsNoJson) {
  const auto parsed =
      parse_line(R"({"jsonrpc":"2.0","id":1,"method":"RMAC_CAM.SetFeedrate","params":{"Feedrate":NaN}})");
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().code, rpc_code::kParseError);
  EXPECT_THAT(parsed.error().message, HasSubstr("NaN"));
}

TEST(ParseLine, RefusesNumbersBeyondDouble) {
  const auto parsed = parse_line(R"({"a":1e999})");
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().code, rpc_code::kParseError);
}

TEST(ParseLine, RefusesDeepNesting) {
  const auto parsed = parse_line(std::string(100000, '['));
  ASSERT_FALSE(parsed);
  EXPECT_THAT(parsed.error().message, HasSubstr("nested 100000 deep"));
}

// Red when a line of 8 MiB took 200 of memory.
TEST(ParseLine, RefusesWhatWouldGrowBeyondMeasure) {
  for (const std::string element : {"[]", "{}", R"("")", R"({"":0})"}) {
    std::string line = "[" + element;
    while (line.size() < std::size_t{8} << 20U) line += "," + element;
    const auto parsed = parse_line(line + "]");
    ASSERT_FALSE(parsed) << element;
    EXPECT_EQ(parsed.error().code, rpc_code::kRequestTooLarge) << element;
    EXPECT_THAT(parsed.error().message, HasSubstr("MiB of memory")) << element;
  }
  std::string points = "[[0.125,0.5,0.25]";
  while (points.size() < (std::size_t{8} << 20U) - 1) points += ",[0.125,0.5,0.25]";
  EXPECT_TRUE(parse_line(points + "]")) << "a long curve";
}

TEST(ParseLine, DoesNotCountBracketsInsideTexts) {
  EXPECT_TRUE(parse_line("\"" + std::string(1000, '[') + R"(\"[[[")"));
}

TEST(ReadRequest, RefusesWhatIsNotARequest) {
  for (const char* text :
       {"1", "\"a\"", "null", "{}", R"({"jsonrpc":"2.0"})", R"({"jsonrpc":"1.0","id":1,"method":"hello"})",
        R"({"jsonrpc":"2.0","id":1,"method":7})", R"({"jsonrpc":"2.0","id":[1],"method":"hello"})"}) {
    const Request request = read_request(json::parse(text));
    ASSERT_TRUE(request.error) << text;
    EXPECT_EQ(request.error->code, rpc_code::kInvalidRequest) << text;
  }
}

TEST(ParseLine, RefusesAMemberThatStandsTwiceAndNamesIt) {
  for (const char* text :
       {R"({"id":1,"id":2})", R"([{"id":1},{"id":1,"x":{"id":3,"i\u0064":4}}])", R"({"id":":{\":","id":"a:b"})"}) {
    const auto parsed = parse_line(text);
    ASSERT_FALSE(parsed) << text;
    EXPECT_EQ(parsed.error().code, rpc_code::kInvalidRequest);
    EXPECT_THAT(parsed.error().message, HasSubstr("\"id\" stands twice")) << text;
  }
  EXPECT_TRUE(parse_line(R"([{"a":{"a":":"}},{"a":[{"b:":1},{"b:":2}]}])"));
}

TEST(ReadRequest, RefusesIdsThatWouldComeBackAltered) {
  for (const char* id : {"18446744073709551616", "-9223372036854775809", "1.5", "1e3"}) {
    const Request request =
        read_request(json::parse(std::string(R"({"jsonrpc":"2.0","method":"hello","id":)") + id + "}"));
    ASSERT_TRUE(request.error) << id;
    EXPECT_EQ(request.error->code, rpc_code::kInvalidRequest);
    EXPECT_TRUE(request.id.is_null());
  }
  for (const char* id : {"18446744073709551615", "-9223372036854775808", "\"x\"", "null", "0"}) {
    const Request request =
        read_request(json::parse(std::string(R"({"jsonrpc":"2.0","method":"hello","id":)") + id + "}"));
    EXPECT_FALSE(request.error) << id;
    EXPECT_EQ(request.id.dump(), id);
  }
}

TEST(ReadRequest, RefusesUnknownMembersAndKeepsTheId) {
  const Request request = read_request(json::parse(R"({"jsonrpc":"2.0","id":7,"method":"hello","parms":{}})"));
  ASSERT_TRUE(request.error);
  EXPECT_EQ(request.error->code, rpc_code::kInvalidRequest);
  EXPECT_THAT(request.error->message, HasSubstr("\"parms\""));
  EXPECT_EQ(request.id, 7);
}

TEST(Dispatcher, NamesAnUnknownMethod) {
  Api api;
  EXPECT_THAT(api.refusal("RMAC_CAM.Fly", "{}", rpc_code::kMethodNotFound), HasSubstr("RMAC_CAM.Fly"));
}

TEST(Dispatcher, TakesParametersByNameAndByPosition) {
  Api api;
  EXPECT_CALL(api.machine.cam_mock.spindles_mock, set_rpm(2, 900)).Times(2).WillRepeatedly(Return(Expected<>{}));
  EXPECT_TRUE(api.result("RMAC_CAM.SetSpindleRPM", R"({"RPM":900,"SpindleNumber":2})").is_null());
  EXPECT_TRUE(api.result("RMAC_CAM.SetSpindleRPM", "[2, 900]").is_null());
}

TEST(Dispatcher, NamesUnknownMissingAndSurplusParameters) {
  Api api;
  EXPECT_THAT(api.refusal("RMAC_CAM.SetFeedrate", R"({"Feed":1})", rpc_code::kInvalidParams),
              testing::AllOf(HasSubstr("unknown parameter \"Feed\""), HasSubstr("Feedrate")));
  EXPECT_THAT(api.refusal("RMAC_CAM.SetFeedrate", "{}", rpc_code::kInvalidParams),
              HasSubstr("parameter \"Feedrate\" is missing"));
  EXPECT_THAT(api.refusal("RMAC_CAM.SetFeedrate", "[1,2]", rpc_code::kInvalidParams), HasSubstr("2 parameters given"));
  EXPECT_THAT(api.refusal("RMAC_CAM.SetFeedrate", "5", rpc_code::kInvalidParams), HasSubstr("params is 5"));
}

TEST(Dispatcher, NamesParameterValueAndWhatIsExpected) {
  Api api;
  EXPECT_CALL(api.machine.cam_mock.path_mock, set_feedrate(_)).Times(0);
  EXPECT_EQ(api.refusal("RMAC_CAM.SetFeedrate", R"({"Feedrate":"fast"})", rpc_code::kInvalidParams),
            "parameter \"Feedrate\" is \"fast\", expected a number 0.01 to 1000000 mm/min");
  EXPECT_EQ(api.refusal("RMAC_CAM.SetFeedrate", R"({"Feedrate":0})", rpc_code::kInvalidParams),
            "parameter \"Feedrate\" is 0, expected a number 0.01 to 1000000 mm/min");
  EXPECT_EQ(api.refusal("RMAC_CAM.SetFeedOverride", R"({"Percent":201})", rpc_code::kInvalidParams),
            "parameter \"Percent\" is 201, expected a number 0 to 200 %");
  EXPECT_EQ(api.refusal("RMAC_CAM.JogJoint", R"({"JntNum":32,"Distance":1})", rpc_code::kInvalidParams),
            "parameter \"JntNum\" is 32, expected an integer 0 to 31");
  EXPECT_EQ(api.refusal("RMAC_CAM.JogJoint", R"({"JntNum":0.5,"Distance":1})", rpc_code::kInvalidParams),
            "parameter \"JntNum\" is 0.5, expected an integer 0 to 31");
  EXPECT_EQ(api.refusal("RMAC_CAM.SetAnimation", R"({"mode":1})", rpc_code::kInvalidParams),
            "parameter \"mode\" is 1, expected true or false");
}

TEST(Dispatcher, TakesNamedValuesByNumberAndByName) {
  Api api;
  EXPECT_CALL(api.machine.cam_mock.cycle_mock, start(sdk::CycleMode::Automatic))
      .Times(2)
      .WillRepeatedly(Return(Expected<>{}));
  EXPECT_EQ(api.result("RMAC_CAM.CycleStart", R"({"Mode":1})"), true);
  EXPECT_EQ(api.result("RMAC_CAM.CycleStart", R"({"Mode":"AUTOMATIC"})"), true);
  EXPECT_EQ(api.refusal("RMAC_CAM.CycleStart", R"({"Mode":"FAST"})", rpc_code::kInvalidParams),
            "parameter \"Mode\" is \"FAST\", expected one of MANUAL (0), AUTOMATIC (1)");
}

TEST(Dispatcher, RefusesToMoveWithoutAuthorityButStopsForAnyone) {
  Api api;
  api.session.authority = false;
  EXPECT_CALL(api.machine.cam_mock.queue_mock, add(_, _)).Times(0);
  EXPECT_CALL(api.machine.cam_mock.cycle_mock, stop()).WillOnce(Return(Expected<>{}));
  EXPECT_CALL(api.machine.cam_mock.cycle_mock, hold()).WillOnce(Return(Expected<>{}));
  EXPECT_CALL(api.machine.cam_mock.cycle_mock, stop_now()).WillOnce(Return(Expected<>{}));
  EXPECT_THAT(api.refusal("RMAC_CAM.MoveToPathTarget", R"({"MoveID":1,"TargetFrame":{"p":[0,0,0],"axis":[0,0,1]}})",
                          rpc_code::kAuthorityRequired),
              HasSubstr("another holds it"));
  EXPECT_EQ(api.result("RMAC_CAM.CycleStop", R"({"Mode":1})"), true);
  EXPECT_EQ(api.result("RMAC_CAM.FeedHold"), true);
  EXPECT_EQ(api.result("RMAC_CAM.StopNow"), true);
}

TEST(Dispatcher, PassesTheMachinesRefusalOnWithItsMinorCode) {
  Api api;
  EXPECT_CALL(api.machine.cam_mock.path_mock, set_feedrate(9000))
      .WillOnce(Return(failure(MinorCode::SpeedLimit, "9000 mm/min is over the maximum of 2000 mm/min")));
  const json error = api.call("RMAC_CAM.SetFeedrate", "[9000]")["error"];
  EXPECT_EQ(error["code"], -32005);
  EXPECT_EQ(error["message"], "9000 mm/min is over the maximum of 2000 mm/min");
  EXPECT_EQ(error["data"]["minorCode"], 5);
  EXPECT_EQ(error["data"]["minorName"], "MACHINE_ERR_SPEED_LIMIT");
}

TEST(Dispatcher, KeepsTheLastErrorOfTheMachineUntilItIsCleared) {
  Api api;
  EXPECT_EQ(api.result("RMAC_CAM.Ok"), true);
  EXPECT_CALL(api.machine.cam_mock.positioning_mock, home()).WillOnce(Return(failure(MinorCode::TravelLimit, "no")));
  EXPECT_TRUE(api.call("RMAC_CAM.Home").contains("error"));
  EXPECT_EQ(api.result("RMAC_CAM.Ok"), false);
  EXPECT_EQ(api.result("RMAC_CAM.StatusMajorCode"), 1);
  EXPECT_EQ(api.result("RMAC_CAM.StatusMinorCode"), 4);
  EXPECT_EQ(api.result("RMAC_CAM.StatusMajorCode", R"({"newVal":"MACHINE_SUCCESS"})"), true);
  EXPECT_EQ(api.result("RMAC_CAM.Ok"), true);
  EXPECT_EQ(api.result("RMAC_CAM.StatusMinorCode"), 0);
}

// Red when a stranger's OnNextRecord made the holder's Ok false.
TEST(Dispatcher, KeepsWhatAStrangerGetsWrongFromTheMachinesStatus) {
  Api api;
  api.session.authority = false;
  EXPECT_TRUE(api.call("DeviceDriverManager.OnNextRecord").contains("error"));
  EXPECT_EQ(api.result("RMAC_CAM.Ok"), true);
  EXPECT_CALL(api.machine.cam_mock.cycle_mock, stop_now()).WillOnce(Return(failure(MinorCode::Other, "no")));
  EXPECT_TRUE(api.call("RMAC_CAM.StopNow").contains("error"));
  EXPECT_EQ(api.result("RMAC_CAM.Ok"), false) << "a stop that failed is everybody's business";
}

TEST(Dispatcher, NeedsAuthorityToWriteAPropertyButNotToReadIt) {
  Api api;
  api.session.authority = false;
  EXPECT_EQ(api.result("RMAC_CAM.StatusMinorCode"), 0);
  api.refusal("RMAC_CAM.StatusMinorCode", R"({"newVal":0})", rpc_code::kAuthorityRequired);
}

/// A value that every parameter of this type accepts.
json sample_of(const ParameterSpec& parameter) {
  if (parameter.enumeration != nullptr) return parameter.enumeration->values[0].number;
  switch (parameter.type) {
    case WireType::Boolean:
      return true;
    case WireType::Integer:
    case WireType::Number:
    case WireType::Mask:
      return json::parse("1");
    case WireType::String:
      return "Fake";
    case WireType::Numbers:
      return json::parse("[1]");
    case WireType::Strings:
      return json::parse(R"(["events"])");
    case WireType::Vector:
      return json::parse("[1,2,3]");
    case WireType::Frame:
    case WireType::JointTarget:
      return json::parse(R"({"p":[0,0,0],"q":[1,0,0,0]})");
    case WireType::Nurbs:
      return json::parse(R"({"degree":1,"knots":[0,0,1,1],"points":[[0,0,0],[1,0,0]]})");
    case WireType::NurbsNd:
      return json::parse(R"({"degree":1,"knots":[0,0,1,1],"points":[[0,0],[1,0]],"space":"joint"})");
    default:
      return json();
  }
}

TEST(Dispatcher, AnswersUnsupportedForNoFunctionOfTheSpec) {
  for (const Method& entry : method_table()) {
    Api api;
    EXPECT_TRUE(api.session.records_fake.open());
    ON_CALL(api.machine.cam_mock.positioning_mock, current_position()).WillByDefault(Return(std::vector<double>{}));
    ON_CALL(api.machine.cam_mock.spindles_mock, rpm(_)).WillByDefault(Return(0.0));
    ON_CALL(api.machine.cam_mock.spindles_mock, max_rpm(_)).WillByDefault(Return(0.0));
    ON_CALL(api.machine.cam_mock.queue_mock, joints_at(_)).WillByDefault(Return(std::vector<double>{}));
    const sdk::DeviceObject draft;
    ON_CALL(api.machine.config_mock, draft()).WillByDefault(testing::ReturnRef(draft));
    json params = json::object();
    for (const ParameterSpec& parameter : entry.parameters) {
      if (!parameter.optional || parameter.name == "Distance") params[parameter.name] = sample_of(parameter);
    }
    const json response = api.call(entry.name, params.dump());
    const bool unsupported = response.contains("error") && response["error"]["data"]["minorCode"] == 16;
    EXPECT_FALSE(unsupported) << entry.name << ": " << response.dump();
  }
}

TEST(Dispatcher, ChecksTypesOfEveryParameterOfEveryMethod) {
  // An object with a member that nothing knows fits no type at all, but for one that a schema is to look into.
  const auto wrong = [](const ParameterSpec& parameter) {
    return parameter.type == WireType::Object ? json(7) : json::parse(R"({"no such member":[]})");
  };
  for (const Method& entry : method_table()) {
    for (std::size_t bad = 0; bad < entry.parameters.size(); ++bad) {
      Api api;
      json params = json::object();
      for (std::size_t i = 0; i < entry.parameters.size(); ++i) {
        const ParameterSpec& parameter = entry.parameters[i];
        if (i == bad) params[parameter.name] = wrong(parameter);
        if (i != bad && !parameter.optional) params[parameter.name] = sample_of(parameter);
      }
      EXPECT_THAT(api.refusal(entry.name, params.dump(), rpc_code::kInvalidParams),
                  HasSubstr("\"" + entry.parameters[bad].name + "\""))
          << entry.name;
    }
  }
}

TEST(Operator, MayGoOnWithTheProgramBesideWhoHoldsAuthority) {
  Api api;
  api.session.authority = false;
  for (const char* call : {"RMAC_CAM.FeedResume {}", "RMAC_CAM.FeedRetrace {\"Distance\":2}",
                           "RMAC_CAM.SetFeedOverride {\"Percent\":50}"}) {
    const std::string text(call);
    const std::size_t space = text.find(' ');
    EXPECT_THAT(api.refusal(text.substr(0, space), text.substr(space + 1), rpc_code::kAuthorityRequired),
                HasSubstr("operator.acquire"));
  }
  EXPECT_CALL(api.machine.operating_mock, resume(_)).WillOnce(Return(Expected<>{}));
  EXPECT_CALL(api.machine.operating_mock, retrace(2, _)).WillOnce(Return(Expected<double>(2)));
  EXPECT_CALL(api.machine.operating_mock, set_feed_override(50, _)).WillOnce(Return(Expected<>{}));
  api.session.client = "panel";
  EXPECT_EQ(api.result("operator.acquire")["name"], "panel");
  api.result("RMAC_CAM.FeedResume");
  api.result("RMAC_CAM.FeedRetrace", R"({"Distance":2})");
  api.result("RMAC_CAM.SetFeedOverride", R"({"Percent":50})");
  EXPECT_THAT(api.session.told,
              testing::ElementsAre("resumes", "runs back up to 2 mm along the path", "sets the feed override to 50 %"));
  EXPECT_THAT(api.refusal("RMAC_CAM.JogJoint", "[0,1]", rpc_code::kAuthorityRequired), HasSubstr("motion authority"));
}

TEST(Operator, HoldsInTheirOwnNameAndOthersInNobodys) {
  Api api;
  api.session.authority = false;
  api.machine.now.state = CycleState::Running;
  EXPECT_CALL(api.machine.cam_mock.cycle_mock, hold()).WillOnce(Return(Expected<>{}));
  api.result("RMAC_CAM.FeedHold");
  api.result("operator.acquire");
  EXPECT_CALL(api.machine.operating_mock, hold(api.session.holds_as())).WillOnce(Return(Expected<>{}));
  api.result("RMAC_CAM.FeedHold");
  EXPECT_EQ(api.session.told, (std::vector<std::string>{"holds the machine", "holds the machine as the operator"}));
}

// Red when a client that holds at every turn of its loop fills everybody's lines.
TEST(Operator, IsNotToldOfAHoldThatHoldsNothing) {
  Api api;
  api.session.authority = false;
  for (int i = 0; i < 3; ++i) api.result("RMAC_CAM.FeedHold");
  EXPECT_TRUE(api.session.told.empty());
}

TEST(Operator, IsNotInItsOwnWayWhereItHoldsAuthorityToo) {
  Api api;
  api.result("operator.acquire");
  {
    const testing::InSequence order;
    EXPECT_CALL(api.machine.operating_mock, let_go());
    EXPECT_CALL(api.machine.cam_mock.cycle_mock, start(_)).WillOnce(Return(Expected<>{}));
    EXPECT_CALL(api.machine.operating_mock, let_go());
    EXPECT_CALL(api.machine.cam_mock.parking_mock, park()).WillOnce(Return(Expected<>{}));
  }
  api.result("RMAC_CAM.CycleStart", "[1]");
  api.result("RMAC_CAM.ParkProgram");
  api.result("operator.release");
  EXPECT_CALL(api.machine.operating_mock, let_go()).Times(0);
  EXPECT_CALL(api.machine.cam_mock.cycle_mock, start(_)).WillOnce(Return(Expected<>{}));
  api.result("RMAC_CAM.CycleStart", "[1]");
}

TEST(LastError, IsToldWithItsTimeUntilAResetOrTheCodesAreCleared) {
  Api api;
  EXPECT_TRUE(api.result("RMAC_CAM.GetState")["last_error"].is_null());
  api.machine.now.t_s = 12.5;
  const auto fail = [&] {
    EXPECT_CALL(api.machine.cam_mock.positioning_mock, home())
        .WillOnce(Return(failure(MinorCode::TravelLimit, "Home: X is beyond its limit")));
    api.call("RMAC_CAM.Home");
  };
  fail();
  api.machine.now.t_s = 20;
  EXPECT_EQ(api.result("RMAC_CAM.GetState")["last_error"],
            (json{{"status_minor", 4}, {"t_s", 12.5}, {"message", "Home: X is beyond its limit"}}));
  EXPECT_CALL(api.machine.cam_mock.cycle_mock, reset()).Times(0);
  EXPECT_EQ(api.result("RMAC_CAM.Reset"), true) << "without a fault it acknowledges";
  EXPECT_EQ(api.result("RMAC_CAM.Ok"), true);
  EXPECT_TRUE(api.result("RMAC_CAM.GetState")["last_error"].is_null());
  fail();
  api.machine.cycle.state = CycleState::Faulted;
  EXPECT_CALL(api.machine.cam_mock.cycle_mock, reset())
      .WillOnce(Return(failure(MinorCode::Other, "reset: the stop is still pressed")))
      .WillOnce(Return(Expected<>{}));
  EXPECT_FALSE(api.call("RMAC_CAM.Reset").contains("result"));
  EXPECT_EQ(api.result("RMAC_CAM.Ok"), false);
  EXPECT_EQ(api.result("RMAC_CAM.Reset"), true);
  EXPECT_EQ(api.result("RMAC_CAM.Ok"), true);
}

TEST(State, NamesOperatorHolderWhatTheCycleWaitsForAndWhatWasCleaned) {
  Api api;
  api.session.client = "panel";
  api.result("operator.acquire");
  api.machine.cycle.held_by = "panel";
  api.machine.cycle.waits_for = "moves";
  api.machine.cycle.cleaned = {3, 4};
  const json state = api.result("RMAC_CAM.GetState");
  EXPECT_EQ(state["operator"], "panel");
  EXPECT_EQ(state["held_by"], "panel");
  EXPECT_EQ(state["waits_for"], "moves");
  EXPECT_EQ(state["cleaned"], (json{{"without_motion", 3}, {"merged", 4}}));
}

TEST(State, TellsHowFarAheadMotionIsPlannedAndWhyNoFurther) {
  Api api;
  api.machine.now.horizon = {0.031, HorizonLimit::HeldBack};
  const json state = api.result("RMAC_CAM.GetState");
  EXPECT_EQ(state["horizon_s"], 0.031);
  EXPECT_EQ(state["horizon_limit"], "held_back");
}

}  // namespace
}  // namespace rmac::gateway
