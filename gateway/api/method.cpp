#include "gateway/api/method.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gateway/api/decode.hpp"

namespace rmac::gateway {

namespace {

using nlohmann::json;

tl::unexpected<RpcError> refused(std::string message) {
  return tl::unexpected<RpcError>(RpcError{rpc_code::kInvalidParams, std::move(message), MinorCode::InvalidParameter});
}

std::string signature(const Method& method) {
  std::string text;
  for (const ParameterSpec& parameter : method.parameters) {
    text += fmt::format("{}{}{}", text.empty() ? "" : ", ", parameter.name, parameter.optional ? " (optional)" : "");
  }
  return text.empty() ? method.name + " takes no parameters" : method.name + " takes " + text;
}

}  // namespace

const char* to_string(Permission permission) noexcept {
  switch (permission) {
    case Permission::Anyone:
      return "anyone";
    case Permission::Authority:
      return "authority";
    case Permission::Operator:
      return "operator";
    case Permission::Stop:
      return "stop";
  }
  return "anyone";
}

const char* to_string(Effect effect) noexcept {
  switch (effect) {
    case Effect::None:
      return "none";
    case Effect::Queues:
      return "queues";
    case Effect::Starts:
      return "starts";
    case Effect::Holds:
      return "holds";
    case Effect::Stops:
      return "stops";
  }
  return "none";
}

const char* to_string(Origin origin) noexcept {
  return origin == Origin::Dissertation ? "dissertation" : "extension";
}

tl::expected<Method::Arguments, RpcError> arrange(const Method& method, const json& params) {
  Method::Arguments arguments(method.parameters.size(), nullptr);
  if (params.is_array()) {
    if (params.size() > arguments.size()) {
      return refused(fmt::format("{} parameters given; {}", params.size(), signature(method)));
    }
    for (std::size_t i = 0; i < params.size(); ++i) arguments[i] = &params[i];
  } else if (params.is_object()) {
    for (const auto& [key, value] : params.items()) {
      const auto found = std::ranges::find(method.parameters, key, &ParameterSpec::name);
      if (found == method.parameters.end()) {
        return refused(fmt::format("unknown parameter \"{}\"; {}", key.substr(0, 80), signature(method)));
      }
      arguments[static_cast<std::size_t>(found - method.parameters.begin())] = &value;
    }
  } else if (!params.is_null()) {
    return refused(fmt::format("params is {}, expected an object of named parameters or an array; {}",
                               shortened(params), signature(method)));
  }
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == nullptr && !method.parameters[i].optional) {
      return refused(fmt::format("parameter \"{}\" is missing; {}", method.parameters[i].name, signature(method)));
    }
  }
  return arguments;
}

}  // namespace rmac::gateway
