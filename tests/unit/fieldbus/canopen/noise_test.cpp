#include <gtest/gtest.h>

#include "canopen/pdo.hpp"
#include "rmac/fieldbus/canopen/bus_scan.hpp"
#include "rmac/fieldbus/canopen/canopen_interface.hpp"
#include "rmac/fieldbus/canopen/stored_parameters.hpp"
#include "unit/fieldbus/can/noisy_port.hpp"
#include "unit/fieldbus/canopen/canopen_bench.hpp"

// Whatever comes over the bus, each service of the master ends, in its time, and reads nothing that is not there. What
// SDO transfers and LSS do is in the tests beside theirs.
namespace rmac::fieldbus::canopen {
namespace {

using test::CanopenBench;
using test::kSdoAnswers;
using test::NoisyPort;

TEST(Noise, EndsAScanOfABusInTime) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    NoisyPort port(seed, kSdoAnswers);
    const auto found = scan_bus(port, {.listen = std::chrono::milliseconds(0)});
    ASSERT_LT(port.now(), std::chrono::hours(1)) << "seed " << seed;
    if (!found) continue;
    ASSERT_LE(found->size(), 127U) << "seed " << seed;
    for (const ScannedNode& node : *found) {
      for (const char letter : node.name) ASSERT_TRUE(letter >= ' ' && letter <= '~') << "seed " << seed;
    }
  }
}

TEST(Noise, EndsTheStoringOfParametersInTime) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    NoisyPort port(seed, kSdoAnswers);
    static_cast<void>(store_parameters(port, 5, StoreCommand::Save));
    ASSERT_LT(port.now(), std::chrono::hours(1)) << "seed " << seed;
  }
}

TEST(Noise, EndsTheBootOfAMachineInTimeWithANodeThatIsNamed) {
  const auto config = read_canopen_config("can0", {{"node", {5, 6}}, {"boot_timeout_s", {1}}}, {}, 0.001);
  ASSERT_TRUE(config) << config.error().message;
  for (unsigned seed = 0; seed < 100; ++seed) {
    NoisyPort* port = nullptr;
    CanopenInterface master(*config, [&](std::span<const std::uint16_t>, std::size_t) {
      auto made = std::make_unique<NoisyPort>(seed, kSdoAnswers);
      port = made.get();
      return Expected<std::unique_ptr<CanPort>>(std::move(made));
    });
    const auto started = master.start();
    ASSERT_FALSE(started) << "seed " << seed;
    ASSERT_NE(started.error().message.find("node "), std::string::npos) << started.error().message;
  }
}

TEST_F(CanopenBench, StaysCalmWhateverFramesCome) {
  test::VirtualDrive& drive = wire_.add(1);
  make({{"node", {1}}});
  start();
  enable_all();
  std::mt19937 random(12);
  for (int i = 0; i < 5000; ++i) {
    constexpr std::uint16_t kIds[] = {0x081, 0x181, 0x581, 0x701, 0x081};
    CanFrame frame{.id = kIds[random() % 5], .size = static_cast<std::uint8_t>(random() % 9)};
    for (auto& byte : frame.data) byte = static_cast<std::uint8_t>(random());
    wire_.inject(frame);
    cycle(DriveWish::Off);
  }
  EXPECT_TRUE(sound_);
  cycles(3000, DriveWish::Off);
  EXPECT_TRUE(feedback_[0].online);
  EXPECT_TRUE(drive.operational());
}

/// Some objects of `words`, as many as fit.
template <typename Words>
std::vector<MappedObject> any_mapping(std::mt19937& random, const Words& words) {
  std::vector<MappedObject> mapped;
  for (std::size_t tries = random() % 8; tries > 0; --tries) {
    const MappedObject& object = words[random() % words.size()];
    const auto same = [&](const MappedObject& other) { return other.object == object.object; };
    if (std::any_of(mapped.begin(), mapped.end(), same)) continue;
    mapped.push_back(object);
    if (mapped_bytes(mapped) > 8) mapped.pop_back();
  }
  return mapped;
}

TEST(Noise, TakesAnswersWholeOrNotAtAll) {
  std::mt19937 random(301);  // NOLINT(cert-msc51-cpp): the same frames every time
  int taken = 0;
  for (int i = 0; i < 20000; ++i) {
    AxisConfig axis;
    axis.answers = any_mapping(random, kAnswerWords);
    CanFrame frame{.id = 0x185, .size = static_cast<std::uint8_t>(random() % 9)};
    for (auto& byte : frame.data) byte = static_cast<std::uint8_t>(random());
    DriveFeedback feedback;
    feedback.statusword = 0x1234;
    feedback.position_counts = 567;
    const DriveFeedback before = feedback;
    const bool whole = unpack_answers(axis, axis.answers, frame, feedback);
    ASSERT_EQ(whole, frame.size >= mapped_bytes(axis.answers)) << "case " << i;
    taken += whole ? 1 : 0;
    std::size_t at = 0;
    for (const MappedObject& mapped : axis.answers) {
      if (mapped.object.index == 0x6041) {
        const auto word = static_cast<std::uint16_t>(frame.data[at] | frame.data[at + 1] << 8);
        ASSERT_EQ(feedback.statusword, whole ? word : before.statusword) << "case " << i;
      }
      if (mapped.object.index == 0x6064) {
        std::uint32_t word = 0;
        for (std::size_t byte = 4; byte-- > 0;) word = word << 8 | frame.data[at + byte];
        ASSERT_EQ(feedback.position_counts, whole ? static_cast<std::int32_t>(word) : before.position_counts);
      }
      at += mapped.bits / 8U;
    }
  }
  EXPECT_GT(taken, 5000);
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
