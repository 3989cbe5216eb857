// Reading and writing. What is done with requests stands in connection_work.cpp, what a method asks of its connection
// in connection_session.cpp.
#include "gateway/server/connection.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "gateway/json/printable.hpp"
#include "gateway/server/server.hpp"

namespace rmac::gateway {

namespace {

constexpr std::size_t kDiscardLimitBytes = std::size_t{256} << 20;
constexpr std::chrono::seconds kLeaveTime{5};
constexpr std::chrono::seconds kDrainTime{30};
constexpr std::chrono::seconds kDismissTime{2};
constexpr std::size_t kBuffersPerWrite = 64;

}  // namespace

Connection::Connection(Server& server, Socket socket, std::uint64_t id, std::string where)
    : server_(server),
      socket_(std::move(socket)),
      id_(id),
      where_(std::move(where)),
      records_(server.make_records()),
      leaving_(socket_.get_executor()),
      last_progress_(std::chrono::steady_clock::now()) {}

void Connection::start() {
  asio::error_code ignored;  // a UNIX socket has no such option
  socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
  read();
}

std::string Connection::name() const {
  return client_.empty() ? where_ : fmt::format("{} ({})", client_, where_);
}

void Connection::abort() {
  if (phase_ == Phase::Closed) return;
  phase_ = Phase::Closed;
  const auto self = shared_from_this();
  asio::error_code ignored;
  socket_.close(ignored);
  leaving_.cancel();
  pending_.clear();
  server_.lose_lease(*this, "disconnected with");
  server_.forget(*this);
}

std::uint64_t Connection::arrived_bytes() const {
  asio::error_code problem;
  const std::size_t unread = socket_.available(problem);
  return read_bytes_ + (problem ? 0 : unread);
}

void Connection::read() {
  // Reading pauses while too much waits; TCP then holds the client back.
  if (reading_ || phase_ != Phase::Open || pending_bytes_ > server_.options().pending_limit_bytes) return;
  reading_ = true;
  socket_.async_read_some(asio::buffer(buffer_),
                          [self = shared_from_this()](asio::error_code problem, std::size_t bytes) {
                            self->reading_ = false;
                            self->read_bytes_ += bytes;
                            if (self->phase_ == Phase::Leaving && !problem) self->discard_input();
                            if (self->phase_ != Phase::Open) return;
                            if (problem == asio::error::eof) {
                              self->end_of_input();
                            } else if (problem) {
                              self->abort();
                            } else {
                              self->take_input(bytes);
                              self->pump();
                              self->read();
                            }
                          });
}

void Connection::take_input(std::size_t bytes) {
  std::string_view chunk(buffer_.data(), bytes);
  const std::size_t limit = server_.options().line_limit_bytes;
  while (phase_ == Phase::Open) {
    const std::size_t end = chunk.find('\n');
    const std::string_view part = chunk.substr(0, end);
    if (input_.size() + part.size() > limit) {
      refuse_and_leave(
          {rpc_code::kRequestTooLarge,
           fmt::format("a line is longer than {} bytes; send smaller requests, e.g. one move a line", limit),
           MinorCode::InvalidParameterValue});
      return;
    }
    if (end == std::string_view::npos) {
      input_.append(part);
      return;
    }
    if (input_.empty()) {
      take_line(part);
    } else {
      input_.append(part);
      const std::string line = std::move(input_);
      input_.clear();
      take_line(line);
    }
    chunk.remove_prefix(end + 1);
  }
}

void Connection::end_of_input() {
  if (!input_.empty()) {
    const std::string line = std::move(input_);  // a last line without its newline counts
    input_.clear();
    take_line(line);
  }
  phase_ = Phase::Draining;
  unsubscribe({});
  leave_within(kDrainTime);
  pump();
}

void Connection::refuse_and_leave(RpcError error) {
  spdlog::warn("{} is disconnected: {}", name(), error.message);
  pending_.clear();
  input_ = {};
  send(text_of(to_response(nullptr, tl::unexpected<RpcError>(std::move(error)))));
  phase_ = Phase::Leaving;
  server_.lose_lease(*this, "was disconnected with");
  // Closing with input unread would reset the connection, and the client would never see why. So what it still sends is
  // thrown away for a while.
  leave_within(kLeaveTime);
  discard_input();
}

void Connection::dismiss() {
  if (phase_ == Phase::Closed) return;
  state_now_ = state_now_ || state_.on();  // how everything ended
  flush_topics();
  pending_.clear();
  input_ = {};
  const bool reads = reading_ || phase_ == Phase::Leaving;
  phase_ = Phase::Leaving;
  leave_within(kDismissTime);
  if (!reads) discard_input();
  finish_if_drained();
}

void Connection::leave_within(std::chrono::seconds bound) {
  leaving_.expires_after(bound);
  leaving_.async_wait([self = shared_from_this()](asio::error_code problem) {
    if (!problem) self->abort();
  });
}

void Connection::discard_input() {
  socket_.async_read_some(asio::buffer(buffer_),
                          [self = shared_from_this()](asio::error_code problem, std::size_t bytes) {
                            self->discarded_ += bytes;
                            if (problem || self->discarded_ > kDiscardLimitBytes) {
                              self->abort();
                            } else if (self->phase_ == Phase::Leaving) {
                              self->discard_input();
                            }
                          });
}

void Connection::send(std::string line) {
  if (phase_ == Phase::Closed) return;
  line += '\n';
  output_bytes_ += line.size();
  if (output_.empty()) last_progress_ = std::chrono::steady_clock::now();
  output_.push_back(std::move(line));
  if (output_bytes_ > server_.options().output_limit_bytes) {
    // Not from inside a loop over the connections, which closing changes.
    asio::post(socket_.get_executor(), [self = shared_from_this()] {
      if (self->phase_ == Phase::Closed) return;
      spdlog::warn("{} was cut off: it does not read what it asked for, {} bytes wait", self->name(),
                   self->output_bytes_);
      self->abort();
    });
    return;
  }
  write();
}

void Connection::write() {
  if (writing_ != 0 || output_.empty() || phase_ == Phase::Closed) return;
  writing_ = std::min(output_.size(), kBuffersPerWrite);
  std::vector<asio::const_buffer> buffers;
  buffers.reserve(writing_);
  for (std::size_t i = 0; i < writing_; ++i) buffers.push_back(asio::buffer(output_[i]));
  asio::async_write(socket_, buffers, [self = shared_from_this()](asio::error_code problem, std::size_t bytes) {
    if (self->phase_ == Phase::Closed) return;
    if (problem) {
      self->abort();
      return;
    }
    self->last_progress_ = std::chrono::steady_clock::now();
    self->output_bytes_ -= bytes;
    self->output_.erase(self->output_.begin(), self->output_.begin() + static_cast<std::ptrdiff_t>(self->writing_));
    self->writing_ = 0;
    self->write();
    self->finish_if_drained();
  });
}

void Connection::finish_if_drained() {
  if (!output_.empty() || !pending_.empty()) return;
  if (phase_ == Phase::Draining) {
    abort();
  } else if (phase_ == Phase::Leaving) {
    asio::error_code ignored;
    socket_.shutdown(Socket::shutdown_send, ignored);
  }
}

bool Connection::behind() const noexcept {
  return output_bytes_ > server_.options().high_water_bytes;
}

bool Connection::stalled(std::chrono::steady_clock::time_point now) const noexcept {
  return behind() && now - last_progress_ > server_.options().stall_limit;
}

}  // namespace rmac::gateway
