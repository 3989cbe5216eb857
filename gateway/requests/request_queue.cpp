#include "gateway/requests/request_queue.hpp"

#include <fmt/format.h>

namespace rmac::gateway {

namespace {

/// How long a connection's requests are carried out before others get their turn: their stops must not wait for a long
/// batch, nor for many lines.
constexpr std::chrono::milliseconds kTurn{5};

/// Whether the machine was asked to stop: a call with wrong parameters, or a release by who holds nothing, was no stop.
bool took_effect(const Answer& answer) {
  return answer || (answer.error().code < rpc_code::kMachineBase && answer.error().code > rpc_code::kAuthorityRequired);
}

/// Whether others' stops must not wait for it.
bool is_slow(const Request& request) {
  return request.method != nullptr && (request.method->slow || (request.large && request.queues_a_move()));
}

Answer behind_a_full_queue() {
  return refused(MinorCode::CommandQueueFull,
                 "refused because a move sent before it found the queue full; send both again when there is room");
}

Answer behind_a_refused_move(const RpcError& why) {
  constexpr std::size_t kMostOfIt = 300;
  return refused(MinorCode::Other, fmt::format("refused because a move sent before it was refused: {}",
                                               std::string_view(why.message).substr(0, kMostOfIt)));
}

}  // namespace

RequestQueue::RequestQueue(Requester& client, Dispatcher& dispatcher, MachineAside& aside,
                           std::chrono::milliseconds queue_wait)
    : client_(client), dispatcher_(dispatcher), aside_(aside), queue_wait_(queue_wait) {}

void RequestQueue::take(std::string_view text, std::uint64_t position) {
  auto line = std::make_shared<RequestLine>(position, text.size(), std::chrono::steady_clock::now());
  if (text.size() > RequestLine::kLongBytes) {
    line->set_stage(RequestLine::Stage::Away);
    aside_.run([line, copy = std::string(text)] { line->read(copy); },
               [this, held = client_.hold(), line] {
                 line->set_stage(RequestLine::Stage::Here);
                 stop_first(*line);  // even of a client that is gone: it was sent
                 client_.pump();
               });
  } else {
    line->read(text);
    stop_first(*line);
    if (line->is_answered_alone()) {
      answer(*line);
      return;
    }
  }
  bytes_ += line->bytes();
  lines_.push_back(std::move(line));
}

void RequestQueue::stop_first(RequestLine& line) {
  line.answer_stops([this](const Request& stop, std::uint64_t position) {
    Answer answer = dispatcher_.execute(stop, client_.session());
    if (took_effect(answer)) client_.has_stopped(stop, position);
    return answer;
  });
}

RequestQueue::Progress RequestQueue::carry_out() {
  const auto turn_end = std::chrono::steady_clock::now() + kTurn;
  while (!lines_.empty()) {
    const Line line = lines_.front();
    if (!carry_out(line)) return Progress::Waits;
    answer(*line);
    bytes_ -= line->bytes();
    lines_.pop_front();
    if (!lines_.empty() && std::chrono::steady_clock::now() >= turn_end) return Progress::TurnOver;
  }
  return Progress::Done;
}

bool RequestQueue::carry_out(const Line& line) {
  if (line->stage() == RequestLine::Stage::Away) return false;
  const auto turn_end = std::chrono::steady_clock::now() + kTurn;
  for (bool first = true; const Request* request = line->next(); first = false) {
    if (!first && std::chrono::steady_clock::now() >= turn_end) return false;
    auto refusal = refusal_of(*line, *request);
    if (!refusal) {
      if (aside_.is_away()) return false;
      refusal = Dispatcher::refusal_of(*request, client_.session());
    }
    if (!refusal && is_slow(*request)) {
      carry_out_aside(line, *request);
      return false;
    }
    if (!settle(*line, refusal ? std::move(*refusal) : dispatcher_.execute(*request, client_.session()))) return false;
  }
  return true;
}

void RequestQueue::carry_out_aside(const Line& line, const Request& request) {
  if (request.method->apart) {
    line->set_stage(RequestLine::Stage::Away);
    aside_.carry_out_apart(request, client_.session(), [this, held = client_.hold(), line](Answer answer) {
      line->set_stage(RequestLine::Stage::Here);
      (void)settle(*line, std::move(answer));  // it is no move: its answer is final
      client_.pump();
    });
    return;
  }
  const bool prepared = line->stage() == RequestLine::Stage::Prepared;
  line->set_stage(RequestLine::Stage::Away);
  if (Method::Job job = prepared ? nullptr : dispatcher_.preparation_of(request, client_.session())) {
    // Its turn comes again after it: a stop may have overtaken it by then, or the lease be gone.
    const auto on_done = [this, held = client_.hold(), line](std::optional<Answer> failed) {
      line->set_stage(failed ? RequestLine::Stage::Here : RequestLine::Stage::Prepared);
      if (failed) (void)settle(*line, std::move(*failed));
      client_.pump();
    };
    aside_.prepare(request, client_.session(), std::move(job), on_done);
    return;
  }
  aside_.carry_out(request, client_.session(), client_.id(), [this, held = client_.hold(), line](Answer answer) {
    line->set_stage(RequestLine::Stage::Here);
    return settle(*line, std::move(answer));
  });
}

std::optional<Answer> RequestQueue::refusal_of(const RequestLine& line, const Request& request) const {
  if (only_stops_ && request.method != nullptr && request.method->name != "hello") {
    return refused(MinorCode::UnsupportedOperation,
                   fmt::format("{} was not carried out: {}; from here the machine can be stopped, and nothing else",
                               request.method->name, *only_stops_));
  }
  if (const std::string* stop = stop_mark_.overtaker(request.effect(), line.next_position())) {
    return refused(MinorCode::Other,
                   fmt::format("{} was overtaken by a stop: {} came before it was carried out; send it again if it "
                               "still holds",
                               request.method->name, *stop));
  }
  return line.refusal_of_next();
}

bool RequestQueue::settle(RequestLine& line, Answer answer) {
  const Request& request = *line.next();
  // What a stop overtook leaves no gap: what stands behind the stop begins anew.
  const bool overtaken = stop_mark_.overtaker(request.effect(), line.next_position()) != nullptr;
  if (!answer && request.queues_a_move() && !overtaken && !line.refuses_moves()) {
    const RpcError& error = answer.error();
    const bool full = error.minor == MinorCode::CommandQueueFull;
    if (full && must_wait(line)) return false;
    if (full) dispatcher_.status().fail(error.minor, error.message, dispatcher_.machine().sample().t_s);
    const Answer refusal = full ? behind_a_full_queue() : behind_a_refused_move(error);
    for (const Line& waiting : lines_) waiting->refuse_moves(refusal);
  }
  line.answer_next(std::move(answer));
  return true;
}

bool RequestQueue::must_wait(const RequestLine& line) const {
  // A queue that does not run will not get room by waiting, and a client that has left does not wait.
  const CycleState state = dispatcher_.machine().sample().state;
  const bool runs = state == CycleState::Running || state == CycleState::Holding;
  return runs && client_.stays() && std::chrono::steady_clock::now() - line.received() < queue_wait_;
}

void RequestQueue::answer(const RequestLine& line) {
  if (auto response = line.response()) client_.send(std::move(*response));
}

}  // namespace rmac::gateway
