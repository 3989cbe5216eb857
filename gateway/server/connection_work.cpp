// From lines to answers: order, stops that overtake, moves that wait for room.
#include <fmt/format.h>

#include "gateway/server/connection.hpp"
#include "gateway/server/server.hpp"

namespace rmac::gateway {

namespace {

constexpr std::size_t kLargestBatch = 10'000;
/// Requests carried out before other connections get their turn.
constexpr std::size_t kTurn = 64;

Answer refused(int code, std::string message, MinorCode minor) {
  return tl::unexpected<RpcError>(RpcError{code, std::move(message), minor});
}

/// A line that holds no request still gets its answer in its turn.
Request not_a_request(RpcError error) {
  Request request;
  request.error = std::move(error);
  return request;
}

std::string text_of(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

void Connection::take_line(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line.find_first_not_of(" \t") == std::string_view::npos) return;
  Work work;
  work.bytes = line.size();
  work.received = std::chrono::steady_clock::now();
  auto parsed = parse_line(line);
  if (!parsed) {
    work.requests.push_back(not_a_request(std::move(parsed.error())));
  } else if (parsed->is_array() && (parsed->empty() || parsed->size() > kLargestBatch)) {
    work.requests.push_back(
        not_a_request({rpc_code::kInvalidRequest,
                       fmt::format("a batch of {} requests; 1 to {} are taken", parsed->size(), kLargestBatch),
                       MinorCode::InvalidParameter}));
  } else if (parsed->is_array()) {
    work.batch = true;
    for (auto& message : *parsed) work.requests.push_back(read_request(std::move(message)));
  } else {
    work.requests.push_back(read_request(std::move(*parsed)));
  }
  work.answers.resize(work.requests.size());
  // Stops do not queue: they act before everything that waits here, in a batch too.
  for (std::size_t i = 0; i < work.requests.size(); ++i) {
    if (work.requests[i].stops()) work.answers[i] = server_.dispatcher().execute(work.requests[i], *this);
  }
  if (!work.batch && work.answers[0]) {
    answer(work);
    return;
  }
  pending_bytes_ += work.bytes;
  pending_.push_back(std::move(work));
}

void Connection::pump() {
  const auto self = shared_from_this();
  for (std::size_t done = 0; !pending_.empty() && phase_ != Phase::Closed; ++done) {
    if (done == kTurn) {
      if (!pump_posted_) {
        pump_posted_ = true;
        asio::post(socket_.get_executor(), [self] {
          self->pump_posted_ = false;
          self->pump();
        });
      }
      return;
    }
    Work& work = pending_.front();
    if (!run(work)) return;  // waits for room in the queue; the next tick tries again
    answer(work);
    pending_bytes_ -= work.bytes;
    pending_.pop_front();
  }
  if (phase_ == Phase::Draining && pending_.empty()) server_.lose_lease(*this, "disconnected with");
  finish_if_drained();
  read();
}

bool Connection::run(Work& work) {
  for (; work.next < work.requests.size(); ++work.next) {
    if (work.answers[work.next]) continue;
    const Request& request = work.requests[work.next];
    if (work.refuse_moves && request.queues_a_move()) {
      work.answers[work.next] =
          refused(rpc_code::kMachineBase - static_cast<int>(MinorCode::CommandQueueFull),
                  "refused because a move sent before it found the queue full; send both again when there is room",
                  MinorCode::CommandQueueFull);
      continue;
    }
    Answer result = server_.dispatcher().execute(request, *this);
    if (!result && result.error().minor == MinorCode::CommandQueueFull && request.queues_a_move()) {
      if (must_wait(work)) return false;
      server_.dispatcher().status().fail(MinorCode::CommandQueueFull);
      refuse_pending_moves();
    }
    work.answers[work.next] = std::move(result);
  }
  return true;
}

bool Connection::must_wait(const Work& work) const {
  // A queue that does not run will not get room by waiting, and a client that has left does not wait.
  const CycleState state = server_.dispatcher().machine().sample().state;
  const bool runs = state == CycleState::Running || state == CycleState::Holding;
  return runs && phase_ == Phase::Open &&
         std::chrono::steady_clock::now() - work.received < server_.options().queue_wait;
}

void Connection::refuse_pending_moves() {
  for (Work& work : pending_) work.refuse_moves = true;
}

void Connection::answer(const Work& work) {
  if (!work.batch) {
    if (!work.requests[0].notification) send(text_of(to_response(work.requests[0].id, *work.answers[0])));
    return;
  }
  nlohmann::json responses = nlohmann::json::array();
  for (std::size_t i = 0; i < work.requests.size(); ++i) {
    if (!work.requests[i].notification) responses.push_back(to_response(work.requests[i].id, *work.answers[i]));
  }
  if (!responses.empty()) send(text_of(responses));
}

}  // namespace rmac::gateway
