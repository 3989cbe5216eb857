#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "conformance/digital_io_conformance.hpp"
#include "rmac/fieldbus/gpio/gpio_interface.hpp"

// The GPIO adapter on a chip that the kernel simulates (gpio-guest.sh sets it up): lines estop-nc, estop-no, probe,
// coolant, release and, without a name, 5. Levels are set and read through the simulator's own files, beside libgpiod.
namespace {

using namespace std::chrono_literals;
using namespace rmac;
using namespace rmac::fieldbus::gpio;
using testing::HasSubstr;

std::filesystem::path line_folder(int line) {
  for (const auto& device : std::filesystem::directory_iterator("/sys/devices/platform")) {
    if (!device.path().filename().string().starts_with("gpio-sim.")) continue;
    for (const auto& chip : std::filesystem::directory_iterator(device)) {
      const auto found = chip.path() / ("sim_gpio" + std::to_string(line));
      if (std::filesystem::exists(found)) return found;
    }
  }
  return {};
}

void pull(int line, bool up) {
  std::ofstream(line_folder(line) / "pull") << (up ? "pull-up" : "pull-down");
}

int value(int line) {
  int level = -1;
  std::ifstream(line_folder(line) / "value") >> level;
  return level;
}

/// What a program prints.
std::string said_by(const std::string& command) {
  FILE* const output = popen((command + " 2>&1").c_str(), "r");
  std::string text;
  for (int byte = fgetc(output); byte != EOF; byte = fgetc(output)) text += static_cast<char>(byte);
  pclose(output);
  return text;
}

std::unique_ptr<GpioInterface> make(const std::map<std::string, std::string>& lines, double debounce_ms = 20) {
  auto texts = lines;
  texts["chip"] = "io";
  auto config = read_gpio_config({{"debounce_ms", {debounce_ms}}}, texts);
  EXPECT_TRUE(config) << config.error().message;
  return std::make_unique<GpioInterface>(std::move(*config), make_kernel_lines());
}

std::string refusal(const std::map<std::string, std::string>& lines) {
  const auto io = make(lines);
  const auto started = io->start();
  return started ? "nothing" : started.error().message;
}

class GpioOnSim : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_FALSE(line_folder(0).empty()) << "there is no simulated chip";
    pull(0, true);
    pull(1, false);
    pull(2, false);
  }
  std::uint64_t exchanged(GpioInterface& io, std::uint64_t outputs = 0) {
    std::uint64_t inputs = 0;
    EXPECT_TRUE(io.exchange(outputs, inputs)) << io.fault_text();
    return inputs;
  }
};

TEST_F(GpioOnSim, ConformsToThePort) {
  const auto io = make({{"input_3", "probe"}, {"output_1", "coolant"}});
  conformance::DigitalIoConformance(*io, {.input = 3,
                                          .output = 1,
                                          .turn_input = [](bool on) { pull(2, on); },
                                          .output_is_on = [] { return value(3) == 1; }})
      .check();
}

TEST_F(GpioOnSim, StampsEdgesWithTheKernelsClock) {
  const auto lines = make_kernel_lines();
  const std::vector<LineSpec> inputs{{"io", "probe"}};
  const auto opened = lines->open(inputs, {});
  ASSERT_TRUE(opened) << opened.error().message;
  for (int i = 0; i < 200; ++i) {
    const bool up = i % 2 == 0;
    const Time before = lines->now();
    pull(2, up);
    const Time after = lines->now();
    std::span<const Edge> edges;
    while (edges.empty()) ASSERT_TRUE(lines->read_edges(edges));
    ASSERT_EQ(edges.size(), 1U);
    EXPECT_EQ(edges[0].high, up);
    EXPECT_GE(edges[0].at, before);
    EXPECT_LE(edges[0].at, after + 5ms) << "interrupts of the simulated chip are threads";
  }
}

TEST_F(GpioOnSim, ActsOnAnEdgeAtOnceAndLetsGoAfterTheDebounceTime) {
  const auto io = make({{"input_0", "!estop-nc estop-no"}});
  ASSERT_TRUE(io->start());
  EXPECT_EQ(exchanged(*io), 0U);
  pull(0, false);
  pull(1, true);
  const auto pressed = std::chrono::steady_clock::now();
  while (exchanged(*io) == 0) ASSERT_LT(std::chrono::steady_clock::now() - pressed, 1s);
  pull(0, true);
  pull(1, false);
  const auto released = std::chrono::steady_clock::now();
  while (exchanged(*io) != 0) ASSERT_LT(std::chrono::steady_clock::now() - released, 1s);
  EXPECT_GE(std::chrono::steady_clock::now() - released, 19ms);
}

TEST_F(GpioOnSim, SeesAPulseBetweenTwoCycles) {
  const auto io = make({{"input_3", "probe"}});
  ASSERT_TRUE(io->start());
  EXPECT_EQ(exchanged(*io), 0U);
  pull(2, true);
  pull(2, false);
  const auto asked = std::chrono::steady_clock::now();
  while (exchanged(*io) != 8) ASSERT_LT(std::chrono::steady_clock::now() - asked, 15ms);
}

TEST_F(GpioOnSim, KnowsTheLevelAfterMoreEdgesThanTheKernelKeeps) {
  const auto io = make({{"input_3", "probe"}}, 0);
  ASSERT_TRUE(io->start());
  for (const bool up : {true, false, true, false}) {
    for (int i = 0; i < 41; ++i) pull(2, i % 2 == 0 ? up : !up);
    std::this_thread::sleep_for(5ms);  // until the simulated interrupts were delivered
    static_cast<void>(exchanged(*io));
    EXPECT_EQ(exchanged(*io), up ? 8U : 0U);
  }
}

TEST_F(GpioOnSim, SetsOutputsAndLeavesThemInactive) {
  auto io = make({{"output_0", "coolant"}, {"output_1", "!release"}});
  ASSERT_TRUE(io->start());
  EXPECT_EQ(value(3), 0);
  EXPECT_EQ(value(4), 1);
  exchanged(*io, 3);
  EXPECT_EQ(value(3), 1);
  EXPECT_EQ(value(4), 0);
  exchanged(*io, 2);
  EXPECT_EQ(value(3), 0);
  EXPECT_EQ(value(4), 0);
}

TEST_F(GpioOnSim, FindsALineByItsNumber) {
  const auto io = make({{"input_0", "#5/pull-up"}});
  ASSERT_TRUE(io->start());
  EXPECT_EQ(exchanged(*io), 1U) << "it is pulled up";
}

TEST_F(GpioOnSim, RefusesLinesThatAreNotThereOrTaken) {
  EXPECT_THAT(refusal({{"input_0", "door"}}),
              HasSubstr("chip io has no line \"door\"; there are estop-nc, estop-no, probe, coolant, release, and by "
                        "number #0 to #7"));
  EXPECT_THAT(refusal({{"input_0", "#8"}}), HasSubstr("chip io has no line \"#8\""));
  EXPECT_THAT(refusal({{"input_0", "other:door"}}),
              HasSubstr("there is no chip \"other\"; there are gpiochip0 (io, 8 lines)"));
  const auto first = make({{"input_0", "probe"}, {"output_0", "coolant"}});
  ASSERT_TRUE(first->start());
  EXPECT_THAT(refusal({{"input_0", "probe"}}), HasSubstr("line probe of chip io is taken by \"rmacd\""));
  EXPECT_THAT(refusal({{"output_0", "coolant"}}), HasSubstr("line coolant of chip io is taken by \"rmacd\""));
  EXPECT_THAT(refusal({{"input_1", "release"}, {"input_2", "probe"}}), HasSubstr("line probe"));
  EXPECT_EQ(refusal({{"input_1", "release"}}), "nothing") << "a refusal gives back what it had claimed";
  first->stop();
  EXPECT_EQ(refusal({{"input_0", "probe"}}), "nothing") << "and so does a stop";
}

// libgpiod's own tools at the other end.
TEST_F(GpioOnSim, HoldsItsLinesAsGpioinfoSees) {
  const auto io = make({{"input_0", "probe"}, {"output_0", "coolant"}, {"output_1", "!release"}});
  ASSERT_TRUE(io->start());
  const std::string held = said_by("gpioinfo io");
  EXPECT_THAT(held, testing::ContainsRegex("\"probe\" +\"rmacd\" +input +active-high \\[used"));
  EXPECT_THAT(held, testing::ContainsRegex("\"coolant\" +\"rmacd\" +output +active-high \\[used"));
  EXPECT_THAT(held, testing::ContainsRegex("\"estop-nc\" +unused +input"));
  EXPECT_THAT(said_by("gpioset io 3=1"), HasSubstr("Device or resource busy"));
  io->stop();
  EXPECT_THAT(said_by("gpioinfo io"), testing::ContainsRegex("\"coolant\" +unused"));
  EXPECT_EQ(said_by("gpioget io 0 1"), "1 0\n") << "as they are pulled";
}

TEST_F(GpioOnSim, SaysWhichProgramHasALine) {
  FILE* const monitor = popen("exec gpiomon --num-events=1 io 2 >/dev/null", "r");
  while (said_by("gpioinfo io").find("\"gpiomon\"") == std::string::npos) {
  }
  EXPECT_THAT(refusal({{"input_0", "probe"}}), HasSubstr("line probe of chip io is taken by \"gpiomon\""));
  pull(2, true);  // which ends it
  pclose(monitor);
  EXPECT_EQ(refusal({{"input_0", "probe"}}), "nothing");
}

/// Last, for the chip is gone after it.
TEST_F(GpioOnSim, ZFailsWhenTheChipIsTakenAway) {
  const auto io = make({{"input_0", "probe"}, {"output_0", "coolant"}});
  ASSERT_TRUE(io->start());
  exchanged(*io, 1);
  std::ofstream("/sys/kernel/config/gpio-sim/io/live") << "0";
  std::uint64_t inputs = 0;
  EXPECT_FALSE(io->exchange(0, inputs));
  EXPECT_THAT(io->fault_text(), HasSubstr("the GPIO chip does not answer"));
  io->stop();
  EXPECT_THAT(refusal({{"input_0", "probe"}}), HasSubstr("there is no chip \"io\""));
}

}  // namespace
