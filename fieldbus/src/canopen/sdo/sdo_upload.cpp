#include "rmac/fieldbus/canopen/sdo_upload.hpp"

#include <algorithm>

namespace rmac::fieldbus::canopen {

using sdo_command::kBlockSpecifier;
using sdo_command::kExpedited;
using sdo_command::kLastSegment;
using sdo_command::kSegment;
using sdo_command::kSequenceBits;
using sdo_command::kSpecifier;
using sdo_command::kToggleBit;

namespace {

constexpr std::uint8_t kInitiate = 0x40;
constexpr std::uint8_t kSegmentRequest = 0x60;
constexpr std::uint8_t kBlockUploadInitiate = 0xA0;
constexpr std::uint8_t kBlockStart = 0xA3;
constexpr std::uint8_t kBlockAck = 0xA2;
constexpr std::uint8_t kBlockUploadEnd = 0xA1;

}  // namespace

SdoStep SdoUpload::begin(ObjectAddress object, std::span<std::uint8_t> into) noexcept {
  *this = SdoUpload(block_from_, block_size_);
  object_ = object;
  into_ = into;
  if (into.size() < block_from_) return begin_without_blocks();
  constexpr std::uint8_t kWithCrc = 0x04;
  SdoBytes bytes = sdo_frame(kBlockUploadInitiate | kWithCrc, object_);
  bytes[4] = block_size_;
  // Up to so many bytes the server may answer with an ordinary upload instead.
  bytes[5] = static_cast<std::uint8_t>(std::min<std::size_t>(block_from_ - 1, 0xFF));
  phase_ = Phase::BlockInitiate;
  return SdoStep::send(bytes);
}

SdoStep SdoUpload::begin_without_blocks() noexcept {
  phase_ = Phase::Initiate;
  return SdoStep::send(sdo_frame(kInitiate, object_));
}

SdoStep SdoUpload::take(const SdoBytes& answer) noexcept {
  switch (phase_) {
    case Phase::Initiate:
      return take_initiate(answer);
    case Phase::Segment:
      return take_segment(answer);
    case Phase::BlockInitiate:
      return take_block_initiate(answer);
    case Phase::BlockData:
      return take_block_data(answer);
    case Phase::BlockEnd:
      return take_block_end(answer);
  }
  return {};
}

bool SdoUpload::announce(bool sized, const SdoBytes& answer) noexcept {
  announces_ = sized;
  announced_ = long_at(&answer[4]);
  return !announces_ || announced_ <= into_.size();
}

bool SdoUpload::store(std::span<const std::uint8_t> bytes) noexcept {
  if (bytes.size() > into_.size() - stored_) return false;
  std::copy(bytes.begin(), bytes.end(), into_.begin() + static_cast<std::ptrdiff_t>(stored_));
  stored_ += bytes.size();
  return true;
}

SdoStep SdoUpload::take_initiate(const SdoBytes& answer) noexcept {
  const std::uint8_t command = answer[0];
  if ((command & kSpecifier) != kInitiate) return SdoStep::abort(sdo_abort::kCommand);
  const bool expedited = (command & 0x02) != 0;
  const bool sized = (command & 0x01) != 0;
  if (expedited) {
    const std::size_t size = sized ? kExpedited - (command >> 2 & 3U) : std::min(kExpedited, into_.size());
    return store({&answer[4], size}) ? SdoStep::done() : SdoStep::abort(sdo_abort::kMemory);
  }
  return announce(sized, answer) ? request_segment() : SdoStep::abort(sdo_abort::kMemory);
}

SdoStep SdoUpload::request_segment() noexcept {
  phase_ = Phase::Segment;
  return SdoStep::send(sdo_frame(kSegmentRequest | toggle_));
}

SdoStep SdoUpload::take_segment(const SdoBytes& answer) noexcept {
  const std::uint8_t command = answer[0];
  if ((command & kSpecifier) != 0x00) return SdoStep::abort(sdo_abort::kCommand);
  if ((command & kToggleBit) != toggle_) return SdoStep::abort(sdo_abort::kToggle);
  if (!store({&answer[1], kSegment - (command >> 1 & 7U)})) return SdoStep::abort(sdo_abort::kMemory);
  if ((command & 0x01) == 0) {
    toggle_ ^= kToggleBit;
    return request_segment();
  }
  return complete() ? SdoStep::done() : SdoStep::abort(sdo_abort::kLength);
}

SdoStep SdoUpload::take_block_initiate(const SdoBytes& answer) noexcept {
  const std::uint8_t command = answer[0];
  if ((command & kSpecifier) == kInitiate) return take_initiate(answer);
  if ((command & 0xE1) != 0xC0) return SdoStep::abort(sdo_abort::kCommand);
  with_crc_ = (command & 0x04) != 0;
  if (!announce((command & 0x02) != 0, answer)) return SdoStep::abort(sdo_abort::kMemory);
  phase_ = Phase::BlockData;
  return SdoStep::send(sdo_frame(kBlockStart));
}

SdoStep SdoUpload::take_block_data(const SdoBytes& answer) noexcept {
  const std::uint8_t sequence = answer[0] & kSequenceBits;
  const bool last = (answer[0] & kLastSegment) != 0;
  if (sequence == 0 || sequence > block_size_) return SdoStep::abort(sdo_abort::kSequence);
  // A segment out of order is dropped; the acknowledgement makes the server send again from there.
  if (sequence == sequence_ + 1) {
    if (tail_waits_ && !store(tail_)) return SdoStep::abort(sdo_abort::kMemory);
    std::copy_n(answer.begin() + 1, kSegment, tail_.begin());
    tail_waits_ = true;
    sequence_ = sequence;
    last_seen_ = last;
  }
  if (!last && sequence != block_size_) return {};
  SdoBytes acknowledgement = sdo_frame(kBlockAck);
  acknowledgement[1] = sequence_;
  acknowledgement[2] = block_size_;
  sequence_ = 0;
  if (last_seen_) phase_ = Phase::BlockEnd;
  return SdoStep::send(acknowledgement);
}

SdoStep SdoUpload::take_block_end(const SdoBytes& answer) noexcept {
  const std::uint8_t command = answer[0];
  if ((command & kBlockSpecifier) != 0xC1) return SdoStep::abort(sdo_abort::kCommand);
  if (!store({tail_.data(), kSegment - (command >> 2 & 7U)})) return SdoStep::abort(sdo_abort::kMemory);
  if (!complete()) return SdoStep::abort(sdo_abort::kLength);
  if (with_crc_ && sdo_crc(into_.first(stored_)) != word_at(&answer[1])) return SdoStep::abort(sdo_abort::kCrc);
  return SdoStep::send_and_done(sdo_frame(kBlockUploadEnd));
}

}  // namespace rmac::fieldbus::canopen
