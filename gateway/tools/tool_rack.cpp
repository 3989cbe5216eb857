#include "gateway/tools/tool_rack.hpp"

#include <fmt/format.h>

#include <system_error>

#include "gateway/files/whole_file.hpp"
#include "gateway/json/json_document.hpp"
#include "gateway/json/schemas.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::gateway {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

/// As the schema has it.
constexpr std::size_t kMostTools = 2000;

// The schema has checked types, ranges and which keys there are.
Expected<Tool> read_tool(const Json& entry) {
  Tool tool;
  tool.number = entry["ToolNumber"];
  tool.name = entry.value("Name", "");
  tool.length_mm = entry["Length"];
  tool.radius_mm = entry.value("Radius", 0.0);
  tool.max_rpm = entry.value("MaxRPM", 0.0);
  tool.max_torque_nm = entry.value("MaxTorque", 0.0);
  tool.needs_spindle = entry.value("NeedsSpindle", true);
  if (entry.contains("Frame")) {
    entry["Frame"]["p"].get_to(tool.frame.p);
    entry["Frame"]["q"].get_to(tool.frame.q);
  }
  if (entry.contains("Shape")) {
    auto shape = read_tool_shape(entry["Shape"], tool.length_mm);
    if (!shape) return tl::unexpected(shape.error());
    tool.shape = std::move(*shape);
  }
  return check_frame(tool.frame, "Frame").map([&] {
    tool.frame = normalized(tool.frame);
    return tool;
  });
}

Json tool_json(const Tool& tool) {
  Json entry{{"ToolNumber", tool.number},
             {"Name", tool.name},
             {"Length", tool.length_mm},
             {"Radius", tool.radius_mm},
             {"Frame", {{"p", tool.frame.p}, {"q", tool.frame.q}}},
             {"MaxRPM", tool.max_rpm},
             {"MaxTorque", tool.max_torque_nm},
             {"NeedsSpindle", tool.needs_spindle}};
  if (tool.shape) entry["Shape"] = to_json(*tool.shape);
  return entry;
}

}  // namespace

Frame tip_on_interface(const Tool& tool) {
  return compose(tool.frame, {{0, 0, -tool.length_mm}, {1, 0, 0, 0}});
}

Expected<ToolTable> read_tool_table(const fs::path& file) {
  std::error_code code;
  if (!fs::exists(file, code) && !code) return ToolTable{};
  static const JsonSchema kSchema(tools_schema_text());
  const auto document = read_json_document(file, kSchema);
  if (!document) return tl::unexpected(document.error());
  ToolTable table;
  const Json& mounted = (*document)["Mounted"];
  table.mounted = mounted.is_null() ? std::nullopt : std::optional(mounted.get<int>());
  for (std::size_t i = 0; i < (*document)["Tools"].size(); ++i) {
    const auto wrong = [&](const std::string& what) {
      return failure(MinorCode::InvalidParameterValue, fmt::format("{}: /Tools/{}: {}", file.string(), i, what));
    };
    auto tool = read_tool((*document)["Tools"][i]);
    if (!tool) return wrong(tool.error().message);
    const int number = tool->number;
    if (!table.tools.emplace(number, std::move(*tool)).second) {
      return wrong(fmt::format("ToolNumber {} stands twice; give each tool a number of its own", number));
    }
  }
  if (table.mounted && *table.mounted != kNoTool && !table.tools.contains(*table.mounted)) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: /Mounted is {}, and Tools holds no such ToolNumber; allowed are these, 0 for an "
                               "empty spindle, and null for one that nobody knows",
                               file.string(), *table.mounted));
  }
  return table;
}

Expected<> write_tool_table(const fs::path& file, const ToolTable& table) {
  Json tools = Json::array();
  for (const auto& [number, tool] : table.tools) tools.push_back(tool_json(tool));
  const Json document{{"Mounted", table.mounted ? Json(*table.mounted) : Json()}, {"Tools", std::move(tools)}};
  std::error_code code;
  fs::create_directories(file.parent_path(), code);
  if (code) {
    return failure(MinorCode::Other,
                   fmt::format("{}: cannot be made: {}", file.parent_path().string(), code.message()));
  }
  return write_whole(file, document.dump(2) + "\n");
}

Expected<ToolTable> ToolRack::read(const std::string& mechanism) const {
  if (folder_.empty()) return ToolTable{};
  return read_tool_table(folder_ / (mechanism + ".json"));
}

void ToolRack::adopt(const std::string& mechanism, ToolTable table, Keeps keeps) {
  const std::lock_guard lock(mutex_);
  file_ = folder_.empty() ? fs::path() : folder_ / (mechanism + ".json");
  table_ = std::move(table);
  kept_mounted_ = table_.mounted;
  keeps_ = file_.empty() ? Keeps::Nothing : keeps;
}

std::map<int, Tool> ToolRack::tools() const {
  const std::lock_guard lock(mutex_);
  return table_.tools;
}

std::optional<Tool> ToolRack::tool(int number) const {
  const std::lock_guard lock(mutex_);
  const auto found = table_.tools.find(number);
  return found == table_.tools.end() ? std::nullopt : std::optional(found->second);
}

std::optional<int> ToolRack::mounted() const {
  const std::lock_guard lock(mutex_);
  return table_.mounted;
}

Expected<Tool> ToolRack::find(int number, const char* function) const {
  if (const auto found = tool(number)) return *found;
  std::string known;
  for (const auto& [each, entry] : tools()) known += fmt::format("{}{}", known.empty() ? "" : ", ", each);
  return failure(MinorCode::InvalidParameterValue,
                 fmt::format("{}: there is no tool {} in the tool table; {}", function, number,
                             known.empty() ? "it is empty: add tools with RMAC_CAM.SetTool"
                                           : "there are " + known + ", and 0 for an empty spindle"));
}

Expected<> ToolRack::keep(ToolTable table, bool written_down) {
  if (written_down) {
    ToolTable file = table;
    if (keeps_ == Keeps::Tools) file.mounted = kept_mounted_;
    if (auto written = write_tool_table(file_, file); !written) return written;
    kept_mounted_ = file.mounted;
  }
  table_ = std::move(table);
  return {};
}

Expected<> ToolRack::set(const Tool& tool) {
  const std::lock_guard lock(mutex_);
  ToolTable next = table_;
  if (next.tools.size() >= kMostTools && !next.tools.contains(tool.number)) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("SetTool: the table holds {} tools, as many as it can; remove one first", kMostTools));
  }
  Tool& entry = next.tools[tool.number];
  std::optional<ToolShape> shape = tool.shape ? tool.shape : std::move(entry.shape);
  entry = tool;
  entry.shape = std::move(shape);
  return keep(std::move(next), keeps_ != Keeps::Nothing);
}

Expected<> ToolRack::remove(int number) {
  if (auto found = find(number, "RemoveTool"); !found) return tl::unexpected(found.error());
  const std::lock_guard lock(mutex_);
  if (number == table_.mounted || number == kept_mounted_) {
    return failure(MinorCode::Other, fmt::format("RemoveTool: tool {} is in the spindle; change it first", number));
  }
  ToolTable next = table_;
  next.tools.erase(number);
  return keep(std::move(next), keeps_ != Keeps::Nothing);
}

Expected<> ToolRack::set_mounted(std::optional<int> number) {
  const std::lock_guard lock(mutex_);
  if (number == table_.mounted) return {};
  ToolTable next = table_;
  next.mounted = number;
  return keep(std::move(next), keeps_ == Keeps::Everything);
}

}  // namespace rmac::gateway
