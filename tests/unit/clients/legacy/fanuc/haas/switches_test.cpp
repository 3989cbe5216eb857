#include <gmock/gmock.h>

#include "unit/clients/legacy/fanuc/haas/imported.hpp"

namespace rmac::fanuc::haas {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

Options of_outputs() {
  Options options;
  options.outputs = {{88, "Through"}, {73, "Air"}, {83, "Jet"}};
  return options;
}

/// What is switched between lines, changes of tools and stops, in their order.
std::vector<std::string> switches_in(const legacy::Imported& imported) {
  std::vector<std::string> all;
  for (const auto& request : imported.requests) {
    const std::string method = request["method"].get<std::string>().substr(9);
    for (const auto& call : request["params"].value("Calls", nlohmann::json::array())) {
      const auto& params = call.value("params", nlohmann::json::object());
      if (call["method"] == "RMAC_CAM.SetOutput")
        all.push_back(params["Name"].get<std::string>() + (params["On"] ? "+" : "-"));
      if (call["method"] == "RMAC_CAM.TurnCoolantOn") all.emplace_back("flood+");
      if (call["method"] == "RMAC_CAM.TurnCoolantOff") all.emplace_back("flood-");
      if (call["method"] == "RMAC_CAM.SetSpindleRPM") all.emplace_back(params["RPM"] == 0 ? "spindle-" : "spindle+");
    }
    if (method == "DoToolChange") all.emplace_back("tool");
    if (method == "MoveAlongLine") all.emplace_back("line");
    if (method == "ProgramStop") all.emplace_back("stop");
  }
  return all;
}

std::vector<std::string> switched(const std::string& lines) {
  return switches_in(done(lines, of_outputs()));
}

TEST(HaasSwitch, IsNamedAndGoesOffWithTheToolAndTheProgram) {
  Options options = of_outputs();
  EXPECT_THAT(switched("M88\nG1 X1. M89\nM89"), ElementsAre("Through+", "line", "Through-"));
  EXPECT_THAT(switched("G1 X1. M73\nX2. M74 M83"), ElementsAre("Air+", "line", "Jet+", "line", "Air-", "Jet-"));
  EXPECT_THAT(switched("M88\nM88\nT1 M6"), ElementsAre("Through+", "Through-", "tool"));
  EXPECT_THAT(switched("M89\nM74\nM84"), ElementsAre());
  EXPECT_THAT(refusal("M88 M89", options), StartsWith("5:5: what M88 switches is switched twice"));
  EXPECT_THAT(refusal("M88"), StartsWith("5:1: which output of the machine is coolant through the spindle"));
  options.tool_diameters_mm = {{1, 4}};
  EXPECT_THAT(refusal("G1 G41 D1 X10.\nM88\nY20.\nG40 X0", options),
              StartsWith("6:1: cutter radius compensation is on"));
}

TEST(HaasSwitch, GoesOffWithTheSecondPercentSign) {
  const std::string program = "%\nO1\nG21 G90\nS900 M3\nM8 M88\nG0 X0 Y0 Z1.\nM83\n%\n";
  EXPECT_THAT(switches_in(imported(program, of_outputs(), Dialect::Haas)),
              ElementsAre("spindle+", "Through+", "flood+", "Jet+", "Jet-", "Through-", "spindle-", "flood-"));
  Options options = of_outputs();
  options.assume_end = true;
  EXPECT_THAT(switches_in(imported("O1\nG21 G90\nM88\n", options, Dialect::Haas)), ElementsAre("Through+", "Through-"));
}

TEST(HaasSwitch, IsNotSwitchedOnBesideWhatSwitchesItOff) {
  for (const std::string beside : {"T1 M6", "T1 M16", "M30", "M2", "M0", "M1"})
    EXPECT_THAT(refusal(beside + " M88", of_outputs()), HasSubstr("M88 beside M")) << beside;
  EXPECT_THAT(refusal("T1 M6 M88", of_outputs()), StartsWith("5:7: M88 beside M6"));
  EXPECT_THAT(switched("M88\nT1 M6 M89"), ElementsAre("Through+", "Through-", "tool"));
}

/// A Haas stops coolant of all kinds there, and by M0 the spindle.
TEST(HaasSwitch, GoesOffWhereTheProgramStops) {
  EXPECT_THAT(switched("S900 M3\nM88\nM73\nM83\nM8\nM0"),
              ElementsAre("spindle+", "Through+", "Air+", "Jet+", "flood+", "Air-", "Jet-", "Through-", "spindle-",
                          "flood-", "stop"));
  EXPECT_THAT(switched("S900 M3 M8\nM88\nG1 X1. M1"),
              ElementsAre("spindle+", "flood+", "Through+", "line", "Through-", "flood-", "stop", "spindle-"));
  EXPECT_THAT(switched("M88\n#3006=1 (LOOK)"), ElementsAre("Through+", "Through-", "stop"));
  EXPECT_THAT(switched("S900 M3\nM88\nM5\nM89"), ElementsAre("spindle+", "Through+", "spindle-", "Through-"))
      << "M5 is of the spindle alone";
  EXPECT_THAT(switches_in(imported(program_of("S900 M3\nM8\nM0\nM5"))),
              ElementsAre("spindle+", "flood+", "stop", "spindle-", "flood-"))
      << "a Fanuc's builder says what M0 stops beside the program";
}

}  // namespace
}  // namespace rmac::fanuc::haas
