#include "gateway/api/methods/openrpc.hpp"

#include <cmath>

#include "gateway/api/methods/method_table.hpp"

namespace rmac::gateway {

namespace {

using nlohmann::json;

json reference(const char* name) {
  return {{"$ref", std::string("#/components/schemas/") + name}};
}

json schema_of(WireType type) {
  switch (type) {
    case WireType::Null:
      return {{"type", "null"}};
    case WireType::Boolean:
      return {{"type", "boolean"}};
    case WireType::Integer:
      return {{"type", "integer"}};
    case WireType::Number:
      return {{"type", "number"}};
    case WireType::String:
      return {{"type", "string"}};
    case WireType::Numbers:
      return {{"type", "array"}, {"items", {{"type", "number"}}}};
    case WireType::Strings:
      return {{"type", "array"}, {"items", {{"type", "string"}}}};
    case WireType::Mask:
      return {{"oneOf",
               {{{"type", "integer"}, {"minimum", 0}}, {{"type", "string"}, {"pattern", "^0x[0-9a-fA-F]{1,16}$"}}}}};
    case WireType::Vector:
      return reference("Vector");
    case WireType::Frame:
      return reference("Frame");
    case WireType::JointTarget:
      return {{"oneOf", {reference("Frame"), reference("Joints")}}};
    case WireType::Nurbs:
      return reference("Nurbs");
    case WireType::NurbsNd:
      return reference("NurbsND");
    case WireType::Object:
      return {{"type", "object"}};
    case WireType::Objects:
      return {{"type", "array"}, {"items", {{"type", "object"}}}};
  }
  return json::object();
}

json enumerated(const Enumeration& values) {
  json all = json::array();
  for (const auto& value : values.values) all.push_back(value.number);
  for (const auto& value : values.values) all.push_back(value.name);
  return {{"enum", all}, {"title", values.name}};
}

json parameter_to_json(const ParameterSpec& parameter) {
  json schema = parameter.enumeration != nullptr ? enumerated(*parameter.enumeration) : schema_of(parameter.type);
  if (std::isfinite(parameter.range.min)) {
    schema[parameter.range.min_excluded ? "exclusiveMinimum" : "minimum"] = parameter.range.min;
  }
  if (std::isfinite(parameter.range.max)) schema["maximum"] = parameter.range.max;
  json result{{"name", parameter.name}, {"required", !parameter.optional}, {"schema", schema}};
  if (!parameter.unit.empty()) result["x-unit"] = parameter.unit;
  if (!parameter.note.empty()) result["description"] = parameter.note;
  return result;
}

json result_to_json(const Method& entry) {
  json schema =
      entry.result.enumeration != nullptr ? enumerated(*entry.result.enumeration) : schema_of(entry.result.type);
  if (entry.property) schema = {{"oneOf", {schema, {{"type", "boolean"}}}}};
  json result{{"name", "result"}, {"schema", schema}};
  if (entry.property) result["description"] = "the value; true when newVal was given and taken";
  if (!entry.result.unit.empty()) result["x-unit"] = entry.result.unit;
  return result;
}

json components() {
  const json numbers{{"type", "array"}, {"items", {{"type", "number"}}}};
  json of_three = numbers;
  of_three["minItems"] = of_three["maxItems"] = 3;
  json of_four = numbers;
  of_four["minItems"] = of_four["maxItems"] = 4;
  json nurbs{{"type", "object"},
             {"required", {"degree", "knots", "points"}},
             {"properties",
              {{"degree", {{"type", "integer"}, {"minimum", 1}, {"maximum", 25}}},
               {"knots", numbers},
               {"multiplicities", {{"type", "array"}, {"items", {{"type", "integer"}, {"minimum", 1}}}}},
               {"points", {{"type", "array"}, {"items", numbers}}},
               {"weights", numbers}}}};
  json nurbs_nd = nurbs;
  nurbs_nd["required"].push_back("space");
  nurbs_nd["properties"]["space"] = {{"enum", {"pose", "joint"}}};
  return {{"schemas",
           {{"Vector", of_three},
            {"Frame",
             {{"type", "object"},
              {"required", {"p"}},
              {"properties", {{"p", of_three}, {"q", of_four}, {"axis", of_three}}}}},
            {"Joints", {{"type", "object"}, {"required", {"joints"}}, {"properties", {{"joints", numbers}}}}},
            {"Nurbs", nurbs},
            {"NurbsND", nurbs_nd}}}};
}

json method_to_json(const Method& entry) {
  json params = json::array();
  for (const ParameterSpec& parameter : entry.parameters) params.push_back(parameter_to_json(parameter));
  json result{{"name", entry.name},
              {"summary", entry.meaning},
              {"params", params},
              {"paramStructure", "either"},
              {"result", result_to_json(entry)},
              {"x-origin", to_string(entry.origin)},
              {"x-permission", to_string(entry.permission)},
              {"x-effect", to_string(entry.effect)}};
  if (entry.harmless) {
    result["x-no-effect-with"] = {{entry.parameters[entry.harmless->parameter].name, entry.harmless->value}};
  }
  return result;
}

}  // namespace

const json& openrpc_document() {
  static const json kDocument = [] {
    json methods = json::array();
    for (const Method& entry : method_table()) methods.push_back(method_to_json(entry));
    return json{{"openrpc", "1.2.6"},
                {"info", {{"title", "RMAC gateway"}, {"version", RMAC_VERSION}}},
                {"methods", methods},
                {"components", components()}};
  }();
  return kDocument;
}

}  // namespace rmac::gateway
