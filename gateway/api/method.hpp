#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gateway/api/ports.hpp"
#include "gateway/api/wire_type.hpp"

namespace rmac::gateway {

enum class Permission {
  Anyone,     ///< reads
  Authority,  ///< moves or changes the machine: needs the lease
  Operator,   ///< what a person at the machine does to the program's motion: needs the lease, or the operator's place
  Stop,       ///< stops: needs no lease, and overtakes what waits on its connection
};

/// What a method does to motion. It decides what becomes of a request that still waits, on whichever connection, when
/// someone stops the machine.
enum class Effect {
  None,    ///< moves nothing by itself: runs whatever was stopped meanwhile
  Queues,  ///< adds a move to the queue: refused after a stop that empties the queue
  Starts,  ///< motion, a spindle or power may come on by it: refused after every stop
  Holds,   ///< a stop that keeps the queue
  Stops,   ///< a stop that empties the queue
};

enum class Origin { Dissertation, Extension };

[[nodiscard]] const char* to_string(Permission permission) noexcept;
[[nodiscard]] const char* to_string(Effect effect) noexcept;
[[nodiscard]] const char* to_string(Origin origin) noexcept;

/// One method of the API. Dispatch, parameter checks, `rpc.discover` and docs/api.md read this and nothing else.
struct Method {
  /// Arguments in the order of `parameters`; null pointers stand for optional ones that were left out.
  using Arguments = std::vector<const nlohmann::json*>;
  using Handler = std::function<tl::expected<nlohmann::json, RpcError>(Call&, const Arguments&)>;
  /// Work that touches nothing of the machine; it has what it needs. Any thread.
  using Job = std::function<Expected<>()>;
  using Preparation = std::function<Job(Call&, const Arguments&)>;

  std::string name;  ///< "Interface.Function"
  std::string meaning;
  std::vector<ParameterSpec> parameters;
  ResultSpec result;
  Permission permission = Permission::Anyone;
  Origin origin = Origin::Dissertation;
  Effect effect = Effect::None;
  /// The parameter and the value with which the method has no effect: a button let go, a spindle switched off.
  struct Harmless {
    std::size_t parameter = 0;
    nlohmann::json value;
  };
  std::optional<Harmless> harmless;
  bool property = false;    ///< reads without `newVal`; with it writes, gives true, and needs authority
  bool slow = false;        ///< may take so long that others' stops must not wait for it
  bool apart = false;       ///< slow, and needs nothing of the machine: nobody waits for it but its client
  Preparation preparation;  ///< of a slow method: says what is to be done before it has the machine; may be none
  Handler handler;
};

/// Binds the call's JSON to the handler: parameters by name or by position, none unknown, none missing. Types and
/// ranges are checked by the handler, which knows the C++ types.
[[nodiscard]] tl::expected<Method::Arguments, RpcError> arrange(const Method& method, const nlohmann::json& params);

}  // namespace rmac::gateway
