#include "rmac/fieldbus/canopen/sdo_download.hpp"

#include <algorithm>

namespace rmac::fieldbus::canopen {
namespace {

constexpr std::uint8_t kMostStalls = 3;

bool sound_block_size(std::uint8_t size) noexcept {
  return size >= 1 && size <= kSdoSequenceBits;
}

}  // namespace

void SdoDownload::begin(std::span<const std::uint8_t> data, bool in_blocks, SdoDialogue& dialogue) noexcept {
  *this = SdoDownload();
  from_ = data;
  if (!in_blocks || data.size() <= kSdoExpedited) return initiate(dialogue);
  constexpr std::uint8_t kWithCrcAndSize = 0x06;
  put_long(&dialogue.put_for_object(0xC0 | kWithCrcAndSize).data[4], static_cast<std::uint32_t>(from_.size()));
  phase_ = Phase::BlockInitiate;
}

void SdoDownload::initiate(SdoDialogue& dialogue) noexcept {
  phase_ = Phase::Initiate;
  if (expedited()) {
    CanFrame& out = dialogue.put_for_object(static_cast<std::uint8_t>(0x23 | (kSdoExpedited - from_.size()) << 2));
    std::copy(from_.begin(), from_.end(), out.data.begin() + 4);
    return;
  }
  put_long(&dialogue.put_for_object(0x21).data[4], static_cast<std::uint32_t>(from_.size()));
}

bool SdoDownload::fall_back(SdoDialogue& dialogue) noexcept {
  if (phase_ != Phase::BlockInitiate) return false;
  initiate(dialogue);
  return true;
}

void SdoDownload::receive(const CanFrame& frame, SdoDialogue& dialogue) noexcept {
  switch (phase_) {
    case Phase::Initiate:
      return take_initiate(frame, dialogue);
    case Phase::Segment:
      return take_segment(frame, dialogue);
    case Phase::BlockInitiate:
      return take_block_initiate(frame, dialogue);
    case Phase::BlockAck:
      return take_block_ack(frame, dialogue);
    case Phase::BlockEnd:
      return take_block_end(frame, dialogue);
    case Phase::BlockData:
      return;
  }
}

std::span<const std::uint8_t> SdoDownload::rest(std::size_t from) const noexcept {
  return from_.subspan(from, std::min(kSdoSegment, from_.size() - from));
}

void SdoDownload::take_initiate(const CanFrame& frame, SdoDialogue& dialogue) noexcept {
  if ((frame.data[0] & kSdoSpecifier) != 0x60) return dialogue.abort(sdo_abort::kCommand);
  if (expedited()) {
    moved_ = from_.size();
    return dialogue.done();
  }
  send_segment(dialogue);
}

void SdoDownload::send_segment(SdoDialogue& dialogue) noexcept {
  const auto bytes = rest(moved_);
  const bool last = moved_ + bytes.size() == from_.size();
  CanFrame& out = dialogue.put(static_cast<std::uint8_t>(toggle_ | (kSdoSegment - bytes.size()) << 1 | (last ? 1 : 0)));
  std::copy(bytes.begin(), bytes.end(), out.data.begin() + 1);
  phase_ = Phase::Segment;
}

void SdoDownload::take_segment(const CanFrame& frame, SdoDialogue& dialogue) noexcept {
  if ((frame.data[0] & kSdoSpecifier) != 0x20) return dialogue.abort(sdo_abort::kCommand);
  if ((frame.data[0] & kSdoToggleBit) != toggle_) return dialogue.abort(sdo_abort::kToggle);
  moved_ += rest(moved_).size();
  toggle_ ^= kSdoToggleBit;
  if (moved_ == from_.size()) return dialogue.done();
  send_segment(dialogue);
}

void SdoDownload::take_block_initiate(const CanFrame& frame, SdoDialogue& dialogue) noexcept {
  if ((frame.data[0] & kSdoBlockSpecifier) != 0xA0) return dialogue.abort(sdo_abort::kCommand);
  with_crc_ = (frame.data[0] & 0x04) != 0;
  block_size_ = frame.data[4];
  if (!sound_block_size(block_size_)) return dialogue.abort(sdo_abort::kBlockSize);
  phase_ = Phase::BlockData;
}

void SdoDownload::put_segment(SdoDialogue& dialogue) noexcept {
  const auto bytes = rest(moved_ + sequence_ * kSdoSegment);
  ++sequence_;
  const bool last = moved_ + (sequence_ - 1U) * kSdoSegment + bytes.size() == from_.size();
  CanFrame& out = dialogue.put(static_cast<std::uint8_t>(sequence_ | (last ? kSdoLastSegment : 0)));
  std::copy(bytes.begin(), bytes.end(), out.data.begin() + 1);
  if (last || sequence_ == block_size_) phase_ = Phase::BlockAck;
}

void SdoDownload::take_block_ack(const CanFrame& frame, SdoDialogue& dialogue) noexcept {
  if ((frame.data[0] & kSdoBlockSpecifier) != 0xA2) return dialogue.abort(sdo_abort::kCommand);
  const std::uint8_t taken = frame.data[1];
  if (taken > sequence_) return dialogue.abort(sdo_abort::kSequence);
  if (!sound_block_size(frame.data[2])) return dialogue.abort(sdo_abort::kBlockSize);
  block_size_ = frame.data[2];
  stalls_ = taken == 0 ? static_cast<std::uint8_t>(stalls_ + 1) : std::uint8_t{0};
  if (stalls_ == kMostStalls) return dialogue.abort(sdo_abort::kSequence);
  sequence_ = 0;
  moved_ = std::min(moved_ + taken * kSdoSegment, from_.size());
  if (moved_ < from_.size()) {
    phase_ = Phase::BlockData;
    return;
  }
  const std::size_t in_last = (from_.size() - 1) % kSdoSegment + 1;
  CanFrame& out = dialogue.put(static_cast<std::uint8_t>(0xC1 | (kSdoSegment - in_last) << 2));
  if (with_crc_) put_word(&out.data[1], sdo_crc(from_));
  phase_ = Phase::BlockEnd;
}

void SdoDownload::take_block_end(const CanFrame& frame, SdoDialogue& dialogue) noexcept {
  if ((frame.data[0] & kSdoBlockSpecifier) != 0xA1) return dialogue.abort(sdo_abort::kCommand);
  dialogue.done();
}

}  // namespace rmac::fieldbus::canopen
