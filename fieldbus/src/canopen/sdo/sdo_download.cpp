#include "rmac/fieldbus/canopen/sdo_download.hpp"

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

constexpr std::uint8_t kInitiateExpedited = 0x23;
constexpr std::uint8_t kInitiateSized = 0x21;
constexpr std::uint8_t kBlockDownloadInitiate = 0xC0;
constexpr std::uint8_t kBlockDownloadEnd = 0xC1;
constexpr std::uint8_t kMostStalls = 3;

bool sound_block_size(std::uint8_t size) noexcept {
  return size >= 1 && size <= kSequenceBits;
}

}  // namespace

bool SdoDownload::fits_first_frame() const noexcept {
  return !data_.empty() && data_.size() <= kExpedited;
}

std::span<const std::uint8_t> SdoDownload::rest(std::size_t from) const noexcept {
  return data_.subspan(from, std::min(kSegment, data_.size() - from));
}

SdoStep SdoDownload::begin(ObjectAddress object, std::span<const std::uint8_t> data) noexcept {
  *this = SdoDownload(block_from_);
  object_ = object;
  data_ = data;
  if (data.size() <= kExpedited || data.size() < block_from_) return begin_without_blocks();
  constexpr std::uint8_t kWithCrcAndSize = 0x06;
  SdoBytes bytes = sdo_frame(kBlockDownloadInitiate | kWithCrcAndSize, object_);
  put_long(&bytes[4], static_cast<std::uint32_t>(data_.size()));
  phase_ = Phase::BlockInitiate;
  return SdoStep::send(bytes);
}

SdoStep SdoDownload::begin_without_blocks() noexcept {
  phase_ = Phase::Initiate;
  if (!fits_first_frame()) {
    SdoBytes bytes = sdo_frame(kInitiateSized, object_);
    put_long(&bytes[4], static_cast<std::uint32_t>(data_.size()));
    return SdoStep::send(bytes);
  }
  SdoBytes bytes = sdo_frame(static_cast<std::uint8_t>(kInitiateExpedited | (kExpedited - data_.size()) << 2), object_);
  std::copy(data_.begin(), data_.end(), bytes.begin() + 4);
  return SdoStep::send(bytes);
}

SdoStep SdoDownload::take(const SdoBytes& answer) noexcept {
  switch (phase_) {
    case Phase::Initiate:
      return take_initiate(answer);
    case Phase::Segment:
      return take_segment(answer);
    case Phase::BlockInitiate:
      return take_block_initiate(answer);
    case Phase::BlockAck:
      return take_block_ack(answer);
    case Phase::BlockEnd:
      return (answer[0] & kBlockSpecifier) == 0xA1 ? SdoStep::done() : SdoStep::abort(sdo_abort::kCommand);
    case Phase::BlockData:
      break;
  }
  return {};
}

SdoStep SdoDownload::take_initiate(const SdoBytes& answer) noexcept {
  if ((answer[0] & kSpecifier) != 0x60) return SdoStep::abort(sdo_abort::kCommand);
  return fits_first_frame() ? SdoStep::done() : segment();
}

SdoStep SdoDownload::segment() noexcept {
  const auto data = rest(taken_);
  const bool last = taken_ + data.size() == data_.size();
  SdoBytes bytes = sdo_frame(static_cast<std::uint8_t>(toggle_ | (kSegment - data.size()) << 1 | (last ? 1 : 0)));
  std::copy(data.begin(), data.end(), bytes.begin() + 1);
  phase_ = Phase::Segment;
  return SdoStep::send(bytes);
}

SdoStep SdoDownload::take_segment(const SdoBytes& answer) noexcept {
  if ((answer[0] & kSpecifier) != 0x20) return SdoStep::abort(sdo_abort::kCommand);
  if ((answer[0] & kToggleBit) != toggle_) return SdoStep::abort(sdo_abort::kToggle);
  taken_ += rest(taken_).size();
  toggle_ ^= kToggleBit;
  return taken_ == data_.size() ? SdoStep::done() : segment();
}

SdoStep SdoDownload::take_block_initiate(const SdoBytes& answer) noexcept {
  if ((answer[0] & kBlockSpecifier) != 0xA0) return SdoStep::abort(sdo_abort::kCommand);
  with_crc_ = (answer[0] & 0x04) != 0;
  block_size_ = answer[4];
  if (!sound_block_size(block_size_)) return SdoStep::abort(sdo_abort::kBlockSize);
  phase_ = Phase::BlockData;
  return {};
}

SdoBytes SdoDownload::next_segment() noexcept {
  const std::size_t from = taken_ + sequence_ * kSegment;
  const auto data = rest(from);
  ++sequence_;
  const bool last = from + data.size() == data_.size();
  SdoBytes bytes = sdo_frame(static_cast<std::uint8_t>(sequence_ | (last ? kLastSegment : 0)));
  std::copy(data.begin(), data.end(), bytes.begin() + 1);
  if (last || sequence_ == block_size_) phase_ = Phase::BlockAck;
  return bytes;
}

SdoStep SdoDownload::take_block_ack(const SdoBytes& answer) noexcept {
  if ((answer[0] & kBlockSpecifier) != 0xA2) return SdoStep::abort(sdo_abort::kCommand);
  const std::uint8_t segments = answer[1];
  if (segments > sequence_) return SdoStep::abort(sdo_abort::kSequence);
  if (!sound_block_size(answer[2])) return SdoStep::abort(sdo_abort::kBlockSize);
  block_size_ = answer[2];
  stalls_ = segments == 0 ? static_cast<std::uint8_t>(stalls_ + 1) : std::uint8_t{0};
  if (stalls_ == kMostStalls) return SdoStep::abort(sdo_abort::kSequence);
  sequence_ = 0;
  taken_ = std::min(taken_ + segments * kSegment, data_.size());
  phase_ = taken_ < data_.size() ? Phase::BlockData : Phase::BlockEnd;
  return phase_ == Phase::BlockEnd ? SdoStep::send(block_end()) : SdoStep{};
}

SdoBytes SdoDownload::block_end() const noexcept {
  const std::size_t in_last = (data_.size() - 1) % kSegment + 1;
  SdoBytes bytes = sdo_frame(static_cast<std::uint8_t>(kBlockDownloadEnd | (kSegment - in_last) << 2));
  if (with_crc_) put_word(&bytes[1], sdo_crc(data_));
  return bytes;
}

}  // namespace rmac::fieldbus::canopen
