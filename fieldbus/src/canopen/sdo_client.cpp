#include "rmac/fieldbus/canopen/sdo_client.hpp"

#include <algorithm>

namespace rmac::fieldbus::canopen {
namespace {

constexpr std::uint16_t kToServer = 0x600;
constexpr std::size_t kSegment = 7;
constexpr std::size_t kExpedited = 4;

// Command bytes (CiA 301, 7.2.4.3.3 to 7.2.4.3.16): the specifier in bits 7 to 5, below it flags and counts.
constexpr std::uint8_t kSpecifier = 0xE0;
constexpr std::uint8_t kBlockSpecifier = 0xE3;  ///< with the subcommand of block transfers
constexpr std::uint8_t kAbort = 0x80;
constexpr std::uint8_t kToggleBit = 0x10;
constexpr std::uint8_t kUploadSegment = 0x60;
constexpr std::uint8_t kBlockUploadStart = 0xA3;
constexpr std::uint8_t kBlockUploadAck = 0xA2;
constexpr std::uint8_t kBlockUploadEnd = 0xA1;
constexpr std::uint8_t kLastSegment = 0x80;
constexpr std::uint8_t kSequenceBits = 0x7F;
constexpr std::uint8_t kMostStalls = 3;

bool sound_block_size(std::uint8_t size) noexcept {
  return size >= 1 && size <= kSequenceBits;
}

}  // namespace

SdoClient::SdoClient(std::uint8_t node, Options options) : node_(node), options_(options) {
  options_.block_size = std::clamp(options_.block_size, std::uint8_t{1}, kSequenceBits);
}

void SdoClient::begin(ObjectAddress object, std::chrono::nanoseconds now) noexcept {
  state_ = State::Busy;
  object_ = object;
  abort_code_ = 0;
  moved_ = 0;
  announced_ = 0;
  announces_ = false;
  toggle_ = 0;
  sequence_ = stalls_ = 0;
  with_crc_ = last_seen_ = tail_waits_ = false;
  deadline_ = now + options_.timeout;
}

void SdoClient::upload(ObjectAddress object, std::span<std::uint8_t> into, std::chrono::nanoseconds now) noexcept {
  begin(object, now);
  into_ = into;
  from_ = {};
  initiate_upload(into.size() >= options_.block_from);
}

void SdoClient::download(ObjectAddress object, std::span<const std::uint8_t> data,
                         std::chrono::nanoseconds now) noexcept {
  begin(object, now);
  into_ = {};
  from_ = data;
  initiate_download(data.size() > kExpedited && data.size() >= options_.block_from);
}

void SdoClient::receive(const CanFrame& frame, std::chrono::nanoseconds now) noexcept {
  constexpr std::size_t kSdoSize = 8;  // every SDO frame has all its bytes (7.2.4.3)
  if (state_ != State::Busy || frame.size != kSdoSize) return;
  if (frame.data[0] == kAbort) return take_abort(frame);
  if (phase_ == Phase::Idle || phase_ == Phase::BlockDownloadData) return;
  if (initiating() && !answers_object(frame)) return;
  deadline_ = now + options_.timeout;
  switch (phase_) {
    case Phase::UploadInitiate:
      return take_upload_initiate(frame);
    case Phase::UploadSegment:
      return take_upload_segment(frame);
    case Phase::BlockUploadInitiate:
      return take_block_upload_initiate(frame);
    case Phase::BlockUploadData:
      return take_block_upload_data(frame);
    case Phase::BlockUploadEnd:
      return take_block_upload_end(frame);
    case Phase::DownloadInitiate:
      return take_download_initiate(frame);
    case Phase::DownloadSegment:
      return take_download_segment(frame);
    case Phase::BlockDownloadInitiate:
      return take_block_download_initiate(frame);
    case Phase::BlockDownloadAck:
      return take_block_download_ack(frame);
    case Phase::BlockDownloadEnd:
      return take_block_download_end(frame);
    case Phase::BlockDownloadData:
    case Phase::Idle:
      return;
  }
}

bool SdoClient::next_frame(std::chrono::nanoseconds now, CanFrame& frame) noexcept {
  if (!pending_ && state_ == State::Busy) {
    if (phase_ == Phase::BlockDownloadData) {
      block_segment(frame);
      deadline_ = now + options_.timeout;
      return true;
    }
    if (now >= deadline_) abort(sdo_abort::kTimeout);
  }
  if (!pending_) return false;
  frame = out_;
  pending_ = false;
  return true;
}

void SdoClient::take_abort(const CanFrame& frame) noexcept {
  // Some servers name no object in an abort.
  const bool unnamed = word_at(&frame.data[1]) == 0 && frame.data[3] == 0;
  if (!unnamed && !answers_object(frame)) return;
  const std::uint32_t code = long_at(&frame.data[4]);
  // A server without block transfers says that it does not know the command.
  if (code == sdo_abort::kCommand && phase_ == Phase::BlockUploadInitiate) return initiate_upload(false);
  if (code == sdo_abort::kCommand && phase_ == Phase::BlockDownloadInitiate) return initiate_download(false);
  abort_code_ = code;
  state_ = State::Refused;
  phase_ = Phase::Idle;
  pending_ = false;
}

bool SdoClient::initiating() const noexcept {
  return phase_ == Phase::UploadInitiate || phase_ == Phase::BlockUploadInitiate || phase_ == Phase::DownloadInitiate ||
         phase_ == Phase::BlockDownloadInitiate;
}

bool SdoClient::answers_object(const CanFrame& frame) const noexcept {
  return ObjectAddress{word_at(&frame.data[1]), frame.data[3]} == object_;
}

void SdoClient::put(std::uint8_t command, bool with_object) noexcept {
  out_ = CanFrame{};
  out_.id = static_cast<std::uint16_t>(kToServer + node_);
  out_.size = 8;
  out_.data[0] = command;
  if (with_object) {
    put_word(&out_.data[1], object_.index);
    out_.data[3] = object_.sub;
  }
  pending_ = true;
}

void SdoClient::abort(std::uint32_t code) noexcept {
  put(kAbort, true);
  put_long(&out_.data[4], code);
  abort_code_ = code;
  state_ = State::Failed;
  phase_ = Phase::Idle;
}

void SdoClient::done() noexcept {
  state_ = State::Done;
  phase_ = Phase::Idle;
}

bool SdoClient::store(std::span<const std::uint8_t> bytes) noexcept {
  if (bytes.size() > into_.size() - moved_) {
    abort(sdo_abort::kMemory);
    return false;
  }
  std::copy(bytes.begin(), bytes.end(), into_.begin() + static_cast<std::ptrdiff_t>(moved_));
  moved_ += bytes.size();
  return true;
}

// Uploads: expedited and segmented (7.2.4.3.5, 7.2.4.3.6)

void SdoClient::initiate_upload(bool block) noexcept {
  if (!block) {
    put(0x40, true);
    phase_ = Phase::UploadInitiate;
    return;
  }
  constexpr std::uint8_t kWithCrc = 0x04;
  put(0xA0 | kWithCrc, true);
  out_.data[4] = options_.block_size;
  // Up to so many bytes the server may answer with an ordinary upload instead.
  out_.data[5] = static_cast<std::uint8_t>(std::min<std::size_t>(options_.block_from - 1, 0xFF));
  phase_ = Phase::BlockUploadInitiate;
}

void SdoClient::take_upload_initiate(const CanFrame& frame) noexcept {
  const std::uint8_t command = frame.data[0];
  if ((command & kSpecifier) != 0x40) return abort(sdo_abort::kCommand);
  const bool expedited = (command & 0x02) != 0;
  const bool sized = (command & 0x01) != 0;
  if (expedited) {
    const std::size_t size = sized ? kExpedited - (command >> 2 & 3U) : std::min(kExpedited, into_.size());
    if (store({&frame.data[4], size})) done();
    return;
  }
  announces_ = sized;
  announced_ = long_at(&frame.data[4]);
  if (announces_ && announced_ > into_.size()) return abort(sdo_abort::kMemory);
  request_segment();
}

void SdoClient::request_segment() noexcept {
  put(kUploadSegment | toggle_, false);
  phase_ = Phase::UploadSegment;
}

void SdoClient::take_upload_segment(const CanFrame& frame) noexcept {
  const std::uint8_t command = frame.data[0];
  if ((command & kSpecifier) != 0x00) return abort(sdo_abort::kCommand);
  if ((command & kToggleBit) != toggle_) return abort(sdo_abort::kToggle);
  if (!store({&frame.data[1], kSegment - (command >> 1 & 7U)})) return;
  if ((command & 0x01) == 0) {
    toggle_ ^= kToggleBit;
    return request_segment();
  }
  if (announces_ && moved_ != announced_) return abort(sdo_abort::kLength);
  done();
}

// Uploads: block (7.2.4.3.13 to 7.2.4.3.16)

void SdoClient::take_block_upload_initiate(const CanFrame& frame) noexcept {
  const std::uint8_t command = frame.data[0];
  if ((command & kSpecifier) == 0x40) return take_upload_initiate(frame);
  if ((command & 0xE1) != 0xC0) return abort(sdo_abort::kCommand);
  with_crc_ = (command & 0x04) != 0;
  announces_ = (command & 0x02) != 0;
  announced_ = long_at(&frame.data[4]);
  if (announces_ && announced_ > into_.size()) return abort(sdo_abort::kMemory);
  put(kBlockUploadStart, false);
  phase_ = Phase::BlockUploadData;
}

void SdoClient::take_block_upload_data(const CanFrame& frame) noexcept {
  const std::uint8_t sequence = frame.data[0] & kSequenceBits;
  const bool last = (frame.data[0] & kLastSegment) != 0;
  if (sequence == 0 || sequence > options_.block_size) return abort(sdo_abort::kSequence);
  // A segment out of order is dropped; the acknowledgement makes the server send again from there.
  if (sequence == sequence_ + 1) {
    if (tail_waits_ && !store(tail_)) return;
    std::copy_n(frame.data.begin() + 1, kSegment, tail_.begin());
    tail_waits_ = true;
    sequence_ = sequence;
    last_seen_ = last;
  }
  if (!last && sequence != options_.block_size) return;
  put(kBlockUploadAck, false);
  out_.data[1] = sequence_;
  out_.data[2] = options_.block_size;
  sequence_ = 0;
  if (last_seen_) phase_ = Phase::BlockUploadEnd;
}

void SdoClient::take_block_upload_end(const CanFrame& frame) noexcept {
  const std::uint8_t command = frame.data[0];
  if ((command & kBlockSpecifier) != 0xC1) return abort(sdo_abort::kCommand);
  if (!store({tail_.data(), kSegment - (command >> 2 & 7U)})) return;
  if (announces_ && moved_ != announced_) return abort(sdo_abort::kLength);
  if (with_crc_ && sdo_crc(into_.first(moved_)) != word_at(&frame.data[1])) return abort(sdo_abort::kCrc);
  put(kBlockUploadEnd, false);
  done();
}

// Downloads: expedited and segmented (7.2.4.3.3, 7.2.4.3.4)

std::span<const std::uint8_t> SdoClient::rest(std::size_t from) const noexcept {
  return from_.subspan(from, std::min(kSegment, from_.size() - from));
}

void SdoClient::initiate_download(bool block) noexcept {
  if (block) {
    constexpr std::uint8_t kWithCrcAndSize = 0x06;
    put(0xC0 | kWithCrcAndSize, true);
    put_long(&out_.data[4], static_cast<std::uint32_t>(from_.size()));
    phase_ = Phase::BlockDownloadInitiate;
    return;
  }
  phase_ = Phase::DownloadInitiate;
  if (!from_.empty() && from_.size() <= kExpedited) {
    put(static_cast<std::uint8_t>(0x23 | (kExpedited - from_.size()) << 2), true);
    std::copy(from_.begin(), from_.end(), out_.data.begin() + 4);
    return;
  }
  put(0x21, true);
  put_long(&out_.data[4], static_cast<std::uint32_t>(from_.size()));
}

void SdoClient::take_download_initiate(const CanFrame& frame) noexcept {
  if ((frame.data[0] & kSpecifier) != 0x60) return abort(sdo_abort::kCommand);
  if (!from_.empty() && from_.size() <= kExpedited) {
    moved_ = from_.size();
    return done();
  }
  send_segment();
}

void SdoClient::send_segment() noexcept {
  const auto bytes = rest(moved_);
  const bool last = moved_ + bytes.size() == from_.size();
  put(static_cast<std::uint8_t>(toggle_ | (kSegment - bytes.size()) << 1 | (last ? 1 : 0)), false);
  std::copy(bytes.begin(), bytes.end(), out_.data.begin() + 1);
  phase_ = Phase::DownloadSegment;
}

void SdoClient::take_download_segment(const CanFrame& frame) noexcept {
  if ((frame.data[0] & kSpecifier) != 0x20) return abort(sdo_abort::kCommand);
  if ((frame.data[0] & kToggleBit) != toggle_) return abort(sdo_abort::kToggle);
  moved_ += rest(moved_).size();
  toggle_ ^= kToggleBit;
  if (moved_ == from_.size()) return done();
  send_segment();
}

// Downloads: block (7.2.4.3.9 to 7.2.4.3.12)

void SdoClient::take_block_download_initiate(const CanFrame& frame) noexcept {
  if ((frame.data[0] & kBlockSpecifier) != 0xA0) return abort(sdo_abort::kCommand);
  with_crc_ = (frame.data[0] & 0x04) != 0;
  block_size_ = frame.data[4];
  if (!sound_block_size(block_size_)) return abort(sdo_abort::kBlockSize);
  phase_ = Phase::BlockDownloadData;
}

void SdoClient::block_segment(CanFrame& frame) noexcept {
  const auto bytes = rest(moved_ + sequence_ * kSegment);
  ++sequence_;
  const bool last = moved_ + (sequence_ - 1U) * kSegment + bytes.size() == from_.size();
  put(static_cast<std::uint8_t>(sequence_ | (last ? kLastSegment : 0)), false);
  std::copy(bytes.begin(), bytes.end(), out_.data.begin() + 1);
  frame = out_;
  pending_ = false;
  if (last || sequence_ == block_size_) phase_ = Phase::BlockDownloadAck;
}

void SdoClient::take_block_download_ack(const CanFrame& frame) noexcept {
  if ((frame.data[0] & kBlockSpecifier) != 0xA2) return abort(sdo_abort::kCommand);
  const std::uint8_t taken = frame.data[1];
  if (taken > sequence_) return abort(sdo_abort::kSequence);
  if (!sound_block_size(frame.data[2])) return abort(sdo_abort::kBlockSize);
  block_size_ = frame.data[2];
  stalls_ = taken == 0 ? static_cast<std::uint8_t>(stalls_ + 1) : std::uint8_t{0};
  if (stalls_ == kMostStalls) return abort(sdo_abort::kSequence);
  sequence_ = 0;
  moved_ = std::min(moved_ + taken * kSegment, from_.size());
  if (moved_ < from_.size()) {
    phase_ = Phase::BlockDownloadData;
    return;
  }
  const std::size_t in_last = (from_.size() - 1) % kSegment + 1;
  put(static_cast<std::uint8_t>(0xC1 | (kSegment - in_last) << 2), false);
  if (with_crc_) put_word(&out_.data[1], sdo_crc(from_));
  phase_ = Phase::BlockDownloadEnd;
}

void SdoClient::take_block_download_end(const CanFrame& frame) noexcept {
  if ((frame.data[0] & kBlockSpecifier) != 0xA1) return abort(sdo_abort::kCommand);
  done();
}

}  // namespace rmac::fieldbus::canopen
