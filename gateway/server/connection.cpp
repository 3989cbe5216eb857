#include "gateway/server/connection.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "gateway/api/state_json.hpp"
#include "gateway/json/printable.hpp"

namespace rmac::gateway {

namespace {

constexpr std::size_t kDiscardLimitBytes = std::size_t{256} << 20;
constexpr std::chrono::seconds kLeaveTime{5};
constexpr std::chrono::seconds kDrainTime{30};
constexpr std::chrono::seconds kDismissTime{2};

/// What is read of a text takes several times its memory.
constexpr std::size_t kTreePerText = 8;

/// The topic `state` as everybody sees it.
std::string state_text(const ConnectionContext& context, const CycleSample& sample) {
  Dispatcher& api = context.dispatcher;
  const OperatorRef on_duty = context.operator_post.now();
  const int left = api.machine().cam().queue().moves_left();
  return text_of(state_to_json(api.machine(), left, sample, api.status(),
                               {context.lease.holder_name(), on_duty ? on_duty->name() : ""}));
}

/// The machine as everybody sees it move.
Scene scene_of(const ConnectionContext& context) {
  MachinePort& machine = context.dispatcher.machine();
  const sdk::FrameSettings& frames = machine.cam().frames();
  return {.drawing = machine.shape().drawing(),
          .virtual_mode = machine.device().virtual_mode(),
          .tool = machine.tools().tools_now().mounted,
          .frames = {frames.part(), frames.tool_interface()}};
}

/// Longer first lines are held to their first character alone: reading them takes long.
constexpr std::size_t kLongFirstLine = 65536;

/// Whether a client may begin so. What a web page has a browser send (HTTP) begins with lines that are no JSON, and may
/// have requests in its body.
bool is_json(std::string_view line) {
  const auto begin = line.find_first_not_of(" \t");
  if (begin == std::string_view::npos || (line[begin] != '{' && line[begin] != '[')) return false;
  return line.size() > kLongFirstLine || nlohmann::json::accept(line);
}

}  // namespace

Connection::Connection(const ConnectionContext& context, Socket socket, Visitor visitor)
    : context_(context),
      socket_(std::move(socket)),
      topics_(
          context.options.cycle_hz, [&context](const CycleSample& sample) { return state_text(context, sample); },
          [&context] { return scene_of(context); }),
      session_(context, visitor.id, std::move(visitor.where), topics_),
      requests_(*this, context.dispatcher, context.aside, context.options.queue_wait),
      lines_(context.options.line_limit_bytes),
      outbox_(std::chrono::steady_clock::now()),
      peer_(std::move(visitor.peer)),
      came_(std::chrono::steady_clock::now()),
      leaving_(socket_.get_executor()) {}

Guest Connection::guest() const {
  return {.id = id(),
          .peer = peer_,
          .spoke = spoke_,
          .only_stops = only_stops_,
          .fast = topics_.is_fast(),
          .held_bytes = lines_.held_bytes() + kTreePerText * requests_.bytes() + outbox_.bytes(),
          .unread_bytes = outbox_.bytes(),
          .came = came_};
}

void Connection::start(std::optional<std::string> only_stops) {
  only_stops_ = only_stops.has_value();
  if (only_stops) requests_.take_only_stops(*only_stops);
  asio::error_code ignored;  // a UNIX socket has no such option
  socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
  read();
}

void Connection::abort() {
  if (phase_ == Phase::Closed) return;
  phase_ = Phase::Closed;
  const auto self = shared_from_this();
  asio::error_code ignored;
  socket_.close(ignored);
  leaving_.cancel();
  requests_.clear();
  session_.leave_posts("disconnected with");
  context_.peers.forget(id());
}

std::uint64_t Connection::arrived_bytes() const {
  asio::error_code problem;
  const std::size_t unread = socket_.available(problem);
  return read_bytes_ + (problem ? 0 : unread);
}

void Connection::read() {
  // Reading pauses while too much waits; TCP then holds the client back.
  if (reading_ || phase_ != Phase::Open || requests_.bytes() > context_.options.pending_limit_bytes) return;
  reading_ = true;
  socket_.async_read_some(
      asio::buffer(buffer_),
      [self = shared_from_this()](asio::error_code problem, std::size_t bytes) { self->arrived(problem, bytes); });
}

void Connection::arrived(asio::error_code problem, std::size_t bytes) try {
  reading_ = false;
  read_bytes_ += bytes;
  if (phase_ == Phase::Leaving && !problem) discard_input();
  if (phase_ != Phase::Open) return;
  if (problem == asio::error::eof) {
    end_of_input();
  } else if (problem) {
    abort();
  } else {
    take_input(bytes);
    pump();
    read();
  }
} catch (const std::bad_alloc&) {
  spdlog::error("{} is disconnected: there is no memory for what it sends", name());
  abort();
}

void Connection::take_input(std::size_t bytes) {
  lines_.take({buffer_.data(), bytes});
  while (phase_ == Phase::Open) {
    const auto line = lines_.next();
    if (!line) break;
    take_line(*line);
  }
  if (!lines_.too_long() || phase_ != Phase::Open) return;
  refuse_and_leave({rpc_code::kRequestTooLarge,
                    fmt::format("a line is longer than {} bytes; send smaller requests, e.g. one move a line",
                                context_.options.line_limit_bytes),
                    MinorCode::InvalidParameterValue});
}

void Connection::take_line(const LineReader::Line& line) {
  if (!spoke_ && !is_json(line.text)) {
    refuse_and_leave({rpc_code::kParseError,
                      "the first line is not JSON: this is no client of the appliance; it is sent one JSON-RPC request "
                      "a line",
                      MinorCode::InvalidParameter});
    return;
  }
  spoke_ = true;
  context_.lease.heard(id());
  requests_.take(line.text, line.position);
}

void Connection::end_of_input() {
  if (const auto line = lines_.last()) take_line(*line);  // a last line without its newline counts
  phase_ = Phase::Draining;
  topics_.stop({});
  leave_within(kDrainTime);
  pump();
}

void Connection::refuse_and_leave(RpcError error) {
  if (phase_ != Phase::Open) {
    abort();
    return;
  }
  spdlog::warn("{} is disconnected: {}", name(), error.message);
  requests_.clear();
  lines_.clear();
  send(text_of(to_response(nullptr, tl::unexpected<RpcError>(std::move(error)))));
  phase_ = Phase::Leaving;
  session_.leave_posts("was disconnected with");
  // Closing with input unread would reset the connection, and the client would never see why. So what it still sends is
  // thrown away for a while.
  leave_within(kLeaveTime);
  discard_input();
}

void Connection::dismiss() {
  if (phase_ == Phase::Closed) return;
  topics_.owe_state();  // how everything ended
  flush_topics();
  requests_.clear();
  lines_.clear();
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

void Connection::pump() {
  const bool waits = !requests_.empty();
  const RequestQueue::Progress progress = requests_.carry_out();
  // However long an answer took, the client could not say anything meanwhile.
  if (waits) context_.lease.heard(id());
  switch (progress) {
    case RequestQueue::Progress::Waits:
      return;
    case RequestQueue::Progress::TurnOver:
      if (std::exchange(pump_posted_, true)) return;
      asio::post(socket_.get_executor(), [self = shared_from_this()] {
        self->pump_posted_ = false;
        if (self->phase_ == Phase::Closed) return;
        self->context_.peers.bound_memory();  // a round of all clients' long answers is longer than a tick
        self->pump();
      });
      return;
    case RequestQueue::Progress::Done:
      break;
  }
  if (phase_ == Phase::Draining) session_.leave_posts("disconnected with");
  finish_if_drained();
  read();
}

void Connection::has_stopped(const Request& stop, std::uint64_t position) {
  context_.peers.overtake(id(), name(), stop, position);
}

void Connection::push_sample(const CycleSample& sample) {
  if (auto line = topics_.take(sample)) send(std::move(*line));
  if (topics_.is_full()) flush_topics();
}

void Connection::push_event(const std::string& line) {
  if (!topics_.has_events()) return;
  // What happened after a sample is told after it.
  flush_topics();
  send(line);
}

void Connection::flush_topics() {
  for (std::string& line : topics_.batches()) send(std::move(line));
  if (topics_.owes_state() && !context_.aside.mechanism_changes()) {
    send(topics_.state_line(context_.dispatcher.machine().sample()));
  }
}

void Connection::send(std::string line) {
  if (phase_ == Phase::Closed) return;
  outbox_.add(std::move(line), std::chrono::steady_clock::now());
  if (outbox_.bytes() > context_.options.output_limit_bytes) {
    // Not from inside a loop over the connections, which closing changes.
    asio::post(socket_.get_executor(), [self = shared_from_this()] {
      if (self->phase_ == Phase::Closed) return;
      spdlog::warn("{} was cut off: it does not read what it asked for, {} bytes wait", self->name(),
                   self->outbox_.bytes());
      self->abort();
    });
    return;
  }
  write();
}

void Connection::write() {
  if (phase_ == Phase::Closed) return;
  const auto buffers = outbox_.begin_write();
  if (buffers.empty()) return;
  asio::async_write(socket_, buffers, [self = shared_from_this()](asio::error_code problem, std::size_t) {
    if (self->phase_ == Phase::Closed) return;
    if (problem) {
      self->abort();
      return;
    }
    self->outbox_.written(std::chrono::steady_clock::now());
    self->write();
    self->finish_if_drained();
  });
}

void Connection::finish_if_drained() {
  if (!outbox_.empty() || !requests_.empty()) return;
  if (phase_ == Phase::Draining) {
    abort();
  } else if (phase_ == Phase::Leaving) {
    asio::error_code ignored;
    socket_.shutdown(Socket::shutdown_send, ignored);
  }
}

bool Connection::behind() const noexcept {
  return outbox_.bytes() > context_.options.high_water_bytes;
}

bool Connection::stalled(std::chrono::steady_clock::time_point now) const noexcept {
  return behind() && outbox_.standstill(now) > context_.options.stall_limit;
}

}  // namespace rmac::gateway
