#include "rmac/fieldbus/canopen/sdo_client.hpp"

#include <algorithm>

namespace rmac::fieldbus::canopen {
namespace {

constexpr std::uint16_t kToServer = 0x600;

}  // namespace

SdoClient::SdoClient(std::uint8_t node, Options options)
    : node_(node),
      timeout_(options.timeout),
      upload_(options.block_from, std::clamp(options.block_size, std::uint8_t{1}, sdo_command::kSequenceBits)),
      download_(options.block_from) {}

void SdoClient::begin(ObjectAddress object, std::chrono::nanoseconds now) noexcept {
  state_ = State::Busy;
  object_ = object;
  abort_code_ = 0;
  deadline_ = now + timeout_;
}

void SdoClient::upload(ObjectAddress object, std::span<std::uint8_t> into, std::chrono::nanoseconds now) noexcept {
  begin(object, now);
  uploads_ = true;
  act(upload_.begin(object, into));
}

void SdoClient::download(ObjectAddress object, std::span<const std::uint8_t> data,
                         std::chrono::nanoseconds now) noexcept {
  begin(object, now);
  uploads_ = false;
  act(download_.begin(object, data));
}

bool SdoClient::initiating() const noexcept {
  return uploads_ ? upload_.initiating() : download_.initiating();
}

bool SdoClient::tries_blocks() const noexcept {
  return uploads_ ? upload_.tries_blocks() : download_.tries_blocks();
}

void SdoClient::receive(const CanFrame& frame, std::chrono::nanoseconds now) noexcept {
  if (state_ != State::Busy || frame.size != SdoBytes().size()) return;
  if (frame.data[0] == sdo_command::kAbort) return take_abort(frame);
  if (initiating() && !answers_object(frame)) return;
  deadline_ = now + timeout_;
  SdoBytes answer;
  std::copy_n(frame.data.begin(), answer.size(), answer.begin());
  act(uploads_ ? upload_.take(answer) : download_.take(answer));
}

bool SdoClient::next_frame(std::chrono::nanoseconds now, CanFrame& frame) noexcept {
  if (!pending_ && state_ == State::Busy) {
    if (!uploads_ && download_.streams()) {
      frame = frame_of(download_.next_segment());
      deadline_ = now + timeout_;
      return true;
    }
    if (now >= deadline_) abort(sdo_abort::kTimeout);
  }
  if (!pending_) return false;
  frame = out_;
  pending_ = false;
  return true;
}

void SdoClient::act(const SdoStep& step) noexcept {
  switch (step.kind) {
    case SdoStep::Kind::Wait:
      return;
    case SdoStep::Kind::Abort:
      return abort(step.abort_code);
    case SdoStep::Kind::Send:
      return send(step.bytes);
    case SdoStep::Kind::SendAndDone:
      send(step.bytes);
      [[fallthrough]];
    case SdoStep::Kind::Done:
      state_ = State::Done;
      return;
  }
}

void SdoClient::take_abort(const CanFrame& frame) noexcept {
  // Some servers name no object in an abort.
  const bool unnamed = word_at(&frame.data[1]) == 0 && frame.data[3] == 0;
  if (!unnamed && !answers_object(frame)) return;
  const std::uint32_t code = long_at(&frame.data[4]);
  // A server without block transfers says that it does not know the command.
  if (code == sdo_abort::kCommand && tries_blocks()) {
    return act(uploads_ ? upload_.begin_without_blocks() : download_.begin_without_blocks());
  }
  abort_code_ = code;
  state_ = State::Refused;
  pending_ = false;
}

bool SdoClient::answers_object(const CanFrame& frame) const noexcept {
  return ObjectAddress{word_at(&frame.data[1]), frame.data[3]} == object_;
}

CanFrame SdoClient::frame_of(const SdoBytes& bytes) const noexcept {
  CanFrame frame;
  frame.id = static_cast<std::uint16_t>(kToServer + node_);
  frame.size = static_cast<std::uint8_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), frame.data.begin());
  return frame;
}

void SdoClient::send(const SdoBytes& bytes) noexcept {
  out_ = frame_of(bytes);
  pending_ = true;
}

void SdoClient::abort(std::uint32_t code) noexcept {
  SdoBytes bytes = sdo_frame(sdo_command::kAbort, object_);
  put_long(&bytes[4], code);
  send(bytes);
  abort_code_ = code;
  state_ = State::Failed;
}

}  // namespace rmac::fieldbus::canopen
