#pragma once

#include <string_view>

#include "gateway/controller/controller.hpp"
#include "gateway/tools/tool.hpp"

namespace rmac::cli {

/// What is in the spindle, as the tool table has it; `kNoTool` where it is empty or nobody knows.
[[nodiscard]] gateway::Tool mounted_tool(gateway::Controller& controller);

/// Whether a request may put another tool in the spindle, or say otherwise of the one that is in it.
[[nodiscard]] inline bool may_change_tool(std::string_view method) noexcept {
  return method.ends_with("Tool") || method.ends_with("ToolChange");
}

}  // namespace rmac::cli
