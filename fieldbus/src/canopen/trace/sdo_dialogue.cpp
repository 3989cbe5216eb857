#include "canopen/trace/sdo_dialogue.hpp"

#include <algorithm>

namespace rmac::fieldbus::canopen {

using sdo_command::kAbort;
using sdo_command::kExpedited;
using sdo_command::kLastSegment;
using sdo_command::kSegment;
using sdo_command::kSequenceBits;
using sdo_command::kSpecifier;
using sdo_command::kToggleBit;

namespace {

using Says = SdoRemark::Kind;

/// Beyond so many bytes a value is told as far as it came.
constexpr std::size_t kMostBytes = 1U << 20U;

// Specifiers of the client's frames, and of the server's (CiA 301, 7.2.4.3.3 to 16).
constexpr std::uint8_t kDownloadSegment = 0x00, kDownload = 0x20, kUpload = 0x40, kUploadSegment = 0x60,
                       kBlockUpload = 0xA0, kBlockDownload = 0xC0;
constexpr std::uint8_t kSegmentTold = 0x00, kSegmentTaken = 0x20, kTold = 0x40, kTaken = 0x60, kBlockTaken = 0xA0,
                       kBlockTold = 0xC0;
// Subcommands of block transfers
constexpr std::uint8_t kEnd = 1, kAcknowledged = 2, kStart = 3;

bool expedited(std::uint8_t command) noexcept {
  return (command & 0x02) != 0;
}
std::size_t expedited_bytes(std::uint8_t command) noexcept {
  const bool sized = (command & 0x01) != 0;
  return sized ? kExpedited - (command >> 2 & 3U) : kExpedited;
}

}  // namespace

SdoRemark SdoDialogue::from_client(const SdoBytes& bytes) {
  const std::uint8_t command = bytes[0];
  if (command == kAbort) return aborted(bytes);
  if (phase_ == Phase::BlockWrite && streams_) return take_block_segment(bytes);
  switch (command & kSpecifier) {
    case kUpload:
      return begin(Says::Reads, Phase::Read, bytes);
    case kUploadSegment:
      return goes_on();
    case kDownload: {
      SdoRemark remark = begin(Says::Writes, Phase::Write, bytes);
      if (!expedited(command)) return remark;
      store(&bytes[4], expedited_bytes(command));
      last_ = true;
      remark.bytes = data_;
      return remark;
    }
    case kDownloadSegment:
      return take_segment(bytes, Phase::Write);
    case kBlockDownload:
      if ((command & kEnd) == 0) return begin(Says::Writes, Phase::BlockWrite, bytes);
      drop_unused(command >> 2 & 7U);
      return goes_on();
    case kBlockUpload:
      if ((command & 3U) == 0) return begin(Says::Reads, Phase::BlockRead, bytes);
      if ((command & 3U) == kAcknowledged) return acknowledge(bytes[1]);
      streams_ = (command & 3U) == kStart;
      return goes_on();
    default:
      return {};
  }
}

SdoRemark SdoDialogue::from_server(const SdoBytes& bytes) {
  const std::uint8_t command = bytes[0];
  if (command == kAbort) return aborted(bytes);
  if (phase_ == Phase::BlockRead && streams_) return take_block_segment(bytes);
  switch (command & kSpecifier) {
    case kTold: {
      // It names the object, so that it is understood without its question, too; a block transfer may be answered so.
      SdoRemark remark = begin(Says::Goes, Phase::Read, bytes);
      if (!expedited(command)) return remark;
      store(&bytes[4], expedited_bytes(command));
      return done(Says::Read);
    }
    case kSegmentTold: {
      SdoRemark remark = take_segment(bytes, Phase::Read);
      return remark.kind == Says::Goes && last_ ? done(Says::Read) : remark;
    }
    case kTaken:
    case kSegmentTaken:
      if (phase_ == Phase::Write && last_) return done(Says::Written);
      return goes_on();
    case kBlockTaken:
      if ((command & 3U) == kAcknowledged) return acknowledge(bytes[1]);
      if ((command & 3U) == kEnd) return phase_ == Phase::BlockWrite ? done(Says::Written) : SdoRemark();
      streams_ = phase_ == Phase::BlockWrite;
      return goes_on();
    case kBlockTold:
      if ((command & kEnd) == 0) return goes_on();
      if (phase_ != Phase::BlockRead) return {};
      drop_unused(command >> 2 & 7U);
      return done(Says::Read);
    default:
      return {};
  }
}

SdoRemark SdoDialogue::begin(Says kind, Phase phase, const SdoBytes& bytes) {
  *this = SdoDialogue();
  phase_ = phase;
  object_ = {word_at(&bytes[1]), bytes[3]};
  return {kind, object_, {}, 0};
}

SdoRemark SdoDialogue::aborted(const SdoBytes& bytes) {
  *this = SdoDialogue();
  return {Says::Aborted, ObjectAddress{word_at(&bytes[1]), bytes[3]}, {}, long_at(&bytes[4])};
}

SdoRemark SdoDialogue::goes_on() const {
  if (phase_ == Phase::Idle) return {};
  return {Says::Goes, object_, {}, 0};
}

SdoRemark SdoDialogue::done(Says kind) {
  SdoRemark remark{kind, object_, std::move(data_), 0};
  *this = SdoDialogue();
  return remark;
}

SdoRemark SdoDialogue::take_segment(const SdoBytes& bytes, Phase phase) {
  if (phase_ != phase) return {};
  const std::uint8_t command = bytes[0];
  if ((command & kToggleBit) == toggle_) {  // otherwise it is the last one again
    store(&bytes[1], kSegment - (command >> 1 & 7U));
    toggle_ ^= kToggleBit;
    last_ = (command & 0x01) != 0;
  }
  return goes_on();
}

SdoRemark SdoDialogue::take_block_segment(const SdoBytes& bytes) {
  const std::size_t sequence = bytes[0] & kSequenceBits;
  if (sequence == block_.size() / kSegment + 1) {
    block_.insert(block_.end(), bytes.begin() + 1, bytes.end());
    last_ = (bytes[0] & kLastSegment) != 0;
  }
  return goes_on();
}

SdoRemark SdoDialogue::acknowledge(std::size_t segments) {
  const std::size_t count = std::min(segments * kSegment, block_.size());
  const bool all = count == block_.size();
  store(block_.data(), count);
  block_.clear();
  last_ = last_ && all;
  streams_ = !last_;
  return goes_on();
}

void SdoDialogue::drop_unused(std::size_t bytes) {
  data_.resize(data_.size() - std::min(bytes, data_.size()));
}

void SdoDialogue::store(const std::uint8_t* bytes, std::size_t count) {
  data_.insert(data_.end(), bytes, bytes + std::min(count, kMostBytes - data_.size()));
}

}  // namespace rmac::fieldbus::canopen
