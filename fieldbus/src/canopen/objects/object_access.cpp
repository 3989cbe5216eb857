#include "rmac/fieldbus/canopen/object_access.hpp"

#include <fmt/format.h>

#include <optional>

#include "canopen/objects/standard_objects.hpp"
#include "rmac/fieldbus/canopen/canopen_config.hpp"
#include "rmac/fieldbus/canopen/nmt.hpp"
#include "rmac/fieldbus/canopen/sdo_client.hpp"
#include "rmac/motion/drive_power.hpp"

namespace rmac::fieldbus::canopen {
namespace {

constexpr std::size_t kMostBytes = 1U << 20U;

/// Segmented: block transfer is the less common of the two, and nobody waits for a cycle here.
constexpr std::size_t kNoBlocks = kMostBytes + 1;

/// What an object tells, or why it does not.
struct Answer {
  std::vector<std::uint8_t> bytes;
  std::optional<std::uint32_t> refusal;  ///< the node's abort code
};

/// Until the transfer is over.
void converse(CanPort& port, SdoClient& sdo, std::uint8_t node) {
  while (!sdo.finished()) {
    CanFrame frame;
    while (port.receive(frame)) {
      if (frame.id == kSdoAnswerId + node) sdo.receive(frame, port.now());
    }
    while (sdo.next_frame(port.now(), frame)) port.send(frame);
    port.wait(std::chrono::milliseconds(2));
  }
}

std::string words_of(std::uint32_t abort_code) {
  return fmt::format("{} ({:08X}h)", sdo_abort_text(abort_code), abort_code);
}

/// Why a transfer failed that the node did not refuse.
tl::unexpected<Error> trouble(const SdoClient& sdo, std::uint8_t node, ObjectAddress object) {
  if (sdo.abort_code() == sdo_abort::kTimeout) {
    return failure(MinorCode::CommTimeout,
                   fmt::format("node {} does not answer; rmac bus scan lists those that do", node));
  }
  return failure(MinorCode::CommTimeout, fmt::format("the transfer of {} with node {} was given up: {}",
                                                     to_string(object), node, words_of(sdo.abort_code())));
}

tl::unexpected<Error> refusal(std::uint8_t node, ObjectAddress object, std::uint32_t abort_code) {
  return failure(MinorCode::Other,
                 fmt::format("node {} refused {}: {}", node, to_string(object), words_of(abort_code)));
}

Expected<Answer> ask(CanPort& port, std::uint8_t node, ObjectAddress object, std::chrono::nanoseconds timeout) {
  SdoClient sdo(node, {.timeout = timeout, .block_from = kNoBlocks});
  Answer answer;
  answer.bytes.resize(kMostBytes);
  sdo.upload(object, answer.bytes, port.now());
  converse(port, sdo, node);
  if (sdo.state() == SdoClient::State::Refused) return Answer{{}, sdo.abort_code()};
  if (sdo.state() != SdoClient::State::Done) return trouble(sdo, node, object);
  answer.bytes.resize(sdo.size());
  return answer;
}

/// Whether a statusword tells of a drive with power on its motor.
bool has_power(std::uint16_t statusword) noexcept {
  switch (drive_state(statusword)) {
    case DriveState::OperationEnabled:
    case DriveState::QuickStopActive:
    case DriveState::FaultReactionActive:
      return true;
    default:
      return false;
  }
}

/// No axis of this node has power on its motor. One that has no statusword is no drive.
Expected<> check_without_power(CanPort& port, std::uint8_t node) {
  constexpr std::uint16_t kStatusword = 0x6041;
  for (std::size_t axis = 0; axis < kMostAxesPerNode; ++axis) {
    const ObjectAddress object{static_cast<std::uint16_t>(kStatusword + axis * kAxisOffset), 0};
    const auto answer = ask(port, node, object, std::chrono::seconds(1));
    if (!answer) return tl::unexpected(answer.error());
    if (answer->bytes.size() != 2) continue;
    const std::uint16_t word = word_at(answer->bytes.data());
    if (has_power(word)) {
      return failure(MinorCode::UnsupportedOperation,
                     fmt::format("node {} has power on its motor: {} is {:04X}h ({}). Take it first (controlword "
                                 "6040h = 0), or unload the machine",
                                 node, to_string(object), word, drive_state_text(word)));
    }
  }
  return {};
}

}  // namespace

Expected<std::vector<std::uint8_t>> read_object(CanPort& port, std::uint8_t node, ObjectAddress object,
                                                std::chrono::nanoseconds timeout) {
  auto answer = ask(port, node, object, timeout);
  if (!answer) return tl::unexpected(answer.error());
  if (answer->refusal) return refusal(node, object, *answer->refusal);
  return std::move(answer->bytes);
}

Expected<> write_object(CanPort& port, std::uint8_t node, ObjectAddress object, std::span<const std::uint8_t> bytes,
                        std::chrono::nanoseconds timeout) {
  SdoClient sdo(node, {.timeout = timeout, .block_from = kNoBlocks});
  sdo.download(object, bytes, port.now());
  converse(port, sdo, node);
  if (sdo.state() == SdoClient::State::Done) return {};
  if (sdo.state() == SdoClient::State::Refused) return refusal(node, object, sdo.abort_code());
  return trouble(sdo, node, object);
}

Expected<> check_moves_nothing(CanPort& port, std::uint8_t node, ObjectAddress object,
                               std::span<const std::uint8_t> bytes) {
  using namespace controlword;
  constexpr ObjectAddress kControlword{0x6040, 0};
  // To take a drive's power, or to reset its fault, must be possible in any state.
  if (of_first_axis(object) != kControlword) return check_without_power(port, node);
  constexpr std::uint16_t kEnables = kSwitchOn | kEnableVoltage | kNoQuickStop | kEnableOperation;
  if (bytes.size() == 2 && (word_at(bytes.data()) & kEnables) != kEnables) return {};
  return failure(MinorCode::UnsupportedOperation,
                 fmt::format("{:04X}h would give the motor power, and nobody would watch it; rmac bus move moves a "
                             "drive, and stops it",
                             bytes.size() == 2 ? word_at(bytes.data()) : 0));
}

}  // namespace rmac::fieldbus::canopen
