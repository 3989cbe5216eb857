#include "rmac/fieldbus/canopen/sdo_dialogue.hpp"

namespace rmac::fieldbus::canopen {
namespace {

constexpr std::uint16_t kToServer = 0x600;

}  // namespace

void SdoDialogue::begin(ObjectAddress object) noexcept {
  object_ = object;
  state_ = SdoState::Busy;
  abort_code_ = 0;
}

void SdoDialogue::refuse(std::uint32_t code) noexcept {
  abort_code_ = code;
  state_ = SdoState::Refused;
  pending_ = false;
}

void SdoDialogue::abort(std::uint32_t code) noexcept {
  put_long(&put_for_object(kSdoAbort).data[4], code);
  abort_code_ = code;
  state_ = SdoState::Failed;
}

CanFrame& SdoDialogue::put(std::uint8_t command) noexcept {
  out_ = CanFrame{};
  out_.id = static_cast<std::uint16_t>(kToServer + node_);
  out_.size = 8;
  out_.data[0] = command;
  pending_ = true;
  return out_;
}

CanFrame& SdoDialogue::put_for_object(std::uint8_t command) noexcept {
  put(command);
  put_word(&out_.data[1], object_.index);
  out_.data[3] = object_.sub;
  return out_;
}

bool SdoDialogue::take(CanFrame& frame) noexcept {
  if (!pending_) return false;
  frame = out_;
  pending_ = false;
  return true;
}

bool SdoDialogue::is_about(const CanFrame& frame) const noexcept {
  return ObjectAddress{word_at(&frame.data[1]), frame.data[3]} == object_;
}

}  // namespace rmac::fieldbus::canopen
