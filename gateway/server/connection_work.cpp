// From lines to answers: order, stops that overtake, moves that wait for room.
#include <fmt/format.h>

#include "gateway/json/printable.hpp"
#include "gateway/server/connection.hpp"
#include "gateway/server/server.hpp"

namespace rmac::gateway {

namespace {

constexpr std::size_t kLargestBatch = 10'000;
/// A batch is answered in one piece, which memory must hold.
constexpr std::size_t kMostAnswerBytes = 8U << 20U;
/// Of one line or of several, before other connections get their turn: their stops must not wait for a long batch.
constexpr std::chrono::milliseconds kTurn{5};
/// Longer lines are read beside the gateway thread.
constexpr std::size_t kLongLine = 64U << 10U;
/// Of a request's parameters: with more, decoding and building take milliseconds.
constexpr std::size_t kManyValues = 2000;

Answer refused(MinorCode minor, std::string message) {
  return tl::unexpected<RpcError>(to_rpc_error(Error{minor, std::move(message)}));
}

/// A line that holds no request still gets its answer in its turn.
Request not_a_request(RpcError error) {
  Request request;
  request.error = std::move(error);
  return request;
}

/// Whether the machine was asked to stop: a call with wrong parameters, or a release by who holds nothing, was no stop.
bool took_effect(const Answer& answer) {
  return answer || (answer.error().code < rpc_code::kMachineBase && answer.error().code > rpc_code::kAuthorityRequired);
}

/// Numbers, texts and so on in a tree.
std::size_t values_in(const nlohmann::json& tree) {
  if (!tree.is_structured()) return 1;
  std::size_t values = 0;
  for (const auto& element : tree) values += values_in(element);
  return values;
}

/// Whether others' stops must not wait for it.
bool is_slow(const Request& request) {
  return request.method != nullptr && (request.method->slow || (request.large && request.queues_a_move()));
}

}  // namespace

void Connection::take_line(std::string_view line) {
  const std::uint64_t position = line_position_;
  line_position_ += line.size() + 1;
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line.find_first_not_of(" \t") == std::string_view::npos) return;
  server_.heard(*this);
  auto work = std::make_shared<Work>();
  work->position = position;
  work->bytes = line.size();
  work->received = std::chrono::steady_clock::now();
  if (line.size() > kLongLine) {
    work->away = true;
    server_.run_aside([work, text = std::string(line)] { read_requests(text, *work); },
                      [self = shared_from_this(), work] {
                        work->away = false;
                        self->stop_first(*work);  // even of a client that is gone: it was sent
                        self->pump();
                      });
  } else {
    read_requests(line, *work);
    stop_first(*work);
    if (!work->batch && work->answers[0]) {
      answer(*work);
      return;
    }
  }
  pending_bytes_ += work->bytes;
  pending_.push_back(std::move(work));
}

void Connection::read_requests(std::string_view line, Work& work) {
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
  if (line.size() > kLongLine) {
    for (Request& request : work.requests) request.large = values_in(request.params) > kManyValues;
  }
  work.answers.resize(work.requests.size());
}

void Connection::stop_first(Work& work) {
  for (std::size_t i = 0; i < work.requests.size(); ++i) {
    const Request& stop = work.requests[i];
    if (!stop.is_urgent()) continue;
    work.answers[i] = server_.dispatcher().execute(stop, *this);
    if (took_effect(*work.answers[i])) server_.overtake(*this, stop, work.position + i);
  }
}

void Connection::pump() {
  const auto self = shared_from_this();
  const auto turn_end = std::chrono::steady_clock::now() + kTurn;
  while (!pending_.empty() && phase_ != Phase::Closed) {
    const std::shared_ptr<Work> work = pending_.front();
    // Not done: its turn ended, it waits for room in the queue, or it is away. The next tick goes on at the latest.
    if (!run(work)) return;
    answer(*work);
    pending_bytes_ -= work->bytes;
    pending_.pop_front();
    if (!pending_.empty() && std::chrono::steady_clock::now() >= turn_end) {
      if (!pump_posted_) {
        pump_posted_ = true;
        asio::post(socket_.get_executor(), [self] {
          self->pump_posted_ = false;
          self->pump();
        });
      }
      return;
    }
  }
  if (phase_ == Phase::Draining && pending_.empty()) server_.lose_lease(*this, "disconnected with");
  finish_if_drained();
  read();
}

bool Connection::run(const std::shared_ptr<Work>& waiting) {
  Work& work = *waiting;
  if (work.away) return false;
  const auto turn_end = std::chrono::steady_clock::now() + kTurn;
  for (const std::size_t first = work.next; work.next < work.requests.size();) {
    if (work.next != first && std::chrono::steady_clock::now() >= turn_end) return false;
    if (work.answers[work.next]) {
      ++work.next;
      continue;
    }
    const Request& request = work.requests[work.next];
    auto refusal = refusal_of(work, request);
    if (!refusal) {
      if (server_.machine_is_away()) return false;
      refusal = Dispatcher::refusal_of(request, *this);
    }
    if (!refusal && is_slow(request)) {
      carry_out_aside(waiting);
      return false;
    }
    if (!settle(work, refusal ? std::move(*refusal) : server_.dispatcher().execute(request, *this))) return false;
  }
  return true;
}

void Connection::carry_out_aside(const std::shared_ptr<Work>& work) {
  const Request& request = work->requests[work->next];
  work->away = true;
  if (request.method->preparation && !work->prepared) {
    // Its turn comes again after it: a stop may have overtaken it by then, or the lease be gone.
    server_.prepare_aside(request, *this, [self = shared_from_this(), work](std::optional<Answer> failed) {
      work->away = false;
      work->prepared = !failed;
      return !failed || self->settle(*work, std::move(*failed));
    });
    return;
  }
  work->prepared = false;
  server_.carry_out_aside(request, *this, [self = shared_from_this(), work](Answer answer) {
    work->away = false;
    return self->settle(*work, std::move(answer));
  });
}

bool Connection::settle(Work& work, Answer answer) {
  const Request& request = work.requests[work.next];
  if (work.batch && answer && answer->is_structured()) work.answer_bytes += text_of(*answer).size();
  const bool full = !answer && answer.error().minor == MinorCode::CommandQueueFull && request.queues_a_move();
  if (full && !work.refuse_moves) {
    if (must_wait(work)) return false;
    server_.dispatcher().status().fail(MinorCode::CommandQueueFull);
    refuse_pending_moves();
  }
  work.answers[work.next++] = std::move(answer);
  work.prepared = false;
  return true;
}

std::optional<Answer> Connection::refusal_of(const Work& work, const Request& request) const {
  const std::uint64_t position = work.position + work.next;
  const Effect effect = request.effect();
  if ((effect == Effect::Starts && position < no_starts_before_) ||
      (effect == Effect::Queues && position < no_moves_before_)) {
    return refused(MinorCode::Other,
                   fmt::format("{} was overtaken by a stop: {} came before it was carried out; send it again if it "
                               "still holds",
                               request.method->name, last_stop_));
  }
  if (work.refuse_moves && effect == Effect::Queues) {
    return refused(MinorCode::CommandQueueFull,
                   "refused because a move sent before it found the queue full; send both again when there is room");
  }
  if (work.answer_bytes > kMostAnswerBytes) {
    return refused(MinorCode::Other, "not carried out: the answers of this batch exceed 8 MiB; send smaller batches");
  }
  return std::nullopt;
}

void Connection::stopped(Effect effect, const std::string& what, std::uint64_t position) {
  if (effect != Effect::Holds && effect != Effect::Stops) return;
  last_stop_ = what;
  no_starts_before_ = std::max(no_starts_before_, position);
  if (effect == Effect::Stops) no_moves_before_ = std::max(no_moves_before_, position);
}

bool Connection::must_wait(const Work& work) const {
  // A queue that does not run will not get room by waiting, and a client that has left does not wait.
  const CycleState state = server_.dispatcher().machine().sample().state;
  const bool runs = state == CycleState::Running || state == CycleState::Holding;
  return runs && phase_ == Phase::Open &&
         std::chrono::steady_clock::now() - work.received < server_.options().queue_wait;
}

void Connection::refuse_pending_moves() {
  for (const auto& work : pending_) work->refuse_moves = true;
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
