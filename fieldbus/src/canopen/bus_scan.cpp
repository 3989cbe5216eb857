#include "rmac/fieldbus/canopen/bus_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "canopen/watch/identity_record.hpp"
#include "rmac/fieldbus/canopen/sdo_client.hpp"

namespace rmac::fieldbus::canopen {
namespace {

constexpr std::uint8_t kMostNodes = 127;

/// What is asked of each node, in order; who it is twice, for two devices of one id may take turns.
constexpr std::array kQuestions{ObjectAddress{0x1000, 0}, ObjectAddress{0x1018, 1}, ObjectAddress{0x1018, 2},
                                ObjectAddress{0x1018, 3}, ObjectAddress{0x1018, 4}, ObjectAddress{0x1008, 0},
                                ObjectAddress{0x1018, 1}, ObjectAddress{0x1018, 2}, ObjectAddress{0x1018, 3},
                                ObjectAddress{0x1018, 4}};
constexpr int kQuestionsOfIdentity = kQuestions.size() - 1;

SdoClient::Options sdo_options(const ScanOptions& options) {
  // Segmented only: block transfer is the less common of the two, and a name is short.
  constexpr std::size_t kNever = 1U << 20U;
  return {.timeout = options.timeout, .block_from = kNever};
}

/// Asks one node.
class Probe {
 public:
  Probe(std::uint8_t node, const ScanOptions& options) : sdo_(node, sdo_options(options)) { found_.node = node; }

  void receive(const CanFrame& frame, std::chrono::nanoseconds now) noexcept {
    if (frame.id == kSdoAnswerId + found_.node) {
      if (identity_.take(frame)) found_.two_identities = true;
      const std::uint16_t index = frame.size == 8 ? word_at(&frame.data[1]) : std::uint16_t{0};
      if (index == 0x1000 || index == 0x1018) ++told_;
      found_.answers_twice = told_ >= 2 * kQuestionsOfIdentity;
      sdo_.receive(frame, now);
    }
    if (frame.id == kHeartbeatId + found_.node && frame.size == 1) found_.state = heartbeat_state(frame);
  }
  /// The next frame of the conversation, if there is one now.
  bool next_frame(std::chrono::nanoseconds now, CanFrame& frame) {
    if (!over() && (!asked_ || sdo_.finished())) {
      if (asked_) take_answer();
      if (!over()) sdo_.upload(kQuestions.at(question_), buffer_, now);
      asked_ = true;
    }
    return sdo_.next_frame(now, frame);
  }
  [[nodiscard]] bool over() const noexcept { return question_ == kQuestions.size(); }
  [[nodiscard]] const ScannedNode& found() const noexcept { return found_; }

 private:
  void take_answer() {
    const ObjectAddress object = kQuestions.at(question_++);
    if (sdo_.state() == SdoClient::State::Failed) {
      // No answer to the first question: nobody is there. To a later one: what it told so far stands.
      question_ = kQuestions.size();
      return;
    }
    found_.answers = true;
    if (sdo_.state() != SdoClient::State::Done) return;
    if (object.index == 0x1008) {
      const auto end = buffer_.begin() + static_cast<std::ptrdiff_t>(std::min(sdo_.size(), buffer_.size()));
      std::copy_if(buffer_.begin(), end, std::back_inserter(found_.name),
                   [](std::uint8_t c) { return c >= ' ' && c < 127; });
      return;
    }
    std::fill(buffer_.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(sdo_.size(), 4)), buffer_.end(),
              std::uint8_t{0});
    const std::uint32_t number = long_at(buffer_.data());
    if (object.index == 0x1000) {
      found_.device_type = number;
    } else {
      const std::array into{&found_.identity.vendor_id, &found_.identity.product_code, &found_.identity.revision_number,
                            &found_.identity.serial_number};
      *into.at(object.sub - 1U) = number;
    }
  }

  SdoClient sdo_;
  IdentityRecord identity_;
  int told_ = 0;  ///< answers to who it is
  ScannedNode found_;
  std::array<std::uint8_t, 128> buffer_{};
  std::size_t question_ = 0;
  bool asked_ = false;
};

}  // namespace

Expected<> check_idle(CanPort& port, std::chrono::nanoseconds listen,
                      const std::function<void(const CanFrame&)>& take) {
  const std::chrono::nanoseconds end = port.now() + listen;
  while (port.now() < end) {
    port.wait(std::min<std::chrono::nanoseconds>(end - port.now(), std::chrono::milliseconds(10)));
    CanFrame frame;
    while (port.receive(frame)) {
      if (frame.id == kSyncId) {
        return failure(
            MinorCode::UnsupportedOperation,
            "a machine runs on this bus: there is SYNC. Unload it first (rmac unload), or read the status of its "
            "drives with rmac status");
      }
      const bool operational =
          frame.id > kHeartbeatId && frame.size == 1 && heartbeat_state(frame) == NmtState::Operational;
      if (operational) {
        return failure(MinorCode::UnsupportedOperation,
                       fmt::format("a machine runs on this bus: node {} is operational. Unload it first (rmac unload)",
                                   frame.id - kHeartbeatId));
      }
      if (take) take(frame);
    }
  }
  return {};
}

Expected<std::vector<ScannedNode>> scan_bus(CanPort& port, const ScanOptions& options) {
  std::vector<std::unique_ptr<Probe>> probes;
  for (std::uint8_t node = 1; node <= kMostNodes; ++node) probes.push_back(std::make_unique<Probe>(node, options));
  const auto take = [&](const CanFrame& frame) {
    for (auto& probe : probes) probe->receive(frame, port.now());
  };
  if (auto idle = check_idle(port, options.listen, take); !idle) return tl::unexpected(idle.error());

  std::size_t begun = 0;
  const auto all_over = [&] {
    return std::all_of(probes.begin(), probes.end(), [](const auto& probe) { return probe->over(); });
  };
  while (!all_over()) {
    // One node more a round, so that questions never fill the transmit queue.
    begun = std::min(begun + 1, probes.size());
    CanFrame frame;
    while (port.receive(frame)) take(frame);
    for (std::size_t i = 0; i < begun; ++i) {
      if (probes[i]->next_frame(port.now(), frame)) port.send(frame);
    }
    if (const CanHealth health = port.health(); health.link_down || health.bus_off || health.queue_full > 0) {
      return failure(
          MinorCode::CommTimeout,
          "the interface gets no frame onto the bus: is another device on it, at this bit rate, with power, and is "
          "the bus terminated?");
    }
    port.wait(std::chrono::milliseconds(2));
  }
  std::vector<ScannedNode> found;
  for (const auto& probe : probes) {
    if (probe->found().answers || probe->found().state) found.push_back(probe->found());
  }
  return found;
}

std::string device_type_text(std::uint32_t device_type) {
  const std::uint32_t profile = device_type & 0xFFFF;
  const std::uint32_t more = device_type >> 16 & 0xFF;
  switch (profile) {
    case 0:
      return "no standard profile";
    case 401:
      return fmt::format("I/O{}{}{}{} (CiA 401)", (more & 1) != 0 ? ", digital in" : "",
                         (more & 2) != 0 ? ", digital out" : "", (more & 4) != 0 ? ", analogue in" : "",
                         (more & 8) != 0 ? ", analogue out" : "");
    case 402:
      return fmt::format("{} (CiA 402)", (more & 2) != 0   ? "servo drive"
                                         : (more & 1) != 0 ? "frequency converter"
                                         : (more & 4) != 0 ? "stepper drive"
                                                           : "drive");
    case 404:
      return "measuring device (CiA 404)";
    case 406:
      return "encoder (CiA 406)";
    case 408:
      return "hydraulic drive (CiA 408)";
    case 410:
      return "inclinometer (CiA 410)";
    default:
      return fmt::format("profile CiA {}", profile);
  }
}

bool describes(const eds::DeviceDescription& description, const ScannedNode& node) noexcept {
  if (!node.answers || (description.vendor_number == 0 && description.product_number == 0)) return false;
  return (description.vendor_number == 0 || description.vendor_number == node.identity.vendor_id) &&
         (description.product_number == 0 || description.product_number == node.identity.product_code);
}

}  // namespace rmac::fieldbus::canopen
