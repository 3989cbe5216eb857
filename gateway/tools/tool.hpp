#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gateway/tools/tool_shape.hpp"
#include "rmac/motion/error.hpp"
#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::gateway {

/// An empty spindle: its tip is the tool interface.
inline constexpr int kNoTool = 0;
inline constexpr int kLargestToolNumber = 9999;

/// One tool as the tool table has it. mm, rpm, N·m.
struct Tool {
  int number = 1;
  std::string name{};
  double length_mm = 0;
  double radius_mm = 0;
  Frame frame{};              ///< where the tool sits on the tool interface, before its length: an angle head's turn
  double max_rpm = 0;         ///< 0: the spindle's own bound alone
  double max_torque_nm = 0;   ///< that spindle 0 may measure with it; 0: not given
  bool needs_spindle = true;  ///< it cuts only while the spindle turns; a probe or a drag knife does not need that
  std::optional<ToolShape> shape{};  ///< none: nothing is known of its collisions
};

/// The tip's pose on the tool interface: down the tool's own axis by its length.
[[nodiscard]] Frame tip_on_interface(const Tool& tool);

/// What is in the spindle, and what is to be.
struct ToolsNow {
  std::optional<int> mounted = kNoTool;  ///< none: not known, because a change was not completed
  std::optional<int> wanted;             ///< by the first change that is queued
  std::optional<int> last;               ///< by the last one
  bool changing = false;                 ///< a change has begun
  std::string prompt;                    ///< what a person is to do; empty: nothing
  /// As the spindles are told to turn when all that is queued is done.
  std::array<double, kMaxSpindles> spindle_rpm{};
};

/// The tools of the mechanism in force. Gateway thread; `tools_now` from beside it too.
class ToolPort {
 public:
  virtual ~ToolPort() = default;
  /// In the order of their numbers.
  [[nodiscard]] virtual Expected<std::vector<Tool>> tools() const = 0;
  [[nodiscard]] virtual ToolsNow tools_now() const = 0;
  /// Adds a tool or replaces the one of its number, whose shape it keeps unless it has its own; of the tool in the
  /// spindle at rest only, and in force at once.
  virtual Expected<> set_tool(const Tool& tool) = 0;
  virtual Expected<> remove_tool(int number) = 0;
  /// Queues a change behind the moves that are queued; moves that follow are with the new tool. `kNoTool` takes the
  /// tool out.
  virtual Expected<> change_tool(int number) = 0;
  /// A person says that this tool is in the spindle: as asked, or after a change that was not completed.
  virtual Expected<> confirm_tool(int number) = 0;
};

}  // namespace rmac::gateway
