#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "gateway/api/method.hpp"
#include "gateway/api/ports.hpp"

namespace rmac::gateway {

/// Objects and arrays within each other, at most. A NURBS in a batch needs six.
inline constexpr int kLargestNesting = 32;

/// One line of the wire as JSON, or a parse error that says where and why. Never throws; bounded in depth before
/// anything is built.
[[nodiscard]] tl::expected<nlohmann::json, RpcError> parse_line(std::string_view line);

/// One request of a line or of a batch, looked up in the method table.
struct Request {
  nlohmann::json id;               ///< null for a notification, and where it could not be read
  bool notification = false;       ///< wants no answer
  const Method* method = nullptr;  ///< nullptr when `error` is set
  nlohmann::json params;
  std::optional<RpcError> error;  ///< not a request, or an unknown method
  bool large = false;             ///< decoding its parameters takes milliseconds

  /// Whether it overtakes what waits on its connection.
  [[nodiscard]] bool is_urgent() const noexcept { return method != nullptr && method->permission == Permission::Stop; }
  [[nodiscard]] bool queues_a_move() const noexcept { return method != nullptr && method->effect == Effect::Queues; }
  /// What it does to motion with the parameters it came with.
  [[nodiscard]] Effect effect() const;
};

[[nodiscard]] Request read_request(nlohmann::json message);

using Answer = tl::expected<nlohmann::json, RpcError>;

/// Checks a request against the table and the caller's authority, and carries it out. Gateway thread, except that
/// `prepare` and `carry_out` of what is slow run beside it while nothing but stops is carried out there.
class Dispatcher {
 public:
  explicit Dispatcher(MachinePort& machine) : machine_(machine) {}

  [[nodiscard]] Answer execute(const Request& request, SessionPort& session);
  /// The parts of `execute`: why the request is refused before anything is done, if it is; what is to be done before it
  /// has the machine, and where that fails; then carrying it out.
  [[nodiscard]] static std::optional<Answer> refusal_of(const Request& request, const SessionPort& session);
  /// Gateway thread.
  [[nodiscard]] Method::Job preparation_of(const Request& request, SessionPort& session);
  [[nodiscard]] std::optional<Answer> prepare(const Request& request, const Method::Job& job, MachineStatus& status);
  [[nodiscard]] Answer carry_out(const Request& request, SessionPort& session, MachineStatus& status);
  /// Whether an error of it is the machine's: of a stop, or of who may move the machine. What others get wrong stands
  /// in their answers alone.
  [[nodiscard]] static bool changes_status(const Request& request, const SessionPort& session);
  [[nodiscard]] MachineStatus& status() noexcept { return status_; }
  [[nodiscard]] MachinePort& machine() noexcept { return machine_; }

 private:
  MachinePort& machine_;
  MachineStatus status_;
};

/// The answer's line, without the newline.
[[nodiscard]] nlohmann::json to_response(const nlohmann::json& id, const Answer& answer);

}  // namespace rmac::gateway
