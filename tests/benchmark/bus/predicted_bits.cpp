#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>
#include <set>
#include <stdexcept>

#include "rmac/fieldbus/can/can_load.hpp"
#include "rmac/fieldbus/canopen/bus_load.hpp"
#include "rmac/fieldbus/canopen/canopen_interface.hpp"
#include "rmac/motion/drive_power.hpp"
#include "rows.hpp"
#include "unit/fieldbus/canopen/can_wire.hpp"

namespace rmac::bench {
namespace {

using namespace rmac::fieldbus;

constexpr double kPeriodS = 0.01;

/// The bits of a frame as ISO 11898-1 sends them, counted one by one: five alike are followed by one of the other kind,
/// from the start of the frame to the end of its CRC. Shares nothing with the prediction.
class Wire {
 public:
  /// Up to where the payload begins.
  Wire(std::uint16_t id, std::uint8_t size) {
    put(0, 1);  // start of frame
    put(id, 11);
    put(0, 3);  // a data frame, with an identifier of 11 bits; reserved
    put(size, 4);
  }
  void put(std::uint32_t value, int bits) noexcept {
    for (int i = bits - 1; i >= 0; --i) put((value >> static_cast<unsigned>(i) & 1U) != 0);
  }
  /// The bit that was sent last.
  [[nodiscard]] bool last() const noexcept { return last_; }
  /// All bits, once the CRC, delimiters, acknowledgement, end of frame, and the three bits between frames are sent.
  [[nodiscard]] int end() noexcept {
    put(crc_, 15);
    return sent_ + 1 + 2 + 7 + 3;
  }

 private:
  void put(bool bit) noexcept {
    const bool turn = bit != ((crc_ >> 14U & 1U) != 0);
    crc_ = (crc_ << 1U & 0x7FFFU) ^ (turn ? 0x4599U : 0U);
    send(bit);
    if (alike_ == 5) send(!bit);
  }
  void send(bool bit) noexcept {
    alike_ = bit == last_ ? alike_ + 1 : 1;
    last_ = bit;
    ++sent_;
  }

  std::uint32_t crc_ = 0;
  int sent_ = 0, alike_ = 0;
  bool last_ = true;
};

int bits_of(const CanFrame& frame) {
  Wire wire(frame.id, frame.size);
  for (std::size_t i = 0; i < frame.size; ++i) wire.put(frame.data[i], 8);
  return wire.end();
}

/// As many bits as are found for a frame of this identifier and length: each bit of the payload like the one before on
/// the wire, so that it is stuffed after every fourth; and of the last two bytes, which make the CRC, whatever gives
/// most.
int most_bits(CanFrame frame) {
  frame.data = {};
  Wire wire(frame.id, frame.size);
  for (std::size_t i = 0; i < frame.size; ++i) {
    for (unsigned bit = 8; bit-- > 0;) {
      const bool alike = wire.last();
      wire.put(alike ? 1 : 0, 1);
      frame.data[i] = static_cast<std::uint8_t>(frame.data[i] | (alike ? 1U : 0U) << bit);
    }
  }
  int most = bits_of(frame);
  const int tries = 1 << (8 * std::min<int>(frame.size, 2));
  for (int value = 0; value < tries; ++value) {
    if (frame.size > 0) frame.data[frame.size - 1U] = static_cast<std::uint8_t>(value);
    if (frame.size > 1) frame.data[frame.size - 2U] = static_cast<std::uint8_t>(value >> 8);
    most = std::max(most, bits_of(frame));
  }
  return most;
}

/// Objects that a mapping may hold beyond what it must.
struct Choice {
  const char* text;
  std::size_t bytes;
};
constexpr std::array<Choice, 4> kSetpoints{{{"0005:00/8", 1}, {"0006:00/16", 2}, {"0007:00/32", 4}, {"607A:00/32", 4}}};
constexpr std::array<Choice, 4> kAnswers{{{"6077:00/16", 2}, {"603F:00/16", 2}, {"6064:00/32", 4}, {"606C:00/32", 4}}};

class Configurations {
 public:
  /// One of up to eight drives with mappings of any length, by parameters as `device.json` has them.
  canopen::CanopenConfig next() {
    std::map<std::string, std::vector<double>> numbers{{"load_share", {100}}, {"bit_rate", {1e6}}};
    std::map<std::string, std::string> texts;
    std::set<double> nodes;
    const int axes = pick(1, 8);
    while (static_cast<int>(nodes.size()) < axes) nodes.insert(pick(1, 126));
    numbers["node"].assign(nodes.begin(), nodes.end());
    std::shuffle(numbers["node"].begin(), numbers["node"].end(), random_);
    numbers["mode"] = {static_cast<double>(std::array{8, 9, 10}[static_cast<std::size_t>(pick(0, 2))])};
    const char* const target = numbers["mode"][0] == 8   ? " 607A:00/32"
                               : numbers["mode"][0] == 9 ? " 60FF:00/32"
                                                         : " 6071:00/16";
    for (int axis = 0; axis < axes; ++axis) {
      const std::size_t target_bytes = numbers["mode"][0] == 10 ? 2 : 4;
      texts[fmt::format("rpdo_{}", axis)] = mapping(std::string("6040:00/16") + target, 2 + target_bytes, kSetpoints);
      texts[fmt::format("tpdo_{}", axis)] = mapping("6041:00/16", 2, kAnswers);
    }
    auto config = canopen::read_canopen_config("can0", numbers, texts, kPeriodS);
    if (!config) throw std::runtime_error(config.error().message);
    return std::move(*config);
  }

 private:
  int pick(int least, int most) { return std::uniform_int_distribution(least, most)(random_); }

  /// `text`, and of the choices what fits and chance takes, each at most once.
  template <typename Choices>
  std::string mapping(std::string text, std::size_t bytes, const Choices& choices) {
    for (const Choice& choice : choices) {
      constexpr std::size_t kMostBytes = 8;
      const bool there = text.find(choice.text) != std::string::npos;
      if (there || bytes + choice.bytes > kMostBytes || pick(0, 1) == 0) continue;
      text += std::string(" ") + choice.text;
      bytes += choice.bytes;
    }
    return text;
  }

  std::mt19937 random_{1};  // NOLINT: the same configurations in every run
};

bool cyclic(const CanFrame& frame) {
  constexpr std::uint16_t kSync = 0x080, kFirstPdo = 0x180, kBeyondPdos = 0x580;
  return frame.id == kSync || (frame.id >= kFirstPdo && frame.id < kBeyondPdos);
}

struct Counted {
  int predicted = 0;
  int most = 0;   ///< of the cycles that ran
  int worst = 0;  ///< of the same frames with worst payloads
};

/// Master and drives run, with targets from all over their range, and each cycle's frames are counted.
Counted count(const canopen::CanopenConfig& config, int cycles) {
  test::CanWire wire;
  for (const auto& axis : config.axes) wire.add(axis.node);
  canopen::CanopenInterface master(config, [&](std::span<const std::uint16_t>, std::size_t) {
    return Expected<std::unique_ptr<CanPort>>(wire.open());
  });
  if (const auto started = master.start(); !started) throw std::runtime_error(started.error().message);
  std::vector<DriveCommand> commands(master.axis_count());
  std::vector<DriveFeedback> feedback(master.axis_count());
  std::vector<CanFrame> frames;
  wire.listen = [&](const CanFrame& frame) {
    if (cyclic(frame)) frames.push_back(frame);
  };
  Counted counted{static_cast<int>(canopen::bus_load(config).cyclic_bits()), 0, 0};
  std::mt19937 random(2);  // NOLINT: the same targets in every run
  for (int cycle = 0; cycle < cycles; ++cycle) {
    for (std::size_t i = 0; i < commands.size(); ++i) {
      commands[i].controlword =
          next_controlword(feedback[i].statusword, DriveWish::Operational, false, commands[i].controlword);
      commands[i].target_position_counts = std::uniform_int_distribution(-1'000'000'000, 1'000'000'000)(random);
    }
    frames.clear();
    static_cast<void>(master.exchange(commands, feedback));
    wire.pass(config.period);
    int bits = 0;
    for (const CanFrame& frame : frames) bits += bits_of(frame);
    counted.most = std::max(counted.most, bits);
  }
  for (const CanFrame& frame : frames) counted.worst += most_bits(frame);
  wire.listen = nullptr;
  return counted;
}

/// How much more than the worst payload's bits is predicted of a PDO of that length.
double above_of_frames_percent(std::size_t bytes) {
  double predicted = 0, worst = 0;
  for (std::uint16_t node = 1; node < 127; ++node) {
    const auto id = static_cast<std::uint16_t>(0x180 + node);
    predicted += worst_frame_bits(id, bytes);
    worst += most_bits({.id = id, .size = static_cast<std::uint8_t>(bytes)});
  }
  return 100 * (predicted - worst) / worst;
}

}  // namespace

void predicted_bits(Figures& figures, bool quick) {
  const int configurations = quick ? 20 : 200;
  const int cycles = 200;
  Configurations random;
  double least_margin = 1e9;
  std::vector<double> above_percent;
  for (int i = 0; i < configurations; ++i) {
    const canopen::CanopenConfig config = random.next();
    const Counted counted = count(config, cycles);
    least_margin = std::min<double>(least_margin, counted.predicted - std::max(counted.most, counted.worst));
    above_percent.push_back(100.0 * (counted.predicted - counted.worst) / counted.worst);
  }
  const std::string note = fmt::format("{} random configurations, {} cycles of master and drives each{}",
                                       configurations, cycles, quick ? "; quick, 200 wanted" : "");
  figures.at_least("predicted_bits_above_counted_least", least_margin, 0, "bits", note);
  figures.at_most("predicted_bits_above_worst_payloads_max", quantile(above_percent, 1), 5, "%", note);
  figures.inform("predicted_bits_above_worst_payloads_median", quantile(above_percent, 0.5), "%");
  for (const std::size_t bytes : {std::size_t{6}, std::size_t{8}}) {
    figures.inform(fmt::format("predicted_bits_above_worst_payloads_{}_bytes", bytes), above_of_frames_percent(bytes),
                   "%", "one frame, mean of all node ids");
  }
}

}  // namespace rmac::bench
