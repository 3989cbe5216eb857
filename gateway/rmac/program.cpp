#include "gateway/rmac/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iostream>
#include <string_view>

#include "gateway/api/dispatch/dispatcher.hpp"
#include "gateway/json/printable.hpp"

namespace rmac::cli {

namespace {

using namespace std::string_view_literals;

// Modal for the moves that are queued after them, or questions: neither disturbs what is under way.
constexpr std::array kStreaming{"hello"sv,
                                "subscribe"sv,
                                "unsubscribe"sv,
                                "rpc.discover"sv,
                                "authority.acquire"sv,
                                "authority.renew"sv,
                                "SetFeedrate"sv,
                                "SetPathTolerance"sv,
                                "SetPathAccelRise"sv,
                                "SetPathAccelFall"sv,
                                "SetJointInterpSpeed"sv,
                                "SetFeedOverride"sv,
                                "CurrentPosition"sv,
                                "NumMovesInBuffer"sv,
                                "StatusMajorCode"sv,
                                "StatusMinorCode"sv,
                                "Ok"sv};

constexpr std::array kMoves{"MoveAlong"sv,      "MoveToPathTarget"sv, "MoveToJointTarget"sv, "MoveToXYZ"sv,
                            "MoveRotaryAxis"sv, "MoveInArc"sv,        "MoveAllAxis"sv,       "AutoMeasure"sv,
                            "Machine_MoveIn"sv, "Machine_MoveTo"sv};

constexpr std::array kMembers{"jsonrpc"sv, "id"sv, "method"sv, "params"sv};

/// What the appliance takes (`limits.line_bytes` of its greeting).
constexpr std::size_t kLongestLine = 8U << 20U;

/// Queued behind the moves before it, and the moves after it wait for it.
constexpr std::string_view kToolChange = "DoToolChange";

bool starts_with_any(std::string_view name, const auto& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(), [&](auto prefix) { return name.starts_with(prefix); });
}

std::string_view function_of(std::string_view method) {
  const auto dot = method.find('.');
  const auto interface = method.substr(0, dot);
  return interface == "RMAC_CAM" || interface == "Device" || interface == "RMAC_Config" ? method.substr(dot + 1)
                                                                                        : method;
}

std::optional<std::int64_t> move_id_of(const nlohmann::json& params) {
  if (params.is_object() && params.contains("MoveID") && params["MoveID"].is_number_integer()) {
    return params["MoveID"].get<std::int64_t>();
  }
  if (params.is_array() && !params.empty() && params[0].is_number_integer()) {
    return params[0].get<std::int64_t>();
  }
  return std::nullopt;
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
  request.method = json["method"].get<std::string>();
  request.text = text;
  const auto params = json.value("params", nlohmann::json());
  if (!params.is_null() && !params.is_structured()) {
    return fail(fmt::format("{}: \"params\" of {} is neither an object nor an array", place, request.method));
  }
  request.timing = timing_of(request.method);
  request.tool_change = function_of(request.method) == kToolChange;
  if (request.timing == Timing::Move && !request.tool_change) {
    const auto id = move_id_of(params);
    if (!id) {
      return fail(fmt::format("{}: {} needs an integer MoveID", place, request.method));
    }
    request.move_id = *id;
  }
  return request;
}

}  // namespace

nlohmann::json Request::params() const {
  return nlohmann::json::parse(text).value("params", nlohmann::json());
}

Timing timing_of(const std::string& method) {
  const auto function = function_of(method);
  if (function == "CycleStart" || function == "SetCycleStartStatus") {
    return Timing::Start;
  }
  if (starts_with_any(function, kMoves) || function == kToolChange) {
    return Timing::Move;
  }
  const bool asks = function.starts_with("Get") || function.starts_with("Machine_Get") ||
                    function.starts_with("DeviceDriverManager.");
  const bool streams = std::find(kStreaming.begin(), kStreaming.end(), function) != kStreaming.end();
  return asks || streams ? Timing::Stream : Timing::Settled;
}

Result<Program> read_program(const std::string& file) {
  std::ifstream opened;
  if (file != "-") {
    opened.open(file);
    if (!opened) {
      return fail(fmt::format("{}: cannot be read: {}", file, std::generic_category().message(errno)));
    }
  }
  std::istream& input = file == "-" ? std::cin : opened;
  Program program;
  program.file = file == "-" ? "standard input" : file;
  std::vector<char> buffer(kLongestLine + 1);
  int line = 1;
  for (; input.getline(buffer.data(), static_cast<std::streamsize>(buffer.size())); ++line) {
    const auto taken = static_cast<std::size_t>(input.gcount());  // with the newline, where there is one
    const std::string_view text(buffer.data(), input.eof() ? taken : taken - 1);
    if (text.find_first_not_of(" \t\r") == std::string_view::npos) {
      continue;
    }
    auto request = read_request(text, fmt::format("{}:{}", program.file, line));
    if (!request) {
      return tl::unexpected(request.error());
    }
    request->line = line;
    program.moves += request->timing == Timing::Move && !request->tool_change ? 1U : 0U;
    program.starts_cycle = program.starts_cycle || request->timing == Timing::Start;
    program.loads_mechanism = program.loads_mechanism || request->method == "Device.Load";
    program.requests.push_back(std::move(*request));
  }
  if (input.bad()) {
    return fail(fmt::format("{}: cannot be read: {}", program.file, std::generic_category().message(errno)));
  }
  if (!input.eof())
    return fail(fmt::format("{}:{}: more than {} bytes are no request", program.file, line, kLongestLine));
  if (program.requests.empty()) {
    return fail(fmt::format("{}: holds no request", program.file));
  }
  return program;
}

}  // namespace rmac::cli
