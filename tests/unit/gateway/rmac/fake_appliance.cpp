#include "unit/gateway/rmac/fake_appliance.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>

#include "gateway/api/methods/method_table.hpp"
#include "gateway/api/state_json.hpp"

namespace rmac::cli {

using nlohmann::json;

namespace {

/// Why a request is none that an appliance takes; empty: it is one.
std::string fault_of(const std::string& name, const json& params) {
  const gateway::Method* method = gateway::find_method(name);
  if (method == nullptr) return "there is no method " + name;
  const auto arranged = gateway::arrange(*method, params);
  return arranged ? "" : name + ": " + arranged.error().message;
}

}  // namespace

FakeAppliance::FakeAppliance() {
  std::string name = (std::filesystem::temp_directory_path() / "rmac-fake-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr || ::pipe(terminal_) != 0) std::abort();
  folder_ = name;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = endpoint().socket;
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  listener_ = ::socket(AF_UNIX, SOCK_STREAM, 0);
  if (::bind(listener_, static_cast<const sockaddr*>(static_cast<const void*>(&address)), sizeof(address)) != 0 ||
      ::listen(listener_, 1) != 0) {
    std::abort();
  }
  answers("hello", {{"limits", {{"queue_capacity", 100}}}});
  answers("authority.acquire", {{"timeout_s", 0}, {"dropped_moves", 0}});
  answers("RMAC_CAM.GetState", state());
  thread_ = std::thread([this] { serve(); });
}

FakeAppliance::~FakeAppliance() {
  ::shutdown(listener_, SHUT_RDWR);
  {
    const std::lock_guard lock(mutex_);
    if (client_ >= 0) ::shutdown(client_, SHUT_RDWR);  // a test that failed has left it open
  }
  thread_.join();
  ::close(listener_);
  ::close(terminal_[0]);
  ::close(terminal_[1]);
  std::filesystem::remove_all(folder_);
}

Endpoint FakeAppliance::endpoint() const {
  Endpoint endpoint;
  endpoint.socket = folder_ / "socket";
  return endpoint;
}

void FakeAppliance::answers(const std::string& method, json result) {
  handles(method, [result = std::move(result)](const json&) { return gateway::Answer(result); });
}

void FakeAppliance::refuses(const std::string& method, int code, const std::string& message) {
  handles(method, [code, message](const json&) -> gateway::Answer {
    return tl::unexpected(gateway::RpcError{code, message, MinorCode::Unknown});
  });
}

void FakeAppliance::handles(const std::string& method, Handler handler) {
  const std::lock_guard lock(mutex_);
  handlers_[method] = std::move(handler);
}

void FakeAppliance::push(const std::string& topic, const json& params) {
  pushed_ += json{{"jsonrpc", "2.0"}, {"method", topic}, {"params", params}}.dump() + "\n";
}

void FakeAppliance::push_event(gateway::Event::Kind kind, json members) {
  members["kind"] = gateway::to_string(kind);
  push("events", members);
}

void FakeAppliance::hang_up() {
  hung_up_ = true;
}

void FakeAppliance::keep_silent() {
  silent_ = true;
}

void FakeAppliance::hang_up_behind_this() {
  says_last_ = true;
}

void FakeAppliance::type(const std::string& line) {
  const std::string entered = line + "\n";
  ASSERT_EQ(::write(terminal_[1], entered.data(), entered.size()), static_cast<ssize_t>(entered.size()));
}

std::vector<std::string> FakeAppliance::methods() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> methods;
  for (const Heard& heard : heard_) methods.push_back(heard.method);
  return methods;
}

std::vector<json> FakeAppliance::params_of(const std::string& method) const {
  const std::lock_guard lock(mutex_);
  std::vector<json> params;
  for (const Heard& heard : heard_) {
    if (heard.method == method) params.push_back(heard.params);
  }
  return params;
}

void FakeAppliance::serve() {
  for (;;) {
    const int client = ::accept(listener_, nullptr, nullptr);
    if (client < 0) return;  // the test is over
    set_client(client);
    serve_client(client);
    set_client(-1);
    ::close(client);
  }
}

void FakeAppliance::set_client(int client) {
  const std::lock_guard lock(mutex_);
  client_ = client;
}

void FakeAppliance::serve_client(int client) {
  std::string input;
  std::array<char, 4096> piece{};
  hung_up_ = says_last_ = false;
  while (!hung_up_) {
    const auto got = ::recv(client, piece.data(), piece.size(), 0);
    if (got <= 0) return;
    input.append(piece.data(), static_cast<std::size_t>(got));
    for (auto end = input.find('\n'); end != std::string::npos && !hung_up_; end = input.find('\n')) {
      const std::string out = answer(input.substr(0, end));
      input.erase(0, end + 1);
      if (!hung_up_ && ::send(client, out.data(), out.size(), MSG_NOSIGNAL) < 0) return;
      hung_up_ = hung_up_ || says_last_;
    }
  }
}

std::string FakeAppliance::answer(const std::string& line) {
  const json request = json::parse(line);
  const auto method = request.at("method").get<std::string>();
  const json params = request.value("params", json());
  if (const std::string fault = fault_of(method, params); !fault.empty()) ADD_FAILURE() << fault;
  Handler handler;
  {
    const std::lock_guard lock(mutex_);
    if (method != "hello") heard_.push_back({method, params});
    if (const auto known = handlers_.find(method); known != handlers_.end()) handler = known->second;
  }
  pushed_.clear();
  silent_ = false;
  const gateway::Answer answer = handler ? handler(params) : gateway::Answer(true);
  if (silent_) return pushed_;
  return gateway::to_response(request.at("id"), answer).dump() + "\n" + pushed_;
}

json state(json members) {
  json told{{"state", "Idle"},
            {"mode", ""},
            {"mechanism", "BenchXYZ"},
            {"authority", ""},
            {"moving", false},
            {"virtual", false},
            {"move_id", 0},
            {"moves_in_buffer", 0},
            {"t_s", 10.0},
            {"pose", {0, 0, 0, 0, 0, 1}},
            {"joints", {0, 0, 0}},
            {"joints_set", {0, 0, 0}}};
  told.update(members);
  return told;
}

}  // namespace rmac::cli
