#include "gateway/verification/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rmac::verifier {
namespace {

using Json = nlohmann::json;

std::string title(const ModuleReport& module) {
  return module.module.empty() ? module.role : fmt::format("{} {}", module.role, module.module);
}

Json to_json(const ModuleReport& module) {
  Json json{{"role", module.role},   {"module", module.module}, {"build_id", module.build_id},
            {"ok", !module.refusal}, {"passed", module.passed}, {"not_checked", module.not_checked},
            {"cpu_s", module.cpu_s}};
  if (module.refusal) {
    json["counter_example"] = to_json(*module.refusal);
    json["refusal"] = to_string(*module.refusal);
  }
  return json;
}

ModuleReport module_of(const Json& json) {
  ModuleReport module;
  module.role = json.at("role");
  module.module = json.at("module");
  module.build_id = json.at("build_id");
  module.passed = json.at("passed").get<std::vector<std::string>>();
  module.not_checked = json.at("not_checked").get<std::vector<std::string>>();
  module.cpu_s = json.at("cpu_s");
  if (json.contains("counter_example")) module.refusal = example_of(json["counter_example"]);
  return module;
}

}  // namespace

bool Report::passed() const noexcept {
  return std::none_of(modules.begin(), modules.end(), [](const ModuleReport& module) { return bool(module.refusal); });
}

std::string Report::refusal() const {
  for (const ModuleReport& module : modules) {
    if (module.refusal) return fmt::format("{}: {}", title(module), to_string(*module.refusal));
  }
  return "";
}

Json to_json(const CounterExample& example) {
  // A JSON number cannot be NaN; a text can.
  Json values = Json::object();
  for (const NamedNumbers& value : example.values) {
    Json numbers = Json::array();
    for (const double number : value.numbers) {
      numbers.push_back(std::isfinite(number) ? Json(number) : Json(fmt::format("{}", number)));
    }
    values[value.name] = std::move(numbers);
  }
  return {{"check", example.check}, {"what", example.what}, {"sample", example.sample}, {"values", std::move(values)}};
}

CounterExample example_of(const Json& json) {
  CounterExample example{json.at("check"), json.at("what"), json.at("sample"), {}};
  for (const auto& [name, numbers] : json.at("values").items()) {
    NamedNumbers value{name, {}};
    for (const Json& number : numbers) {
      value.numbers.push_back(number.is_number() ? number.get<double>() : std::stod(number.get<std::string>()));
    }
    example.values.push_back(std::move(value));
  }
  return example;
}

Json to_json(const Report& report) {
  Json modules = Json::array();
  for (const ModuleReport& module : report.modules) modules.push_back(to_json(module));
  Json json{{"mechanism", report.mechanism}, {"file", report.file}, {"ok", report.passed()},
            {"samples", report.samples},     {"seed", report.seed}, {"modules", std::move(modules)}};
  if (!report.passed()) json["refusal"] = report.refusal();
  return json;
}

Report report_of(const Json& json) {
  Report report;
  report.mechanism = json.at("mechanism");
  report.file = json.at("file");
  report.samples = json.at("samples");
  report.seed = json.at("seed");
  for (const Json& module : json.at("modules")) report.modules.push_back(module_of(module));
  return report;
}

std::string to_text(const Report& report) {
  std::string text = fmt::format("{} ({})\n", report.mechanism, report.file);
  for (const ModuleReport& module : report.modules) {
    text += fmt::format("  {}{}, {:.2f} s of CPU time\n", title(module),
                        module.build_id.empty() ? "" : fmt::format(", build {}", module.build_id), module.cpu_s);
    for (const std::string& check : module.passed) text += fmt::format("    ok           {}\n", check);
    for (const std::string& check : module.not_checked) text += fmt::format("    not checked  {}\n", check);
    if (module.refusal) text += fmt::format("    REFUSED      {}\n", to_string(*module.refusal));
  }
  text += report.passed() ? fmt::format("{} may go live\n", report.mechanism)
                          : fmt::format("{} is refused\n", report.mechanism);
  return text;
}

}  // namespace rmac::verifier
