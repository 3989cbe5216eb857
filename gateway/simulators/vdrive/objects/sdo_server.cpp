#include "gateway/simulators/vdrive/objects/sdo_server.hpp"

#include <algorithm>

namespace rmac::vdrive {
namespace {

// More than any object of this device holds; who sends more is refused before it fills the memory.
constexpr std::size_t kMostBytes = 65536;
constexpr std::uint32_t kOutOfMemory = 0x05040005;
constexpr std::uint32_t kBadBlockSize = 0x05040002;
constexpr std::uint32_t kBadSequence = 0x05040003;

bool sound_block_size(int size) {
  return size >= 1 && size <= 127;
}

std::uint32_t number(const std::uint8_t* at, int bytes) {
  std::uint32_t value = 0;
  for (int i = bytes - 1; i >= 0; --i) value = value << 8 | at[i];
  return value;
}

Bytes four(std::uint32_t value) {
  return {static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8),
          static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 24)};
}

/// Bit by bit, as the standard defines it.
std::uint32_t crc_of(const Bytes& data) {
  std::uint32_t crc = 0;
  for (const std::uint8_t byte : data) {
    for (int bit = 7; bit >= 0; --bit) {
      const bool top = ((crc >> 15 ^ byte >> bit) & 1U) != 0;
      crc = (crc << 1 & 0xFFFF) ^ (top ? 0x1021U : 0U);
    }
  }
  return crc;
}

}  // namespace

CanFrame SdoServer::answer(std::uint8_t command) const {
  CanFrame frame;
  frame.id = static_cast<std::uint16_t>(0x580 + node_);
  frame.size = 8;
  frame.data[0] = command;
  return frame;
}

std::vector<CanFrame> SdoServer::with_object(std::uint8_t command, Bytes rest) const {
  CanFrame frame = answer(command);
  frame.data[1] = static_cast<std::uint8_t>(object_.index & 0xFF);
  frame.data[2] = static_cast<std::uint8_t>(object_.index >> 8);
  frame.data[3] = object_.sub;
  std::copy(rest.begin(), rest.end(), frame.data.begin() + 4);
  return {frame};
}

std::vector<CanFrame> SdoServer::abort(std::uint32_t code) {
  mode_ = Mode::None;
  return with_object(0x80, four(code));
}

std::vector<CanFrame> SdoServer::receive(const CanFrame& frame) {
  if (frame.size != 8) return {};  // 7.2.4.3: always eight bytes
  const std::uint8_t command = frame.data[0];
  if (mode_ == Mode::BlockDownload && command != 0x80) return block_download_segment(frame);
  if (command == 0x80) {
    mode_ = Mode::None;
    return {};
  }
  const ObjectAddress object{static_cast<std::uint16_t>(number(&frame.data[1], 2)), frame.data[3]};
  switch (command >> 5) {
    case 1:
      object_ = object;
      return initiate_download(frame);
    case 0:
      return download_segment(frame);
    case 2:
      object_ = object;
      return initiate_upload(frame, false);
    case 3:
      return upload_segment(frame);
    case 6:
      if (mode_ == Mode::BlockDownloadEnd && (command & 3) == 1) return block_download_end(frame);
      object_ = object;
      return knows_blocks && (command & 1) == 0 ? initiate_block_download(frame) : abort(0x05040001);
    case 5:
      if ((command & 3) != 0) return block_upload(frame);
      object_ = object;
      return knows_blocks ? initiate_upload(frame, true) : abort(0x05040001);
    default:
      return abort(0x05040001);
  }
}

std::uint32_t SdoServer::commit() {
  mode_ = Mode::None;
  if (announced_ && *announced_ != data_.size()) return 0x06070010;
  return objects_.write(object_, data_);
}

std::vector<CanFrame> SdoServer::initiate_download(const CanFrame& frame) {
  const std::uint8_t command = frame.data[0];
  data_.clear();
  toggle_ = false;
  announced_.reset();
  if ((command & 2) != 0) {
    const int size = (command & 1) != 0 ? 4 - (command >> 2 & 3) : 4;
    data_.assign(frame.data.begin() + 4, frame.data.begin() + 4 + size);
    const std::uint32_t code = commit();
    return code == 0 ? with_object(0x60) : abort(code);
  }
  if ((command & 1) != 0) announced_ = number(&frame.data[4], 4);
  mode_ = Mode::Download;
  return with_object(0x60);
}

std::vector<CanFrame> SdoServer::download_segment(const CanFrame& frame) {
  const std::uint8_t command = frame.data[0];
  if (mode_ != Mode::Download) return abort(0x05040001);
  if (((command >> 4 & 1) != 0) != toggle_) return abort(0x05030000);
  const int size = 7 - (command >> 1 & 7);
  if (data_.size() >= kMostBytes) return abort(kOutOfMemory);
  data_.insert(data_.end(), frame.data.begin() + 1, frame.data.begin() + 1 + size);
  const auto response = static_cast<std::uint8_t>(0x20 | (toggle_ ? 0x10 : 0));
  toggle_ = !toggle_;
  if ((command & 1) != 0) {
    if (const std::uint32_t code = commit(); code != 0) return abort(code);
  }
  return {answer(response)};
}

std::vector<CanFrame> SdoServer::initiate_upload(const CanFrame& frame, bool block) {
  data_.clear();
  if (const std::uint32_t code = objects_.read(object_, data_); code != 0) return abort(code);
  position_ = 0;
  toggle_ = false;
  if (block && data_.size() > frame.data[5]) {
    client_block_ = frame.data[4];
    if (!sound_block_size(client_block_)) return abort(kBadBlockSize);
    crc_ = knows_crc && (frame.data[0] & 4) != 0;
    mode_ = Mode::BlockUpload;
    sent_ = 0;
    return with_object(static_cast<std::uint8_t>(0xC0 | (crc_ ? 4 : 0) | (tells_size ? 2 : 0)),
                       tells_size ? four(static_cast<std::uint32_t>(data_.size())) : Bytes());
  }
  if (!data_.empty() && data_.size() <= 4) {
    mode_ = Mode::None;
    return with_object(static_cast<std::uint8_t>(0x43 | (4 - data_.size()) << 2), data_);
  }
  mode_ = Mode::Upload;
  return with_object(tells_size ? 0x41 : 0x40, tells_size ? four(static_cast<std::uint32_t>(data_.size())) : Bytes());
}

std::vector<CanFrame> SdoServer::upload_segment(const CanFrame& frame) {
  if (mode_ != Mode::Upload) return abort(0x05040001);
  if (((frame.data[0] >> 4 & 1) != 0) != toggle_) return abort(0x05030000);
  const std::size_t size = std::min<std::size_t>(7, data_.size() - position_);
  const bool last = position_ + size == data_.size();
  CanFrame reply = answer(static_cast<std::uint8_t>((toggle_ ? 0x10 : 0) | (7 - size) << 1 | (last ? 1 : 0)));
  std::copy_n(data_.begin() + static_cast<std::ptrdiff_t>(position_), size, reply.data.begin() + 1);
  position_ += size;
  toggle_ = !toggle_;
  if (last) mode_ = Mode::None;
  return {reply};
}

std::vector<CanFrame> SdoServer::initiate_block_download(const CanFrame& frame) {
  data_.clear();
  announced_.reset();
  if ((frame.data[0] & 2) != 0) announced_ = number(&frame.data[4], 4);
  crc_ = knows_crc && (frame.data[0] & 4) != 0;
  mode_ = Mode::BlockDownload;
  expected_ = 1;
  return with_object(static_cast<std::uint8_t>(0xA0 | (knows_crc ? 4 : 0)), {block_size});
}

std::vector<CanFrame> SdoServer::block_download_segment(const CanFrame& frame) {
  const int sequence = frame.data[0] & 0x7F;
  const bool last = (frame.data[0] & 0x80) != 0;
  bool complete = false;
  if (sequence == 0 || sequence > block_size) return abort(kBadSequence);
  if (data_.size() >= kMostBytes) return abort(kOutOfMemory);
  if (sequence == expected_) {
    data_.insert(data_.end(), frame.data.begin() + 1, frame.data.end());
    ++expected_;
    complete = last;
  }
  if (!last && sequence != block_size) return {};
  CanFrame reply = answer(0xA2);
  reply.data[1] = static_cast<std::uint8_t>(expected_ - 1);
  reply.data[2] = block_size;
  expected_ = 1;
  if (complete) mode_ = Mode::BlockDownloadEnd;
  return {reply};
}

std::vector<CanFrame> SdoServer::block_download_end(const CanFrame& frame) {
  const std::size_t unused = frame.data[0] >> 2 & 7U;
  if (unused > data_.size()) return abort(0x08000000);
  data_.erase(data_.end() - static_cast<std::ptrdiff_t>(unused), data_.end());
  if (crc_ && crc_of(data_) != number(&frame.data[1], 2)) return abort(0x05040004);
  const std::uint32_t code = commit();
  if (code != 0) return abort(code);
  return {answer(0xA1)};
}

std::vector<CanFrame> SdoServer::block_upload(const CanFrame& frame) {
  switch (frame.data[0] & 3) {
    case 3:
      return mode_ == Mode::BlockUpload ? send_block() : abort(0x05040001);
    case 2: {
      if (mode_ != Mode::BlockUpload || frame.data[1] > sent_) return abort(kBadSequence);
      if (!sound_block_size(frame.data[2])) return abort(kBadBlockSize);
      position_ = std::min(position_ + std::size_t{frame.data[1]} * 7, data_.size());
      client_block_ = frame.data[2];
      const bool all = frame.data[1] == sent_ && position_ == data_.size();
      if (!all) return send_block();
      const std::size_t in_last = data_.empty() ? 0 : (data_.size() - 1) % 7 + 1;
      CanFrame reply = answer(static_cast<std::uint8_t>(0xC1 | (7 - in_last) << 2));
      const std::uint32_t crc = crc_ ? crc_of(data_) : 0;
      reply.data[1] = static_cast<std::uint8_t>(crc);
      reply.data[2] = static_cast<std::uint8_t>(crc >> 8);
      mode_ = Mode::BlockUploadEnd;
      return {reply};
    }
    default:
      mode_ = Mode::None;
      return {};
  }
}

std::vector<CanFrame> SdoServer::send_block() {
  std::vector<CanFrame> frames;
  std::size_t at = position_;
  sent_ = 0;
  bool last = false;
  while (!last && sent_ < client_block_) {
    const std::size_t size = std::min<std::size_t>(7, data_.size() - at);
    last = at + size == data_.size();
    ++sent_;
    CanFrame segment = answer(static_cast<std::uint8_t>(sent_ | (last ? 0x80 : 0)));
    std::copy_n(data_.begin() + static_cast<std::ptrdiff_t>(at), size, segment.data.begin() + 1);
    at += size;
    frames.push_back(segment);
  }
  return frames;
}

}  // namespace rmac::vdrive
