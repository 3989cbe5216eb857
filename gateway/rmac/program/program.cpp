#include "gateway/rmac/program/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string_view>

#include "gateway/api/dispatch/dispatcher.hpp"
#include "gateway/api/methods/method_table.hpp"
#include "gateway/json/printable.hpp"
#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

namespace {

using namespace std::string_view_literals;

constexpr std::array kMembers{"jsonrpc"sv, "id"sv, "method"sv, "params"sv};

/// What the appliance takes (`limits.line_bytes` of its greeting).
constexpr std::size_t kLongestLine = 8U << 20U;

/// What tells a move's events from another's.
constexpr std::string_view kMoveId = "MoveID";

/// What tells a request's line: where it stands, or its id.
enum class LinesBy { Place, Id };

/// Place of the id among the parameters of a method that queues a move; none for a tool change, which has no id.
std::optional<std::size_t> place_of_id(const std::string& method) {
  const auto& parameters = gateway::find_method(method)->parameters;
  const auto id = std::ranges::find(parameters, kMoveId, &gateway::ParameterSpec::name);
  if (id == parameters.end()) return std::nullopt;
  return static_cast<std::size_t>(id - parameters.begin());
}

std::optional<std::int64_t> move_id_of(const nlohmann::json& params, std::size_t place) {
  nlohmann::json id;
  if (params.is_object()) id = params.value(kMoveId, nlohmann::json());
  if (params.is_array() && params.size() > place) id = params[place];
  return id.is_number_integer() ? std::optional(id.get<std::int64_t>()) : std::nullopt;
}

Result<> read_move(const nlohmann::json& params, const std::string& place, Request& request) {
  const auto place_of = place_of_id(request.method);
  request.tool_change = !place_of;
  if (request.tool_change) return {};
  const auto id = move_id_of(params, *place_of);
  if (!id) return fail(fmt::format("{}: {} needs an integer MoveID", place, request.method));
  request.move_id = *id;
  return {};
}

Result<Request> read_request(std::string_view text, const std::string& place) {
  const auto parsed = gateway::parse_line(text);  // as strictly as the appliance, which sees it written anew
  if (!parsed) return fail(fmt::format("{}: {}; write one JSON-RPC request a line", place, parsed.error().message));
  const nlohmann::json& json = *parsed;
  if (!json.is_object()) {
    return fail(fmt::format("{}: a request is one JSON object, no {}", place, json.type_name()));
  }
  for (const auto& [key, value] : json.items()) {
    if (std::find(kMembers.begin(), kMembers.end(), key) != kMembers.end()) continue;
    return fail(fmt::format("{}: a request has no member \"{}\"; it has \"jsonrpc\", \"id\", \"method\" and \"params\"",
                            place, gateway::printable(key)));
  }
  if (!json.contains("method") || !json["method"].is_string()) {
    return fail(fmt::format("{}: the request has no \"method\": a program holds requests only", place));
  }
  Request request;
  if (const auto id = json.find("id"); id != json.end() && id->is_number_integer()) request.line = id->get<int>();
  request.method = json["method"].get<std::string>();
  request.text = text;
  const auto params = json.value("params", nlohmann::json());
  if (!params.is_null() && !params.is_structured()) {
    return fail(fmt::format("{}: \"params\" of {} is neither an object nor an array", place, request.method));
  }
  request.timing = timing_of(request.method);
  if (request.timing == Timing::Move) {
    if (auto read = read_move(params, place, request); !read) return tl::unexpected(read.error());
  }
  return request;
}

/// The next line without its end, or as much of it as shows that it is too long; false where nothing is left.
bool next_line(std::istream& input, std::string& line) {
  line.clear();
  for (char next = 0; line.size() <= kLongestLine && input.get(next) && next != '\n';) line.push_back(next);
  return !input.bad() && (input || !line.empty());
}

Result<Program> read_requests(std::istream& input, const std::string& name, LinesBy lines) {
  Program program;
  program.file = name;
  std::string text;
  for (int line = 1; next_line(input, text); ++line) {
    if (text.size() > kLongestLine) {
      return fail(fmt::format("{}:{}: more than {} bytes are no request", program.file, line, kLongestLine));
    }
    if (text.find_first_not_of(" \t\r") == std::string::npos) {
      continue;
    }
    auto request = read_request(text, fmt::format("{}:{}", program.file, line));
    if (!request) {
      return tl::unexpected(request.error());
    }
    if (lines == LinesBy::Place) request->line = line;
    program.moves += request->timing == Timing::Move && !request->tool_change ? 1U : 0U;
    program.starts_cycle = program.starts_cycle || request->timing == Timing::Start;
    program.loads_mechanism = program.loads_mechanism || loads_mechanism(*request);
    program.requests.push_back(std::move(*request));
  }
  if (input.bad()) {
    return fail(fmt::format("{}: cannot be read: {}", program.file, std::generic_category().message(errno)));
  }
  if (program.requests.empty()) {
    return fail(fmt::format("{}: holds no request", program.file));
  }
  return program;
}

}  // namespace

nlohmann::json Request::params() const {
  return nlohmann::json::parse(text).value("params", nlohmann::json());
}

bool loads_mechanism(const Request& request) {
  return request.method == kLoadMachine;
}

Result<Program> read_program(const std::string& file) {
  std::ifstream opened;
  if (file != "-") {
    opened.open(file);
    if (!opened) {
      return fail(fmt::format("{}: cannot be read: {}", file, std::generic_category().message(errno)));
    }
  }
  return read_requests(file == "-" ? std::cin : opened, file == "-" ? "standard input" : file, LinesBy::Place);
}

Result<Program> read_imported(std::string requests, const std::string& file) {
  std::istringstream input(std::move(requests));
  return read_requests(input, file, LinesBy::Id);
}

}  // namespace rmac::cli
