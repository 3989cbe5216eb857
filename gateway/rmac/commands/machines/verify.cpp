#include <fmt/format.h>

#include "gateway/configuration/configuration.hpp"
#include "gateway/device_driver_manager/device_tree.hpp"
#include "gateway/rmac/commands/machines/registrations.hpp"
#include "gateway/rmac/wire/authority.hpp"
#include "gateway/verification/verification.hpp"

namespace rmac::cli {
namespace {

namespace fs = std::filesystem;

struct VerifyOptions {
  std::string machine;             ///< its name, or the path of its folder or of its device.json
  fs::path device_tree;            ///< with a path; empty: the installation's
  std::optional<double> period_s;  ///< with a path
};

Result<> show(const verifier::Report& report, bool json) {
  fmt::print("{}", json ? verifier::to_json(report).dump() + "\n" : verifier::to_text(report));
  if (report.passed()) return {};
  return fail(fmt::format("{} is refused: {}", report.mechanism, report.refusal()));
}

/// Modules that are not beside the file are looked for among the shared ones of the device tree.
Result<> verify_files(const std::string& path, const fs::path& device_tree, double period_s, bool json) {
  const auto folders = gateway::default_folders();
  const fs::path modules = (device_tree.empty() ? folders.device_tree : device_tree) / "modules";
  const gateway::Verification verification(
      {.program = folders.verifier, .verdicts = {}, .module_folders = {modules}, .period_s = period_s});
  const auto report = gateway::find_device_json(path, folders.device_tree).and_then([&](const fs::path& file) {
    return verification.verify(file);
  });
  return report ? show(*report, json) : fail(report.error().message);
}

Result<> verify_machine(Connection& connection, const std::string& name, bool json) {
  return with_authority(connection, [&]() -> Result<> {
    const auto report = connection.call("Device.Verify", {{"Name", name}});
    return report ? show(verifier::report_of(*report), json) : tl::unexpected(report.error());
  });
}

}  // namespace

void add_verify(Command& rmac) {
  const auto options = std::make_shared<VerifyOptions>();
  Command verify =
      rmac.add("verify", "check a machine's modules, each in a process of its own; exit code 1 when it is refused");
  verify
      .option("NAME", &options->machine,
              "as `rmac machines` lists it; or the path of its folder or its device.json, which needs no appliance")
      .required();
  verify.option("--device-tree", &options->device_tree,
                "with a path: the tree whose shared modules it may name; the installation's unless given");
  verify
      .option("--period", &options->period_s,
              "with a path: cycle of the servo loop, s; 0.001 unless given. An appliance has its own (period_s in "
              "rmacd.json)")
      .within(0.0001, 0.1);
  verify.does([options](Call& call) -> Result<> {
    if (gateway::is_path_of_machine(options->machine))
      return verify_files(options->machine, options->device_tree,
                          options->period_s.value_or(gateway::Verification::Options{}.period_s), call.json());
    if (options->period_s)
      return fail("--period: an appliance verifies at its own cycle; give the path of the machine");
    return call.appliance().and_then(
        [&](Connection* appliance) { return verify_machine(*appliance, options->machine, call.json()); });
  });
}

}  // namespace rmac::cli
