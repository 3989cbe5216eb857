#include "rmac/fieldbus/canopen/sdo_upload.hpp"

#include <algorithm>

namespace rmac::fieldbus::canopen {
namespace {

constexpr std::uint8_t kSegment = 0x60;
constexpr std::uint8_t kBlockStart = 0xA3;
constexpr std::uint8_t kBlockAck = 0xA2;
constexpr std::uint8_t kBlockEnd = 0xA1;

}  // namespace

void SdoUpload::begin(std::span<std::uint8_t> into, const Blocks& blocks, SdoDialogue& dialogue) noexcept {
  *this = SdoUpload();
  into_ = into;
  block_size_ = blocks.size;
  if (!blocks.tried) return initiate(dialogue);
  constexpr std::uint8_t kWithCrc = 0x04;
  CanFrame& out = dialogue.put_for_object(0xA0 | kWithCrc);
  out.data[4] = blocks.size;
  out.data[5] = blocks.switch_below;
  phase_ = Phase::BlockInitiate;
}

void SdoUpload::initiate(SdoDialogue& dialogue) noexcept {
  dialogue.put_for_object(0x40);
  phase_ = Phase::Initiate;
}

bool SdoUpload::fall_back(SdoDialogue& dialogue) noexcept {
  if (phase_ != Phase::BlockInitiate) return false;
  initiate(dialogue);
  return true;
}

void SdoUpload::receive(const CanFrame& frame, SdoDialogue& dialogue) noexcept {
  switch (phase_) {
    case Phase::Initiate:
      return take_initiate(frame, dialogue);
    case Phase::Segment:
      return take_segment(frame, dialogue);
    case Phase::BlockInitiate:
      return take_block_initiate(frame, dialogue);
    case Phase::BlockData:
      return take_block_data(frame, dialogue);
    case Phase::BlockEnd:
      return take_block_end(frame, dialogue);
  }
}

bool SdoUpload::store(std::span<const std::uint8_t> bytes, SdoDialogue& dialogue) noexcept {
  if (bytes.size() > into_.size() - moved_) {
    dialogue.abort(sdo_abort::kMemory);
    return false;
  }
  std::copy(bytes.begin(), bytes.end(), into_.begin() + static_cast<std::ptrdiff_t>(moved_));
  moved_ += bytes.size();
  return true;
}

void SdoUpload::take_initiate(const CanFrame& frame, SdoDialogue& dialogue) noexcept {
  const std::uint8_t command = frame.data[0];
  if ((command & kSdoSpecifier) != 0x40) return dialogue.abort(sdo_abort::kCommand);
  const bool expedited = (command & 0x02) != 0;
  const bool sized = (command & 0x01) != 0;
  if (expedited) {
    const std::size_t size = sized ? kSdoExpedited - (command >> 2 & 3U) : std::min(kSdoExpedited, into_.size());
    if (store({&frame.data[4], size}, dialogue)) dialogue.done();
    return;
  }
  announces_ = sized;
  announced_ = long_at(&frame.data[4]);
  if (announces_ && announced_ > into_.size()) return dialogue.abort(sdo_abort::kMemory);
  request_segment(dialogue);
}

void SdoUpload::request_segment(SdoDialogue& dialogue) noexcept {
  dialogue.put(kSegment | toggle_);
  phase_ = Phase::Segment;
}

void SdoUpload::take_segment(const CanFrame& frame, SdoDialogue& dialogue) noexcept {
  const std::uint8_t command = frame.data[0];
  if ((command & kSdoSpecifier) != 0x00) return dialogue.abort(sdo_abort::kCommand);
  if ((command & kSdoToggleBit) != toggle_) return dialogue.abort(sdo_abort::kToggle);
  if (!store({&frame.data[1], kSdoSegment - (command >> 1 & 7U)}, dialogue)) return;
  if ((command & 0x01) == 0) {
    toggle_ ^= kSdoToggleBit;
    return request_segment(dialogue);
  }
  if (announces_ && moved_ != announced_) return dialogue.abort(sdo_abort::kLength);
  dialogue.done();
}

void SdoUpload::take_block_initiate(const CanFrame& frame, SdoDialogue& dialogue) noexcept {
  const std::uint8_t command = frame.data[0];
  if ((command & kSdoSpecifier) == 0x40) return take_initiate(frame, dialogue);
  if ((command & 0xE1) != 0xC0) return dialogue.abort(sdo_abort::kCommand);
  with_crc_ = (command & 0x04) != 0;
  announces_ = (command & 0x02) != 0;
  announced_ = long_at(&frame.data[4]);
  if (announces_ && announced_ > into_.size()) return dialogue.abort(sdo_abort::kMemory);
  dialogue.put(kBlockStart);
  phase_ = Phase::BlockData;
}

void SdoUpload::take_block_data(const CanFrame& frame, SdoDialogue& dialogue) noexcept {
  const std::uint8_t sequence = frame.data[0] & kSdoSequenceBits;
  const bool last = (frame.data[0] & kSdoLastSegment) != 0;
  if (sequence == 0 || sequence > block_size_) return dialogue.abort(sdo_abort::kSequence);
  // A segment out of order is dropped; the acknowledgement makes the server send again from there.
  if (sequence == sequence_ + 1) {
    if (tail_waits_ && !store(tail_, dialogue)) return;
    std::copy_n(frame.data.begin() + 1, kSdoSegment, tail_.begin());
    tail_waits_ = true;
    sequence_ = sequence;
    last_seen_ = last;
  }
  if (!last && sequence != block_size_) return;
  CanFrame& out = dialogue.put(kBlockAck);
  out.data[1] = sequence_;
  out.data[2] = block_size_;
  sequence_ = 0;
  if (last_seen_) phase_ = Phase::BlockEnd;
}

void SdoUpload::take_block_end(const CanFrame& frame, SdoDialogue& dialogue) noexcept {
  const std::uint8_t command = frame.data[0];
  if ((command & kSdoBlockSpecifier) != 0xC1) return dialogue.abort(sdo_abort::kCommand);
  if (!store({tail_.data(), kSdoSegment - (command >> 2 & 7U)}, dialogue)) return;
  if (announces_ && moved_ != announced_) return dialogue.abort(sdo_abort::kLength);
  if (with_crc_ && sdo_crc(into_.first(moved_)) != word_at(&frame.data[1])) return dialogue.abort(sdo_abort::kCrc);
  dialogue.put(kBlockEnd);
  dialogue.done();
}

}  // namespace rmac::fieldbus::canopen
