#include "rmac/fieldbus/canopen/sdo_client.hpp"

#include <algorithm>

namespace rmac::fieldbus::canopen {

SdoClient::SdoClient(std::uint8_t node, Options options) : options_(options), dialogue_(node) {
  options_.block_size = std::clamp(options_.block_size, std::uint8_t{1}, kSdoSequenceBits);
}

void SdoClient::upload(ObjectAddress object, std::span<std::uint8_t> into, std::chrono::nanoseconds now) noexcept {
  uploads_ = true;
  deadline_ = now + options_.timeout;
  dialogue_.begin(object);
  const auto switch_below = static_cast<std::uint8_t>(std::min<std::size_t>(options_.block_from - 1, 0xFF));
  upload_.begin(into, {into.size() >= options_.block_from, options_.block_size, switch_below}, dialogue_);
}

void SdoClient::download(ObjectAddress object, std::span<const std::uint8_t> data,
                         std::chrono::nanoseconds now) noexcept {
  uploads_ = false;
  deadline_ = now + options_.timeout;
  dialogue_.begin(object);
  download_.begin(data, data.size() >= options_.block_from, dialogue_);
}

void SdoClient::receive(const CanFrame& frame, std::chrono::nanoseconds now) noexcept {
  constexpr std::size_t kSdoSize = 8;  // every SDO frame has all its bytes (7.2.4.3)
  if (state() != State::Busy || frame.size != kSdoSize) return;
  if (frame.data[0] == kSdoAbort) return take_abort(frame);
  if (!uploads_ && download_.sends_block()) return;
  if ((uploads_ ? upload_.initiating() : download_.initiating()) && !dialogue_.is_about(frame)) return;
  deadline_ = now + options_.timeout;
  if (uploads_) {
    upload_.receive(frame, dialogue_);
  } else {
    download_.receive(frame, dialogue_);
  }
}

bool SdoClient::next_frame(std::chrono::nanoseconds now, CanFrame& frame) noexcept {
  if (!dialogue_.pending() && state() == State::Busy) {
    if (!uploads_ && download_.sends_block()) {
      download_.put_segment(dialogue_);
      deadline_ = now + options_.timeout;
    } else if (now >= deadline_) {
      dialogue_.abort(sdo_abort::kTimeout);
    }
  }
  return dialogue_.take(frame);
}

void SdoClient::take_abort(const CanFrame& frame) noexcept {
  // Some servers name no object in an abort.
  const bool unnamed = word_at(&frame.data[1]) == 0 && frame.data[3] == 0;
  if (!unnamed && !dialogue_.is_about(frame)) return;
  const std::uint32_t code = long_at(&frame.data[4]);
  // A server without block transfers says that it does not know the command.
  if (code == sdo_abort::kCommand && (uploads_ ? upload_.fall_back(dialogue_) : download_.fall_back(dialogue_))) return;
  dialogue_.refuse(code);
}

}  // namespace rmac::fieldbus::canopen
