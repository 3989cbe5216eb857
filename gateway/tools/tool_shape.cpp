#include "gateway/tools/tool_shape.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

namespace rmac::gateway {
namespace {

using Json = nlohmann::json;

constexpr double kSlack_mm = 1e-6;
constexpr std::array kBodies{std::pair{"HM", BodyMaterial::Carbide}, std::pair{"HSS", BodyMaterial::HighSpeedSteel}};

double height(const std::vector<ConeShape>& sections) {
  double sum = 0;
  for (const ConeShape& section : sections) sum += section.height;
  return sum;
}

std::vector<ConeShape> sections(const Json& list) {
  std::vector<ConeShape> result;
  for (const Json& entry : list) {
    const std::string& kind = entry.begin().key();
    const Json& of = entry.begin().value();
    const double radius = of.at("Radius");
    result.push_back({radius, kind == "Cylinder" ? radius : of.value("TopRadius", 0.0), of.at("Height")});
  }
  return result;
}

Json sections_json(const std::vector<ConeShape>& sections) {
  Json list = Json::array();
  for (const ConeShape& s : sections) {
    if (s.bottom_radius == s.top_radius) {
      list.push_back({{"Cylinder", {{"Radius", s.bottom_radius}, {"Height", s.height}}}});
    } else {
      list.push_back({{"Cone", {{"Radius", s.bottom_radius}, {"TopRadius", s.top_radius}, {"Height", s.height}}}});
    }
  }
  return list;
}

std::string check(const ToolShape& shape, double length_mm) {
  if (shape.re > shape.dc / 2 + kSlack_mm) {
    return fmt::format("/Shape/RE is {}; allowed is at most half of DC, {}", shape.re, shape.dc / 2);
  }
  if (shape.apmx > shape.lcf + kSlack_mm) {
    return fmt::format("/Shape/APMX is {}; allowed is at most LCF, {}", shape.apmx, shape.lcf);
  }
  if (shape.lcf > shape.oal + kSlack_mm) {
    return fmt::format("/Shape/LCF is {}; allowed is at most OAL, {}", shape.lcf, shape.oal);
  }
  if (shape.re > shape.lcf + kSlack_mm) {
    return fmt::format("/Shape/LCF is {}; allowed is RE, {}, or more", shape.lcf, shape.re);
  }
  if (const double shank = height(shape.shank); shank > 0 && shape.lcf + shank < shape.oal - kSlack_mm) {
    return fmt::format("/Shape/Shank is {} mm high; between LCF and OAL there are {}", shank, shape.oal - shape.lcf);
  }
  if (height(shape.holder) > length_mm + kSlack_mm) {
    return fmt::format("/Shape/Holder is {} mm high, and the tool's Length, with its holder, is {}",
                       height(shape.holder), length_mm);
  }
  if (const double reached = shape.oal + height(shape.holder); reached < length_mm - kSlack_mm) {
    return fmt::format("/Shape: OAL and Holder make {} mm, and the tool's Length is {}: they leave a gap", reached,
                       length_mm);
  }
  return {};
}

}  // namespace

double ToolShape::holder_begins(double tool_length_mm) const {
  return tool_length_mm - height(holder);
}

Expected<ToolShape> read_tool_shape(const Json& object, double tool_length_mm) {
  ToolShape shape;
  shape.dc = object.at("DC");
  shape.re = object.value("RE", 0.0);
  shape.lcf = object.at("LCF");
  shape.apmx = object.value("APMX", shape.lcf);
  shape.oal = object.at("OAL");
  shape.zefp = object.value("ZEFP", 0);
  shape.fha = object.value("FHA", 0.0);
  shape.shank = sections(object.value("Shank", Json::array()));
  shape.holder = sections(object.value("Holder", Json::array()));
  for (const auto& [code, body] : kBodies) {
    if (object.value("BMC", "") == code) shape.bmc = body;
  }
  for (const Json& mode : object.value("Modes", Json::array())) {
    shape.modes.push_back({mode.at("Frequency"), mode.at("DampingRatio"), mode.at("Stiffness")});
  }
  // A tool of which nothing else is said goes on as thick as it cuts.
  if (shape.shank.empty() && shape.oal > shape.lcf)
    shape.shank.push_back({shape.dc / 2, shape.dc / 2, shape.oal - shape.lcf});
  if (std::string problem = check(shape, tool_length_mm); !problem.empty()) {
    return failure(MinorCode::InvalidParameterValue, std::move(problem));
  }
  return shape;
}

Json to_json(const ToolShape& shape) {
  Json object{{"DC", shape.dc},
              {"RE", shape.re},
              {"APMX", shape.apmx},
              {"LCF", shape.lcf},
              {"OAL", shape.oal},
              {"Shank", sections_json(shape.shank)},
              {"Holder", sections_json(shape.holder)}};
  if (shape.zefp > 0) object["ZEFP"] = shape.zefp;
  if (shape.fha > 0) object["FHA"] = shape.fha;
  for (const auto& [code, body] : kBodies) {
    if (shape.bmc == body) object["BMC"] = code;
  }
  for (const TipMode& mode : shape.modes) {
    object["Modes"].push_back(
        {{"Frequency", mode.frequency_hz}, {"DampingRatio", mode.damping_ratio}, {"Stiffness", mode.stiffness_n_mm}});
  }
  return object;
}

}  // namespace rmac::gateway
