#pragma once

#include <fmt/format.h>

#include <tuple>
#include <utility>

#include "gateway/api/decode.hpp"
#include "gateway/api/method.hpp"

// How the method table is written: each entry names its parameters with C++ types, and its handler takes just those
// types, so a handler that does not fit its declaration does not compile.

namespace rmac::gateway {

/// A declared parameter whose value reaches the handler as T.
template <typename T>
struct Parameter {
  ParameterSpec spec;

  Parameter above(double bound) && {
    spec.range.min = bound;
    spec.range.min_excluded = true;
    return std::move(*this);
  }
  Parameter at_least(double bound) && {
    spec.range.min = bound;
    return std::move(*this);
  }
  Parameter within(double min, double max) && {
    spec.range = {min, max, false};
    return std::move(*this);
  }
  Parameter within(const Range& range) && {
    spec.range = range;
    return std::move(*this);
  }
  Parameter noted(std::string text) && {
    spec.note = std::move(text);
    return std::move(*this);
  }
  Parameter<std::optional<T>> optional() && {
    spec.optional = true;
    return {std::move(spec)};
  }
  /// Optional, and null stands for it too.
  Parameter<std::optional<T>> or_null() && {
    spec.null_is_none = true;
    return std::move(*this).optional();
  }
};

template <typename T>
Parameter<T> declared(const char* name, WireType type, const char* unit = "") {
  Parameter<T> parameter;
  parameter.spec.name = name;
  parameter.spec.type = type;
  parameter.spec.unit = unit;
  return parameter;
}

inline auto boolean(const char* name) {
  return declared<bool>(name, WireType::Boolean);
}
inline auto integer(const char* name, const char* unit = "") {
  return declared<std::int64_t>(name, WireType::Integer, unit);
}
inline auto number(const char* name, const char* unit) {
  return declared<double>(name, WireType::Number, unit);
}
inline auto text(const char* name) {
  return declared<std::string>(name, WireType::String);
}
inline auto numbers(const char* name, const char* unit) {
  return declared<std::vector<double>>(name, WireType::Numbers, unit);
}
inline auto texts(const char* name) {
  return declared<std::vector<std::string>>(name, WireType::Strings);
}
/// Objects whose members the schema of a file describes; the handler holds them to it.
inline auto object(const char* name) {
  return declared<JsonValue>(name, WireType::Object);
}
inline auto objects(const char* name) {
  return declared<JsonValue>(name, WireType::Objects);
}
inline auto mask(const char* name) {
  return declared<Mask>(name, WireType::Mask);
}
/// Where a place may lie: no machine is larger, and the arithmetic behind keeps its digits.
inline constexpr Range kPlaces{-1e6, 1e6};
inline auto vector(const char* name) {
  return declared<Vector>(name, WireType::Vector, "mm").within(kPlaces);
}
inline auto frame(const char* name) {
  return declared<Frame>(name, WireType::Frame, "mm").within(kPlaces);
}
inline auto tool_pose(const char* name) {
  return declared<ToolPose>(name, WireType::Frame, "mm").within(kPlaces);
}
inline auto joint_target(const char* name) {
  return declared<JointTarget>(name, WireType::JointTarget, "mm or deg").within(kPlaces);
}
inline auto nurbs(const char* name) {
  return declared<TipNurbs>(name, WireType::Nurbs, "mm").within(kPlaces);
}
inline auto nurbs_nd(const char* name) {
  return declared<NurbsGeometry>(name, WireType::NurbsNd, "mm or deg").within(kPlaces);
}
inline auto choice(const char* name, const Enumeration& values) {
  auto parameter = declared<std::int64_t>(name, WireType::Integer);
  parameter.spec.enumeration = &values;
  return parameter;
}

/// Joints count from 0, held ones after the moved ones. Which exist is the machine's business.
inline auto joint_number(const char* name = "JntNum") {
  return integer(name).within(0, static_cast<double>(kMaxJoints - 1));
}
inline auto move_id() {
  return integer("MoveID").noted("the client's number; comes back in events and records");
}

namespace detail {

template <typename T>
struct IsOptional : std::false_type {};
template <typename T>
struct IsOptional<std::optional<T>> : std::true_type {};

/// One argument as T, or the message that names the parameter, the value and what goes there.
template <typename T>
bool take(const nlohmann::json* argument, const ParameterSpec& spec, T& out, RpcError& error) {
  if (argument == nullptr || (spec.null_is_none && argument->is_null())) return true;  // optional and left out
  Decoded<T> decoded{T{}};
  decode_into(*argument, spec, decoded);
  if (decoded) {
    out = std::move(*decoded);
    return true;
  }
  const Mismatch& wrong = decoded.error();
  error = {rpc_code::kInvalidParams,
           fmt::format("parameter \"{}\"{}{} is {}, expected {}", spec.name, wrong.where.empty() ? "" : " at ",
                       wrong.where, wrong.found, wrong.expected),
           MinorCode::InvalidParameterValue};
  return false;
}

/// Remembers the machine's last error. A full queue is one only when the server gives up waiting; it notes that itself.
inline void note(const Error& error, const Call& call) {
  if (error.code == MinorCode::CommandQueueFull) return;
  call.status.fail(error.code, error.message, call.machine.sample().t_s);
}

/// What a handler returns, as JSON: nothing becomes `done` (null, or true where the declaration says boolean).
inline tl::expected<nlohmann::json, RpcError> finish(Expected<> outcome, const Call& call, const nlohmann::json& done) {
  if (outcome) return done;
  note(outcome.error(), call);
  return tl::unexpected<RpcError>(to_rpc_error(outcome.error()));
}
template <typename T>
tl::expected<nlohmann::json, RpcError> finish(Expected<T> outcome, const Call& call, const nlohmann::json& /*done*/) {
  if (outcome) return nlohmann::json(std::move(*outcome));
  note(outcome.error(), call);
  return tl::unexpected<RpcError>(to_rpc_error(outcome.error()));
}
inline tl::expected<nlohmann::json, RpcError> finish(tl::expected<nlohmann::json, RpcError> outcome,
                                                     const Call& /*call*/, const nlohmann::json& /*done*/) {
  return outcome;
}
inline tl::expected<nlohmann::json, RpcError> finish(tl::expected<void, RpcError> outcome, const Call& /*call*/,
                                                     const nlohmann::json& done) {
  if (outcome) return done;
  return tl::unexpected<RpcError>(std::move(outcome.error()));
}
template <typename T>
tl::expected<nlohmann::json, RpcError> finish(T value, const Call& /*call*/, const nlohmann::json& /*done*/) {
  return nlohmann::json(std::move(value));
}

}  // namespace detail

/// A method under construction whose handler takes (Call&, Ts...).
template <typename... Ts>
class MethodBuilder {
 public:
  explicit MethodBuilder(Method method) : method_(std::move(method)) {}

  template <typename... Us>
  MethodBuilder<Us...> takes(Parameter<Us>... parameters) && {
    (method_.parameters.push_back(std::move(parameters.spec)), ...);
    return MethodBuilder<Us...>(std::move(method_));
  }
  MethodBuilder gives(WireType type, const char* unit = "", const Enumeration* enumeration = nullptr) && {
    method_.result = {type, unit, enumeration};
    return std::move(*this);
  }
  MethodBuilder needs(Permission permission) && {
    method_.permission = permission;
    return std::move(*this);
  }
  MethodBuilder extension() && {
    method_.origin = Origin::Extension;
    return std::move(*this);
  }
  MethodBuilder property() && {
    method_.property = true;
    return std::move(*this);
  }
  /// What it does to motion. Whoever may stop, may; all else takes authority.
  MethodBuilder causes(Effect effect) && {
    method_.effect = effect;
    const bool stops = effect == Effect::Holds || effect == Effect::Stops;
    return std::move(*this).needs(stops ? Permission::Stop : Permission::Authority);
  }
  MethodBuilder may_be_slow() && {
    method_.slow = true;
    return std::move(*this);
  }
  /// Slow too, but it touches nothing of the machine, only what belongs to its connection.
  MethodBuilder runs_apart() && {
    method_.apart = true;
    return std::move(*this).may_be_slow();
  }
  /// Gives the part of it that takes long and touches nothing that moves, which is done before the machine is its own;
  /// none where there is nothing to do. An error of it ends the call.
  template <typename Function>
  MethodBuilder prepared_by(Function function) && {
    method_.preparation = [function = std::move(function), specs = method_.parameters](
                              Call& call, const Method::Arguments& arguments) -> Method::Job {
      std::tuple<Ts...> values{};
      // What is wrong with them the handler tells.
      if (!take_all(specs, arguments, values, std::index_sequence_for<Ts...>{})) return {};
      return std::apply([&](const Ts&... value) { return function(call, value...); }, values);
    };
    return std::move(*this);
  }
  /// With this value of its last parameter it has no effect on motion.
  MethodBuilder except(nlohmann::json value) && {
    method_.harmless = Method::Harmless{sizeof...(Ts) - 1, std::move(value)};
    return std::move(*this);
  }

  /// The method works, by this handler.
  template <typename Function>
  Method does(Function function) && {
    method_.handler = handler_of(std::move(function),
                                 method_.result.type == WireType::Boolean ? nlohmann::json(true) : nlohmann::json());
    return std::move(method_);
  }

 private:
  template <typename Function>
  Method::Handler handler_of(Function function, nlohmann::json done) const {
    return [function = std::move(function), specs = method_.parameters, done = std::move(done)](
               Call& call, const Method::Arguments& arguments) -> tl::expected<nlohmann::json, RpcError> {
      return invoke(function, specs, done, call, arguments, std::index_sequence_for<Ts...>{});
    };
  }
  template <std::size_t... kIndex>
  static tl::expected<void, RpcError> take_all(const std::vector<ParameterSpec>& specs,
                                               const Method::Arguments& arguments, std::tuple<Ts...>& values,
                                               std::index_sequence<kIndex...>) {
    RpcError error;
    const bool taken = (detail::take(arguments[kIndex], specs[kIndex], std::get<kIndex>(values), error) && ...);
    if (!taken) return tl::unexpected<RpcError>(std::move(error));
    return {};
  }
  template <typename Function, std::size_t... kIndex>
  static tl::expected<nlohmann::json, RpcError> invoke(const Function& function,
                                                       const std::vector<ParameterSpec>& specs,
                                                       const nlohmann::json& done, Call& call,
                                                       const Method::Arguments& arguments,
                                                       std::index_sequence<kIndex...>) {
    std::tuple<Ts...> values{};
    auto taken = take_all(specs, arguments, values, std::index_sequence<kIndex...>{});
    if (!taken) return tl::unexpected<RpcError>(std::move(taken.error()));
    return detail::finish(function(call, std::get<kIndex>(values)...), call, done);
  }

  Method method_;
};

/// Starts the declaration of a method: its name on the wire and one line of meaning.
inline MethodBuilder<> method(const char* name, const char* meaning) {
  Method declared_method;
  declared_method.name = name;
  declared_method.meaning = meaning;
  return MethodBuilder<>(std::move(declared_method));
}

}  // namespace rmac::gateway
