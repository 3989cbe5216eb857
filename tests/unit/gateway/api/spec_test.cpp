// The method table against the dissertation's functions and our enumerations, as the specification lists them.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "gateway/api/methods/method_table.hpp"
#include "gateway/api/methods/openrpc.hpp"
#include "places.hpp"

namespace rmac::gateway {
namespace {

using nlohmann::json;

json fixture(const std::string& name) {
  std::ifstream file(std::string(RMAC_SOURCE_DIR) + "/tests/unit/gateway/api/fixtures/" + name);
  EXPECT_TRUE(file) << name;
  return json::parse(file);
}

/// Kept, so that loops over it do not outlive it.
const json& specified_functions() {
  static const json kFunctions = fixture("rmac_api.json").at("functions");
  EXPECT_EQ(kFunctions.size(), 147U);
  return kFunctions;
}

std::string wire_name(const json& function) {
  return function["interface"].get<std::string>() + "." + function["name"].get<std::string>();
}

TEST(MethodTable, HasEveryFunctionOfTheDissertation) {
  std::set<std::string> wanted;
  for (const json& function : specified_functions()) wanted.insert(wire_name(function));
  std::set<std::string> ours;
  for (const Method& entry : method_table()) {
    if (entry.origin == Origin::Dissertation) ours.insert(entry.name);
  }
  EXPECT_EQ(wanted.size(), 143U);
  EXPECT_EQ(ours, wanted);
}

TEST(MethodTable, HasEachNameOnce) {
  std::set<std::string> names;
  for (const Method& entry : method_table()) EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
}

TEST(MethodTable, HasTheSpecifiedParametersInOrder) {
  for (const json& function : specified_functions()) {
    const Method* entry = find_method(wire_name(function));
    ASSERT_NE(entry, nullptr) << wire_name(function);
    std::vector<ParameterSpec> parameters = entry->parameters;
    if (function.value("access", "") == "get") {
      ASSERT_TRUE(entry->property) << entry->name;
      ASSERT_EQ(parameters.back().name, "newVal");
      EXPECT_TRUE(parameters.back().optional) << entry->name;
      parameters.pop_back();
    }
    ASSERT_GE(parameters.size(), function["params"].size()) << entry->name;
    for (std::size_t i = function["params"].size(); i < parameters.size(); ++i) {
      EXPECT_TRUE(parameters[i].optional) << entry->name << ": " << parameters[i].name << " is ours";
    }
    for (std::size_t i = 0; i < function["params"].size(); ++i) {
      EXPECT_EQ(parameters[i].name, function["params"][i]["name"]) << entry->name;
      EXPECT_EQ(to_string(parameters[i].type), function["params"][i]["type"]) << entry->name << parameters[i].name;
    }
  }
}

TEST(MethodTable, HasTheSpecifiedResults) {
  for (const json& function : specified_functions()) {
    const Method* entry = find_method(wire_name(function));
    ASSERT_NE(entry, nullptr);
    if (function.value("access", "") == "put") {
      EXPECT_EQ(function["result"], "boolean") << "writing a property gives true";
      continue;
    }
    EXPECT_EQ(to_string(entry->result.type), function["result"]) << entry->name;
  }
}

TEST(MethodTable, SaysWhatEachMethodMeansAndDoes) {
  for (const Method& entry : method_table()) {
    EXPECT_FALSE(entry.meaning.empty()) << entry.name;
    EXPECT_TRUE(entry.handler) << entry.name;
  }
}

TEST(MethodTable, StopsNeedNoAuthority) {
  std::set<std::string> stops;
  for (const Method& entry : method_table()) {
    if (entry.permission == Permission::Stop) stops.insert(entry.name);
  }
  EXPECT_EQ(stops, (std::set<std::string>{"RMAC_CAM.CycleStop", "RMAC_CAM.SetCycleStopStatus", "RMAC_CAM.StopNow",
                                          "RMAC_CAM.FeedHold", "authority.release"}));
}

// Red when the operator, beside the program, may start anything but what goes on with it.
TEST(MethodTable, LetsTheOperatorGoOnWithTheProgramAndNoMore) {
  std::set<std::string> operators;
  for (const Method& entry : method_table()) {
    if (entry.permission == Permission::Operator) operators.insert(entry.name);
  }
  EXPECT_EQ(operators, (std::set<std::string>{"RMAC_CAM.FeedResume", "RMAC_CAM.FeedRetrace", "RMAC_CAM.SetFeedOverride",
                                              "RMAC_CAM.SetOptionalStop"}));
}

std::set<std::string> methods_that(Effect effect) {
  std::set<std::string> names;
  for (const Method& entry : method_table()) {
    if (entry.effect == effect) names.insert(entry.name);
  }
  return names;
}

TEST(MethodTable, SaysWhatStartsMotionAndWhatStopsIt) {
  using Names = std::set<std::string>;
  EXPECT_EQ(methods_that(Effect::Stops), (Names{"RMAC_CAM.StopNow", "authority.release"}));
  EXPECT_EQ(methods_that(Effect::Holds),
            (Names{"RMAC_CAM.CycleStop", "RMAC_CAM.SetCycleStopStatus", "RMAC_CAM.FeedHold"}));
  const Names starts = methods_that(Effect::Starts);
  for (const char* name : {"RMAC_CAM.CycleStart", "RMAC_CAM.SetCycleStartStatus", "RMAC_CAM.FeedResume",
                           "RMAC_CAM.Reset", "RMAC_CAM.Home", "RMAC_CAM.JogJoint", "RMAC_CAM.JogPath",
                           "RMAC_CAM.FeedRetrace", "RMAC_CAM.SetSpindleRPM", "Device.Load", "RMAC_Config.Apply"}) {
    EXPECT_TRUE(starts.contains(name)) << name;
  }
  for (const Method& entry : method_table()) {
    const std::string function = entry.name.substr(entry.name.find('.') + 1);
    const bool is_a_move =
        function.starts_with("MoveAlong") || function.starts_with("Machine_MoveIn") || function.ends_with("Target");
    if (is_a_move) {
      EXPECT_EQ(entry.effect, Effect::Queues) << entry.name;
    }
    const bool stops = entry.effect == Effect::Holds || entry.effect == Effect::Stops;
    EXPECT_EQ(stops, entry.permission == Permission::Stop) << entry.name;
    // The person who changed the tool says so, from whatever terminal is near; what goes on then is its holder's queue.
    const bool is_said_by_anyone = entry.name == "RMAC_CAM.ConfirmToolChange";
    if (entry.permission == Permission::Operator) continue;
    if ((entry.effect == Effect::Starts || entry.effect == Effect::Queues) && !is_said_by_anyone) {
      EXPECT_EQ(entry.permission, Permission::Authority) << entry.name;
    }
  }
}

TEST(Enumerations, HaveTheSpecifiedValues) {
  const json spec = fixture("enums.json");
  std::size_t compared = 0;
  for (const Enumeration* values : enumerations()) {
    if (!spec.contains(values->name)) continue;
    std::map<std::string, std::int64_t> wanted = spec[values->name];
    std::map<std::string, std::int64_t> ours;
    for (const auto& value : values->values) ours[value.name] = value.number;
    EXPECT_EQ(ours, wanted) << values->name;
    ++compared;
  }
  EXPECT_EQ(compared, 10U);
}

TEST(OpenRpc, MarksOriginAndEffectOfEveryMethod) {
  const json& document = openrpc_document();
  ASSERT_EQ(document["methods"].size(), method_table().size());
  for (const json& entry : document.at("methods")) {
    const Method* declared = find_method(entry["name"].get<std::string>());
    ASSERT_NE(declared, nullptr);
    EXPECT_EQ(entry["x-origin"], to_string(declared->origin));
    EXPECT_EQ(entry["x-effect"], to_string(declared->effect)) << declared->name;
    EXPECT_EQ(entry.contains("x-no-effect-with"), declared->harmless.has_value()) << declared->name;
    EXPECT_EQ(entry["params"].size(), declared->parameters.size());
  }
}

TEST(ApiPage, IsTheOneInDocs) {
  std::ifstream file(std::string(RMAC_SOURCE_DIR) + "/docs/api.md");
  const std::string written((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_TRUE(written == api_page()) << "docs/api.md is stale; write it again with rmacd --print-api > docs/api.md";
}

}  // namespace
}  // namespace rmac::gateway
