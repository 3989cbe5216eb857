#include <fmt/format.h>

#include "gateway/configuration/configuration.hpp"
#include "gateway/rmac/authority.hpp"
#include "gateway/rmac/commands.hpp"
#include "gateway/verification/verification.hpp"

namespace rmac::cli {
namespace {

namespace fs = std::filesystem;

Result<> show(const verifier::Report& report, bool json) {
  fmt::print("{}", json ? verifier::to_json(report).dump() + "\n" : verifier::to_text(report));
  if (report.passed()) return {};
  return fail(fmt::format("{} is refused: {}", report.mechanism, report.refusal()));
}

}  // namespace

bool is_path(const std::string& machine) {
  return machine.find('/') != std::string::npos || machine.ends_with(".json") || machine == ".";
}

Result<> verify_files(const std::string& path, const fs::path& device_tree, bool json) {
  const auto folders = gateway::default_folders();
  const fs::path modules = (device_tree.empty() ? folders.device_tree : device_tree) / "modules";
  const gateway::Verification verification({.program = folders.verifier, .verdicts = {}, .module_folders = {modules}});
  const fs::path file = fs::is_directory(path) ? fs::path(path) / "device.json" : fs::path(path);
  const auto report = verification.verify(fs::absolute(file).lexically_normal());
  return report ? show(*report, json) : fail(report.error().message);
}

Result<> verify_machine(Connection& connection, const std::string& name, bool json) {
  return with_authority(connection, [&]() -> Result<> {
    const auto report = connection.call("Device.Verify", {{"Name", name}});
    return report ? show(verifier::report_of(*report), json) : tl::unexpected(report.error());
  });
}

}  // namespace rmac::cli
