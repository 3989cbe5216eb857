#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "gateway/api/dispatch/dispatcher.hpp"
#include "gateway/rmac/wire/connection.hpp"

namespace rmac::cli {

/// An appliance at the other end of a socket that does what a test says. It answers in its own thread, one request
/// after the other, so that what it heard has the order in which the client sent it. A request that the API table does
/// not know, or whose parameters do not fit it, fails the test.
class FakeAppliance {
 public:
  /// Called in the fake's thread, where it may push, type, and hang up; what it pushes follows its answer.
  using Handler = std::function<gateway::Answer(const nlohmann::json& params)>;

  FakeAppliance();
  ~FakeAppliance();
  FakeAppliance(const FakeAppliance&) = delete;
  FakeAppliance& operator=(const FakeAppliance&) = delete;

  [[nodiscard]] Endpoint endpoint() const;

  // What it answers; true where nothing is said. Before the client connects, or by a handler.
  void answers(const std::string& method, nlohmann::json result);
  void refuses(const std::string& method, int code, const std::string& message);
  void handles(const std::string& method, Handler handler);

  // For handlers.
  void push(const std::string& topic, const nlohmann::json& params);
  void push_event(gateway::Event::Kind kind, nlohmann::json members = nlohmann::json::object());
  void hang_up();
  /// The request has no answer.
  void keep_silent();
  /// Hangs up when the answer and what is pushed is sent.
  void hang_up_behind_this();
  /// Enters a line at the terminal.
  void type(const std::string& line);
  /// Where these lines come out.
  [[nodiscard]] int terminal() const { return terminal_[0]; }

  /// Everything that was asked, the greeting left out. Settled once the client has its last answer.
  [[nodiscard]] std::vector<std::string> methods() const;
  /// Parameters of the requests of one method.
  [[nodiscard]] std::vector<nlohmann::json> params_of(const std::string& method) const;

 private:
  struct Heard {
    std::string method;
    nlohmann::json params;
  };

  void serve();
  void set_client(int client);
  void serve_client(int client);
  [[nodiscard]] std::string answer(const std::string& line);

  std::filesystem::path folder_;
  int listener_ = -1;
  int terminal_[2] = {-1, -1};
  mutable std::mutex mutex_;
  std::map<std::string, Handler> handlers_;   ///< guarded by mutex_
  std::vector<Heard> heard_;                  ///< guarded by mutex_
  int client_ = -1;                           ///< guarded by mutex_
  std::string pushed_;                        ///< what goes behind the answer; the fake's thread alone
  bool hung_up_ = false, says_last_ = false;  ///< the fake's thread alone
  bool silent_ = false;                       ///< the fake's thread alone
  std::thread thread_;
};

/// A state as the appliance tells it: at rest, with nothing queued, unless `members` say something else.
[[nodiscard]] nlohmann::json state(nlohmann::json members = nlohmann::json::object());

}  // namespace rmac::cli
