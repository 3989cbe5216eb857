#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <optional>

#include "gateway/tools/tool.hpp"

namespace rmac::gateway {

/// A mechanism's tool table, as its file holds it.
struct ToolTable {
  std::map<int, Tool> tools;             ///< by number
  std::optional<int> mounted = kNoTool;  ///< none: not known
};

/// Reads a tool table and checks it against its schema; a file that is not there is an empty table. An error names
/// file, key, value and range.
[[nodiscard]] Expected<ToolTable> read_tool_table(const std::filesystem::path& file);
/// Puts the table in place of the file in one step: whoever reads, after a crash too, finds the old one or the new one.
[[nodiscard]] Expected<> write_tool_table(const std::filesystem::path& file, const ToolTable& table);

/// Keeps the tool table of the mechanism in force in `<folder>/<mechanism>.json`. Any thread: a large move is checked
/// against it beside the gateway thread, which writes down what is in the spindle meanwhile.
class ToolRack {
 public:
  enum class Keeps {
    Everything,
    Tools,    ///< not what is in the spindle: virtual mode changes no tool
    Nothing,  ///< a simulation leaves no trace
  };

  /// Without a folder every mechanism begins with an empty table.
  explicit ToolRack(std::filesystem::path folder) : folder_(std::move(folder)) {}

  [[nodiscard]] Expected<ToolTable> read(const std::string& mechanism) const;
  /// From now on this is the table.
  void adopt(const std::string& mechanism, ToolTable table, Keeps keeps);

  [[nodiscard]] std::map<int, Tool> tools() const;
  [[nodiscard]] std::optional<Tool> tool(int number) const;
  [[nodiscard]] std::optional<int> mounted() const;
  [[nodiscard]] Expected<Tool> find(int number, const char* function) const;

  // Where the file cannot be written nothing changes.
  [[nodiscard]] Expected<> set(const Tool& tool);
  [[nodiscard]] Expected<> remove(int number);
  [[nodiscard]] Expected<> set_mounted(std::optional<int> number);

 private:
  /// Below the lock.
  [[nodiscard]] Expected<> keep(ToolTable table, bool written_down);

  mutable std::mutex mutex_;
  const std::filesystem::path folder_;
  std::filesystem::path file_;
  Keeps keeps_ = Keeps::Nothing;
  ToolTable table_;
  std::optional<int> kept_mounted_ = kNoTool;  ///< as the file has it
};

}  // namespace rmac::gateway
