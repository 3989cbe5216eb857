#include "gateway/rmac/simulator/mounted_tool.hpp"

namespace rmac::cli {

gateway::Tool mounted_tool(gateway::Controller& controller) {
  const int number = controller.tools().tools_now().mounted.value_or(gateway::kNoTool);
  gateway::Tool tool{.number = gateway::kNoTool};
  if (const auto tools = controller.tools().tools(); tools) {
    for (const gateway::Tool& each : *tools) {
      if (each.number == number) tool = each;
    }
  }
  // One that the table does not have is in there all the same.
  tool.number = number;
  return tool;
}

}  // namespace rmac::cli
