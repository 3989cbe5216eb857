#include "gateway/rmac/commands/tools/registrations.hpp"
#include "gateway/rmac/measuring/tool_table.hpp"
#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

namespace {

/// Without a number, the tool that was asked for.
Result<> confirm_tool(Connection& connection, std::optional<int> number) {
  if (!number) {
    const auto answer = read_tools(connection);
    if (!answer) return tl::unexpected(answer.error());
    if (answer->at("Wanted").is_null()) {
      return fail("no tool change is under way; to say which tool is in the spindle, give its number");
    }
    number = answer->at("Wanted").get<int>();
  }
  return connection.command(kConfirmToolChange, {{"ToolNumber", *number}});
}

}  // namespace

void add_confirm(Command& rmac) {
  const auto number = std::make_shared<std::optional<int>>();
  Command confirm = rmac.add("confirm", "say that the tool that was asked for is in the spindle");
  confirm.option("NUMBER", number.get(), "the tool that is there; 0: none; the one asked for unless given")
      .within(0, 9999);
  confirm.does(with_appliance([number](Connection& appliance, bool) { return confirm_tool(appliance, *number); }));
}

}  // namespace rmac::cli
