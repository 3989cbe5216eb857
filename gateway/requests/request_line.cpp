#include "gateway/requests/request_line.hpp"

#include <fmt/format.h>

#include <new>

#include "gateway/json/printable.hpp"

namespace rmac::gateway {

namespace {

constexpr std::size_t kLargestBatch = 10'000;
/// A batch is answered in one piece, which memory must hold.
constexpr std::size_t kMostAnswerBytes = 8U << 20U;
/// Decoding the parameters of a request with more values takes milliseconds.
constexpr std::size_t kManyValues = 2000;

Request not_a_request(RpcError error) {
  Request request;
  request.error = std::move(error);
  return request;
}

/// Numbers, texts and so on in a tree.
std::size_t values_in(const nlohmann::json& tree) {
  if (!tree.is_structured()) return 1;
  std::size_t values = 0;
  for (const auto& element : tree) values += values_in(element);
  return values;
}

}  // namespace

Answer refused(MinorCode minor, std::string message) {
  return tl::unexpected<RpcError>(to_rpc_error(Error{minor, std::move(message)}));
}

RequestLine::RequestLine(std::uint64_t position, std::size_t bytes, Time received)
    : position_(position), bytes_(bytes), received_(received) {}

void RequestLine::read(std::string_view text) try {
  auto parsed = parse_line(text);
  if (!parsed) {
    requests_.push_back(not_a_request(std::move(parsed.error())));
  } else if (parsed->is_array() && (parsed->empty() || parsed->size() > kLargestBatch)) {
    requests_.push_back(
        not_a_request({rpc_code::kInvalidRequest,
                       fmt::format("a batch of {} requests; 1 to {} are taken", parsed->size(), kLargestBatch),
                       MinorCode::InvalidParameter}));
  } else if (parsed->is_array()) {
    batch_ = true;
    for (auto& message : *parsed) requests_.push_back(read_request(std::move(message)));
  } else {
    requests_.push_back(read_request(std::move(*parsed)));
  }
  if (text.size() > kLongBytes) {
    for (Request& request : requests_) request.large = values_in(request.params) > kManyValues;
  }
  answers_.resize(requests_.size());
} catch (const std::bad_alloc&) {
  requests_.assign(1, not_a_request({rpc_code::kRequestTooLarge,
                                     fmt::format("the line of {} bytes cannot be read, for want of memory", bytes_),
                                     MinorCode::Other}));
  batch_ = false;
  answers_.assign(1, std::nullopt);
}

void RequestLine::answer_stops(const std::function<Answer(const Request& stop, std::uint64_t position)>& carry_out) {
  for (std::size_t i = 0; i < requests_.size(); ++i) {
    if (requests_[i].is_urgent()) answers_[i] = carry_out(requests_[i], position_ + i);
  }
}

bool RequestLine::is_answered_alone() const {
  return !batch_ && answers_[0].has_value();
}

const Request* RequestLine::next() {
  while (next_ < requests_.size() && answers_[next_]) ++next_;
  return next_ < requests_.size() ? &requests_[next_] : nullptr;
}

std::optional<Answer> RequestLine::refusal_of_next() const {
  if (refuses_moves_ && requests_[next_].effect() == Effect::Queues) return refuses_moves_;
  if (answer_bytes_ > kMostAnswerBytes) {
    return refused(MinorCode::Other, "not carried out: the answers of this batch exceed 8 MiB; send smaller batches");
  }
  return std::nullopt;
}

void RequestLine::answer_next(Answer answer) {
  if (batch_ && answer && answer->is_structured()) answer_bytes_ += text_of(*answer).size();
  answers_[next_++] = std::move(answer);
  stage_ = Stage::Here;
}

std::optional<std::string> RequestLine::response() const {
  if (!batch_) {
    if (requests_[0].notification) return std::nullopt;
    return text_of(to_response(requests_[0].id, *answers_[0]));
  }
  nlohmann::json responses = nlohmann::json::array();
  for (std::size_t i = 0; i < requests_.size(); ++i) {
    if (!requests_[i].notification) responses.push_back(to_response(requests_[i].id, *answers_[i]));
  }
  if (responses.empty()) return std::nullopt;
  return text_of(responses);
}

}  // namespace rmac::gateway
