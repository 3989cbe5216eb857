#include "gateway/server/outbox.hpp"

#include <algorithm>

namespace rmac::gateway {

namespace {

constexpr std::size_t kBuffersPerWrite = 64;

/// A text that grew while it was written has room for up to its own size again. Worth a copy where lines are long.
constexpr std::size_t kLongLine = 4096;

std::size_t memory_of(const std::string& line) {
  return sizeof(line) + line.capacity();
}

}  // namespace

void Outbox::add(std::string line, Time now) {
  line += '\n';
  if (line.size() > kLongLine) line.shrink_to_fit();
  bytes_ += memory_of(line);
  if (lines_.empty()) last_progress_ = now;
  lines_.push_back(std::move(line));
}

std::vector<asio::const_buffer> Outbox::begin_write() {
  if (writing_ != 0) return {};
  writing_ = std::min(lines_.size(), kBuffersPerWrite);
  std::vector<asio::const_buffer> buffers;
  buffers.reserve(writing_);
  for (std::size_t i = 0; i < writing_; ++i) buffers.push_back(asio::buffer(lines_[i]));
  return buffers;
}

void Outbox::written(Time now) {
  last_progress_ = now;
  for (; writing_ != 0; --writing_) {
    bytes_ -= memory_of(lines_.front());
    lines_.pop_front();
  }
}

}  // namespace rmac::gateway
