#include "rmac/fieldbus/gpio/gpio_interface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "conformance/digital_io_conformance.hpp"

namespace rmac::fieldbus::gpio {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr Time kDebounce = 20ms;
constexpr Time kDisagreement = 100ms;

/// Lines that a test holds in its hand, and a clock.
struct FakeLines final : LinePort {
  std::vector<LineSpec> ins, outs;
  std::vector<std::uint8_t> level, out;
  std::vector<Edge> waiting, given;
  Time clock = 1h;
  bool open_now = false, works = true;
  std::string refusal;

  Expected<> open(std::span<const LineSpec> inputs, std::span<const LineSpec> outputs) override {
    if (!refusal.empty()) return failure(MinorCode::InvalidParameterValue, refusal);
    ins.assign(inputs.begin(), inputs.end());
    outs.assign(outputs.begin(), outputs.end());
    level.resize(ins.size());
    out.clear();
    for (const LineSpec& line : outs) out.push_back(line.inverted ? 1 : 0);
    open_now = true;
    return {};
  }
  void close() noexcept override { open_now = false; }
  bool read_levels(std::span<std::uint8_t> high) noexcept override {
    std::copy(level.begin(), level.end(), high.begin());
    return works;
  }
  bool read_edges(std::span<const Edge>& edges) noexcept override {
    given = std::exchange(waiting, {});
    edges = given;
    return works;
  }
  bool write(std::size_t output, bool high) noexcept override {
    if (works) out[output] = high ? 1 : 0;
    return works;
  }
  Time now() noexcept override { return clock; }

  void set(std::size_t line, bool high) {
    level[line] = high ? 1 : 0;
    waiting.push_back({line, high, clock});
  }
};

TEST(GpioInputSignal, ActsOnTheFirstEdgeAndRestsOnlyAfterItsContactHasRested) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    std::uniform_int_distribution<std::int64_t> gap_us(1, 2000);
    InputSignal signal(1, kDebounce, kDisagreement);
    Time now = 1s;
    signal.begin(0, false, now);
    ASSERT_FALSE(signal.active(now));
    // Pressed, held and let go, with bounces whose gaps are below the debounce time.
    const auto edges = static_cast<unsigned>(1 + 2 * (random() % 20));
    bool contact = false;
    for (unsigned i = 0; i < edges; ++i) {
      now += std::chrono::microseconds(gap_us(random));
      contact = !contact;
      signal.edge(0, contact, now);
      ASSERT_TRUE(signal.active(now)) << "edge " << i;
      ASSERT_TRUE(signal.active(now + std::chrono::microseconds(gap_us(random) / 4))) << "between edges";
    }
    ASSERT_TRUE(contact);
    now += 10s;
    ASSERT_TRUE(signal.active(now)) << "it is held";
    for (unsigned i = 0; i < edges; ++i) {
      now += std::chrono::microseconds(gap_us(random));
      contact = !contact;
      signal.edge(0, contact, now);
    }
    ASSERT_FALSE(contact);
    ASSERT_TRUE(signal.active(now + kDebounce - 1us));
    ASSERT_FALSE(signal.active(now + kDebounce));
  }
}

TEST(GpioInputSignal, SeesAPulseThatIsOverBeforeItIsAskedFor) {
  InputSignal signal(1, kDebounce, kDisagreement);
  signal.begin(0, false, 1s);
  signal.edge(0, true, 2s);
  signal.edge(0, false, 2s + 1us);
  EXPECT_TRUE(signal.active(2s + 1ms));
  EXPECT_FALSE(signal.active(2s + 1us + kDebounce));
}

TEST(GpioInputSignal, SeesAPulseOfWhichTheKernelToldOneEdge) {
  InputSignal signal(1, kDebounce, kDisagreement);
  signal.begin(0, false, 1s);
  signal.edge(0, false, 2s);
  EXPECT_TRUE(signal.active(2s));
}

TEST(GpioInputSignal, IsActiveFromTheBeginningWhenItsContactIs) {
  InputSignal signal(1, kDebounce, kDisagreement);
  signal.begin(0, true, 1s);
  EXPECT_TRUE(signal.active(1s));
}

TEST(GpioInputSignal, OfTwoContactsIsActiveWithEitherAndBrokenOnlyWhenTheyDisagreeForLong) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    std::uniform_int_distribution<std::int64_t> skew_us(0, 99'000);
    InputSignal signal(2, kDebounce, kDisagreement);
    Time now = 1s;
    signal.begin(0, false, now);
    signal.begin(1, false, now);
    for (unsigned i = 0; i < 20; ++i) {
      const bool pressed = i % 2 == 0;
      const std::size_t first = random() % 2;
      now += 1s;
      signal.edge(first, pressed, now);
      ASSERT_TRUE(signal.active(now)) << "either contact";
      now += std::chrono::microseconds(skew_us(random));
      ASSERT_FALSE(signal.broken(now));
      signal.edge(1 - first, pressed, now);
      ASSERT_FALSE(signal.broken(now + 10s));
      ASSERT_EQ(signal.active(now + kDebounce), pressed);
    }
    signal.edge(seed % 2, true, now);
    ASSERT_FALSE(signal.broken(now + kDisagreement));
    ASSERT_TRUE(signal.broken(now + kDisagreement + 1ns));
    ASSERT_TRUE(signal.active(now + 1h)) << "a broken wire does not let go";
    signal.edge(seed % 2, false, now + 1h);
    ASSERT_FALSE(signal.broken(now + 2h));
  }
}

// Red when a disagreement that is there when the lines are claimed counts from the clock's zero.
TEST(GpioInputSignal, CountsADisagreementThatItBeginsWithFromTheBeginning) {
  InputSignal signal(2, kDebounce, kDisagreement);
  signal.begin(0, true, 1h);
  signal.begin(1, false, 1h);
  EXPECT_FALSE(signal.broken(1h));
  EXPECT_FALSE(signal.broken(1h + kDisagreement));
  EXPECT_TRUE(signal.broken(1h + kDisagreement + 1ns));
}

/// An emergency stop of two contacts (bit 0: one opens, one closes), a probe (bit 5), coolant (bit 1) and a tool
/// release that is active low (bit 3).
class GpioInterfaceTest : public testing::Test {
 protected:
  GpioInterfaceTest() {
    auto config = read_gpio_config({}, {{"chip", "io"},
                                        {"input_0", "!estop-nc estop-no"},
                                        {"input_5", "probe"},
                                        {"output_1", "coolant"},
                                        {"output_3", "!release"}});
    EXPECT_TRUE(config) << config.error().message;
    auto port = std::make_unique<FakeLines>();
    lines = port.get();
    io = std::make_unique<GpioInterface>(std::move(*config), std::move(port));
  }
  void start() {
    lines->level = {1, 0, 0};
    const auto started = io->start();
    ASSERT_TRUE(started) << started.error().message;
  }
  bool exchange(std::uint64_t outputs = 0) {
    lines->clock += 1ms;
    return io->exchange(outputs, inputs);
  }

  FakeLines* lines = nullptr;
  std::unique_ptr<GpioInterface> io;
  std::uint64_t inputs = 0;
};

TEST_F(GpioInterfaceTest, ConformsToThePort) {
  lines->level = {1, 0, 0};
  conformance::DigitalIoConformance(*io, {.input = 5,
                                          .output = 3,
                                          .turn_input = [this](bool on) { lines->set(2, on); },
                                          .output_is_on = [this] { return lines->out.at(1) == 0; },
                                          .pass = [this] { lines->clock += 1ms; }})
      .check();
}

TEST_F(GpioInterfaceTest, CarriesBitsBothWays) {
  start();
  EXPECT_EQ(io->input_bits(), 0b100001U);
  EXPECT_EQ(io->output_bits(), 0b1010U);
  ASSERT_TRUE(exchange());
  EXPECT_EQ(inputs, 0U);
  EXPECT_EQ(lines->out, (std::vector<std::uint8_t>{0, 1}));
  lines->set(2, true);
  ASSERT_TRUE(exchange(0b1010));
  EXPECT_EQ(inputs, 0b100000U);
  EXPECT_EQ(lines->out, (std::vector<std::uint8_t>{1, 0}));
  ASSERT_TRUE(exchange(0b1000));
  EXPECT_EQ(lines->out, (std::vector<std::uint8_t>{0, 0}));
}

TEST_F(GpioInterfaceTest, StopsWithOutputsInactiveAndItsLinesGivenBack) {
  start();
  ASSERT_TRUE(exchange(0b1010));
  io->stop();
  EXPECT_EQ(lines->out, (std::vector<std::uint8_t>{0, 1}));
  EXPECT_FALSE(lines->open_now);
  EXPECT_FALSE(exchange(0b1010)) << "it has no lines";
  EXPECT_EQ(lines->out, (std::vector<std::uint8_t>{0, 1}));
}

TEST_F(GpioInterfaceTest, SaysWhatTheLinesWereRefusedFor) {
  lines->refusal = "line probe of chip io is taken";
  const auto started = io->start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().message, lines->refusal);
  EXPECT_FALSE(exchange());
}

TEST_F(GpioInterfaceTest, ActsOnOneContactOfAnEmergencyStopInTheNextCycle) {
  start();
  lines->set(0, false);
  ASSERT_TRUE(exchange());
  EXPECT_EQ(inputs, 1U);
  lines->set(1, true);
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(exchange());
  EXPECT_EQ(inputs, 1U);
}

TEST_F(GpioInterfaceTest, FailsWithOutputsInactiveWhileAWireIsBroken) {
  start();
  ASSERT_TRUE(exchange(0b1010));
  lines->set(0, false);
  for (int i = 0; i < 99; ++i) ASSERT_TRUE(exchange(0b1010)) << i;
  EXPECT_EQ(lines->out, (std::vector<std::uint8_t>{1, 0}));
  ASSERT_TRUE(exchange(0b1010));
  ASSERT_FALSE(exchange(0b1010));
  EXPECT_EQ(inputs, 1U) << "and it counts as pressed";
  EXPECT_EQ(lines->out, (std::vector<std::uint8_t>{0, 1}));
  EXPECT_THAT(io->fault_text(),
              HasSubstr("two contacts of input 0 disagree (line estop-nc of io and line estop-no of io)"));
  lines->set(0, true);
  EXPECT_TRUE(exchange(0b1010));
}

TEST_F(GpioInterfaceTest, FailsWhenTheChipDoes) {
  start();
  ASSERT_TRUE(exchange());
  lines->works = false;
  EXPECT_FALSE(exchange(0b10));
  EXPECT_THAT(io->fault_text(), HasSubstr("the GPIO chip does not answer"));
}

TEST(GpioConfig, ReadsChipsBiasesAndTimes) {
  const auto config = read_gpio_config({{"debounce_ms", {5}}, {"debounce_ms_2", {0}}, {"contact_ms", {50}}},
                                       {{"chip", "gpiochip0"},
                                        {"input_1", "!/dev/gpiochip1:#7/pull-up"},
                                        {"input_2", "a b/no-bias"},
                                        {"output_63", "gpio-sim:c"}});
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->disagreement, 50ms);
  ASSERT_EQ(config->inputs.size(), 2U);
  const InputConfig& one = config->inputs[0];
  EXPECT_EQ(one.bit, 1U);
  EXPECT_EQ(one.debounce, 5ms);
  ASSERT_EQ(one.contacts.size(), 1U);
  EXPECT_EQ(one.contacts[0].chip, "/dev/gpiochip1");
  EXPECT_EQ(one.contacts[0].name, "#7");
  EXPECT_EQ(one.contacts[0].bias, Bias::PullUp);
  EXPECT_TRUE(one.contacts[0].inverted);
  const InputConfig& two = config->inputs[1];
  EXPECT_EQ(two.debounce, 0ms);
  ASSERT_EQ(two.contacts.size(), 2U);
  EXPECT_EQ(two.contacts[0].chip, "gpiochip0");
  EXPECT_EQ(two.contacts[0].bias, Bias::AsIs);
  EXPECT_EQ(two.contacts[1].bias, Bias::None);
  ASSERT_EQ(config->outputs.size(), 1U);
  EXPECT_EQ(config->outputs[0].bit, 63U);
  EXPECT_EQ(config->outputs[0].line.chip, "gpio-sim");
}

TEST(GpioConfig, NamesWhatIsWrong) {
  const auto error = [](std::map<std::string, std::string> texts, std::map<std::string, std::vector<double>> numbers) {
    const auto config = read_gpio_config(numbers, texts);
    return config ? "nothing" : config.error().message;
  };
  EXPECT_THAT(error({{"chip", "c"}}, {}), HasSubstr("no line is named"));
  EXPECT_THAT(error({{"input_0", "a"}}, {}), HasSubstr("input_0: the chip of line \"a\" is not named"));
  EXPECT_THAT(error({{"chip", "c"}, {"input_0", "a b c"}}, {}), HasSubstr("input_0 names 3 lines"));
  EXPECT_THAT(error({{"chip", "c"}, {"input_0", ""}}, {}), HasSubstr("input_0 names 0 lines"));
  EXPECT_THAT(error({{"chip", "c"}, {"output_0", "a b"}}, {}), HasSubstr("output_0 names 2 lines; it takes one"));
  EXPECT_THAT(error({{"chip", "c"}, {"output_0", "a/pull-up"}}, {}), HasSubstr("are for inputs"));
  EXPECT_THAT(error({{"chip", "c"}, {"input_0", "c:"}}, {}), HasSubstr("the line is not named"));
  EXPECT_THAT(error({{"chip", "c"}, {"input_0", "a"}, {"output_1", "c:a"}}, {}),
              HasSubstr("output_1: line a of chip c is named twice"));
  EXPECT_THAT(error({{"chip", "c"}, {"input_64", "a"}}, {}), HasSubstr("no line is named"));
  EXPECT_THAT(error({{"chip", "c"}, {"input_0", "a"}, {"input_x", "b"}}, {}),
              HasSubstr("parameter \"input_x\" is not understood"));
  EXPECT_THAT(error({{"chip", "c"}, {"input_0", "a"}}, {{"debounce_ms", {-1}}}), HasSubstr("debounce_ms is -1"));
}

TEST(GpioKernelLines, NameTheChipThatIsMissing) {
  const auto lines = make_kernel_lines();
  const std::vector<LineSpec> inputs{{"no-such-chip", "estop"}};
  const auto opened = lines->open(inputs, {});
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message, HasSubstr("there is no chip \"no-such-chip\"; there "));
}

}  // namespace
}  // namespace rmac::fieldbus::gpio
