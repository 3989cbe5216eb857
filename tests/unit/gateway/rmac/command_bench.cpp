#include "unit/gateway/rmac/command_bench.hpp"

#include "gateway/rmac/all_commands.hpp"
#include "gateway/rmac/commands/command_line.hpp"

namespace rmac::cli {

CommandBench::Outcome CommandBench::run_at(const std::string& socket, const std::vector<std::string>& words) {
  std::vector<std::string> line{"rmac", "--socket", socket};
  line.insert(line.end(), words.begin(), words.end());
  std::vector<const char*> pointers;
  for (const std::string& word : line) pointers.push_back(word.c_str());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Outcome outcome;
  outcome.exit_code = carry_out(all_commands(), static_cast<int>(pointers.size()), pointers.data());
  outcome.out = testing::internal::GetCapturedStdout();
  outcome.err = testing::internal::GetCapturedStderr();
  return outcome;
}

void moves_once(FakeAppliance& appliance) {
  appliance.handles("RMAC_CAM.GetState", [&appliance](const nlohmann::json&) {
    appliance.answers("RMAC_CAM.GetState", state());
    return gateway::Answer(state({{"moving", true}}));
  });
}

}  // namespace rmac::cli
