#include "gateway/api/dispatch/dispatcher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "gateway/api/decode.hpp"
#include "gateway/api/methods/method_table.hpp"
#include "gateway/json/printable.hpp"

namespace rmac::gateway {

namespace {

using nlohmann::json;

constexpr std::size_t kLongestReason = 300;
/// What a value in an array takes, which grows by doubling; and what arrays, objects, their members and texts take
/// beside that.
constexpr std::size_t kElementBytes = 2 * sizeof(json), kArrayBytes = 32, kObjectBytes = 64, kMemberBytes = 96,
                      kTextBytes = 48;
/// A line of 8 MiB takes as much where it is all coordinates; `[[],[],…` would take more.
constexpr std::size_t kLargestTree = std::size_t{128} << 20;

tl::unexpected<RpcError> wrong(int code, std::string message) {
  return tl::unexpected<RpcError>(RpcError{code, std::move(message), MinorCode::InvalidParameter});
}

/// What one look at the characters tells of a line, before anything is built from it.
struct Outline {
  int nesting = 0;          ///< deepest, of brackets outside texts
  std::size_t members = 0;  ///< of all objects together
  std::size_t bytes = 0;    ///< that what is read from it takes, at most
};

Outline outline_of(std::string_view line) {
  Outline outline;
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (in_text) {
      if (c == '\\') ++i;
      if (c == '"') in_text = false;
    } else if (c == '"') {
      in_text = true;
      outline.bytes += kTextBytes;
    } else if (c == '[' || c == '{') {
      outline.nesting = std::max(outline.nesting, ++depth);
      outline.bytes += c == '[' ? kArrayBytes : kObjectBytes;
    } else if (c == ',') {
      outline.bytes += kElementBytes;
    } else if (c == ':') {
      ++outline.members;
      outline.bytes += kMemberBytes;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return outline;
}

std::size_t members_in(const json& value) {
  if (!value.is_structured()) return 0;
  std::size_t members = value.is_object() ? value.size() : 0;
  for (const json& element : value) members += members_in(element);
  return members;
}

/// A key that stands twice in one object of a line that has such.
std::string repeated_key(std::string_view line) {
  std::vector<std::set<std::string>> open;
  std::string repeated;
  const auto watch = [&](int, json::parse_event_t event, json& value) {
    if (event == json::parse_event_t::object_start) open.emplace_back();
    if (event == json::parse_event_t::object_end) open.pop_back();
    if (event == json::parse_event_t::key && !open.back().insert(value.get<std::string>()).second) {
      repeated = shortened(value);
    }
    return true;
  };
  const json again = json::parse(line, watch);
  return repeated;
}

/// NaN and Infinity are what people send most often that is not JSON, so they are named.
const char* hint_for(std::string_view line) {
  for (const char* word : {"NaN", "nan", "Infinity", "inf"}) {
    if (line.find(word) != std::string_view::npos)
      return "; JSON has no NaN and no Infinity, every number must be finite";
  }
  return "";
}

}  // namespace

tl::expected<json, RpcError> parse_line(std::string_view line) {
  const Outline outline = outline_of(line);
  if (outline.nesting > kLargestNesting) {
    return wrong(rpc_code::kParseError,
                 fmt::format("nested {} deep, at most {} objects and arrays within each other are read",
                             outline.nesting, kLargestNesting));
  }
  if (outline.bytes > kLargestTree) {
    return wrong(
        rpc_code::kRequestTooLarge,
        fmt::format("the line holds so many objects, arrays and texts that it would take {} MiB of memory, more "
                    "than {}; send smaller requests",
                    outline.bytes >> 20U, kLargestTree >> 20U));
  }
  try {
    json parsed = json::parse(line);
    // A reader keeps one of two members with the same name, so then the line has more than what was read from it.
    if (members_in(parsed) != outline.members) {
      return wrong(rpc_code::kInvalidRequest,
                   fmt::format("the member {} stands twice in one object; say what it is once", repeated_key(line)));
    }
    return parsed;
  } catch (const json::exception& error) {
    // The reader's message begins with its own name and the number of the line, which is always 1.
    const std::string_view what = error.what();
    const auto place = what.find("column");
    return wrong(rpc_code::kParseError,
                 fmt::format("the line is not JSON: {}{}",
                             printable(what.substr(place == what.npos ? 0 : place), kLongestReason), hint_for(line)));
  }
}

Request read_request(json message) {
  Request request;
  const auto refuse = [&](std::string why) {
    request.error = RpcError{rpc_code::kInvalidRequest, std::move(why), MinorCode::InvalidParameter};
    request.notification = false;
  };
  if (!message.is_object()) {
    refuse(fmt::format("{} is not a request; expected {}", shortened(message),
                       R"({"jsonrpc": "2.0", "id": 1, "method": "...", "params": {...}})"));
    return request;
  }
  request.notification = !message.contains("id");
  if (!request.notification) {
    json& id = message["id"];
    // A number that no 64 bits hold, or a fraction, would come back as another.
    if (!id.is_string() && !id.is_number_integer() && !id.is_null()) {
      refuse(fmt::format("\"id\" is {}, expected a text, an integer from -2^63 to 2^64-1, or null", shortened(id)));
      return request;
    }
    request.id = std::move(id);
  }
  for (const auto& [key, value] : message.items()) {
    if (key == "jsonrpc" || key == "id" || key == "method" || key == "params") continue;
    refuse(fmt::format("a request has no member {}; it has \"jsonrpc\", \"id\", \"method\" and \"params\"",
                       shortened(key)));
    return request;
  }
  if (!message.contains("jsonrpc") || message["jsonrpc"] != "2.0") {
    refuse(R"(a request needs "jsonrpc": "2.0")");
    return request;
  }
  if (!message.contains("method") || !message["method"].is_string()) {
    refuse(R"(a request needs "method", a text)");
    return request;
  }
  const std::string& name = message["method"].get_ref<const std::string&>();
  request.method = find_method(name);
  if (request.method == nullptr) {
    request.error = RpcError{rpc_code::kMethodNotFound,
                             fmt::format("there is no method {}; rpc.discover lists all", shortened(message["method"])),
                             MinorCode::UnsupportedOperation};
  }
  if (message.contains("params")) request.params = std::move(message["params"]);
  return request;
}

Effect Request::effect() const {
  if (method == nullptr) return Effect::None;
  if (!method->harmless) return method->effect;
  const auto arguments = arrange(*method, params);
  const bool harmless = arguments && *(*arguments)[method->harmless->parameter] == method->harmless->value;
  return harmless ? Effect::None : method->effect;
}

namespace {

/// Nothing below is meant to throw; a client gets an answer all the same, and the daemon lives on.
Answer failed(const Method& method, const std::exception& error) {
  return tl::unexpected<RpcError>(RpcError{rpc_code::kInternalError,
                                           fmt::format("{} failed: {}", method.name, printable(error.what())),
                                           MinorCode::Unknown});
}

}  // namespace

Answer Dispatcher::execute(const Request& request, SessionPort& session) {
  if (auto refusal = refusal_of(request, session)) return std::move(*refusal);
  MachineStatus nobodys = status_;
  MachineStatus& status = changes_status(request, session) ? status_ : nobodys;
  if (const Method::Job job = preparation_of(request, session)) {
    if (auto failed = prepare(request, job, status)) return std::move(*failed);
  }
  return carry_out(request, session, status);
}

bool Dispatcher::changes_status(const Request& request, const SessionPort& session) {
  return request.is_urgent() || session.has_authority();
}

std::optional<Answer> Dispatcher::refusal_of(const Request& request, const SessionPort& session) {
  if (request.error) return tl::unexpected<RpcError>(*request.error);
  const Method& method = *request.method;
  const auto arguments = arrange(method, request.params);
  if (!arguments) return tl::unexpected<RpcError>(arguments.error());
  const bool writes_property = method.property && arguments->back() != nullptr;
  if (method.permission == Permission::Operator && !session.has_authority() && !session.is_operator()) {
    return tl::unexpected<RpcError>(
        RpcError{rpc_code::kAuthorityRequired,
                 fmt::format("{} needs the operator's place, or motion authority; {}", method.name,
                             session.operator_name().empty() ? "call operator.acquire first"
                                                             : session.operator_name() + " is the operator"),
                 MinorCode::UnsupportedOperation});
  }
  if ((method.permission == Permission::Authority || writes_property) && !session.has_authority()) {
    const std::string holder = session.authority_holder();
    return tl::unexpected<RpcError>(RpcError{
        rpc_code::kAuthorityRequired,
        fmt::format("{} needs motion authority; {}", method.name,
                    holder.empty() ? "call authority.acquire first"
                                   : fmt::format("{} holds it: call authority.acquire when it is free", holder)),
        MinorCode::UnsupportedOperation});
  }
  return std::nullopt;
}

Method::Job Dispatcher::preparation_of(const Request& request, SessionPort& session) {
  if (!request.method->preparation) return {};
  Call call{machine_, status_, session};
  try {
    return request.method->preparation(call, *arrange(*request.method, request.params));
  } catch (const std::exception&) {
    return {};  // what is in its way the handler meets too, and tells
  }
}

std::optional<Answer> Dispatcher::prepare(const Request& request, const Method::Job& job, MachineStatus& status) {
  try {
    const Expected<> done = job();
    if (done) return std::nullopt;
    status.fail(done.error().code, done.error().message, machine_.sample().t_s);
    return tl::unexpected<RpcError>(to_rpc_error(done.error()));
  } catch (const std::exception& error) {
    return failed(*request.method, error);
  }
}

Answer Dispatcher::carry_out(const Request& request, SessionPort& session, MachineStatus& status) {
  const Method& method = *request.method;
  Call call{machine_, status, session};
  try {
    return method.handler(call, *arrange(method, request.params));
  } catch (const std::exception& error) {
    return failed(method, error);
  }
}

json to_response(const json& id, const Answer& answer) {
  json response{{"jsonrpc", "2.0"}, {"id", id}};
  if (answer) {
    response["result"] = *answer;
  } else {
    response["error"] = to_json(answer.error());
  }
  return response;
}

}  // namespace rmac::gateway
