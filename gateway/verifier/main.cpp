#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>

#include "gateway/configuration/configuration.hpp"
#include "gateway/device_database/device_database.hpp"
#include "gateway/mechanism/device_check.hpp"
#include "gateway/processes/rights.hpp"
#include "gateway/verifier/supervisor.hpp"

namespace {

using namespace rmac;
namespace fs = std::filesystem;

constexpr int kPassed = 0, kRefused = 1, kUsage = 2;

struct Wishes {
  std::string device_json;
  std::vector<std::string> module_folders;
  int samples = verifier::kSamples;
  std::uint64_t seed = 1;
  double period_s = 0.001;
  bool json = false;
};

Expected<verifier::Report> verify(const Wishes& wishes) {
  const fs::path file = fs::is_directory(wishes.device_json) ? fs::path(wishes.device_json) / "device.json"
                                                             : fs::path(wishes.device_json);
  const auto database = gateway::read_device_json(file);
  if (!database) return tl::unexpected(database.error());
  const sdk::DeviceObject* const device = &database->device;
  if (auto sound = gateway::check_device(*device); !sound) return tl::unexpected(sound.error());
  std::vector<fs::path> folders{fs::absolute(file).parent_path()};
  folders.insert(folders.end(), wishes.module_folders.begin(), wishes.module_folders.end());
  if (wishes.module_folders.empty()) folders.push_back(gateway::default_folders().device_tree / "modules");

  verifier::Report report{
      device->name, fs::absolute(file).lexically_normal().string(), wishes.samples, wishes.seed, {}};
  const verifier::Task task{*device,
                            database->bodies.chain,
                            gateway::ModuleLoader(folders, gateway::ModuleLoader::Opens::Whichever),
                            wishes.samples,
                            wishes.seed,
                            wishes.period_s};
  for (const verifier::Job& job : verifier::jobs_for(*device)) {
    // All modules together are run once each of them is fit for it.
    if (job.module.empty() && !report.passed()) continue;
    report.modules.push_back(verifier::supervise(job, task));
  }
  return report;
}

int run(const Wishes& wishes) {
  spdlog::set_level(spdlog::level::off);
  const auto report = verify(wishes);
  if (!report) {
    fmt::print(stderr, "rmac-verify: {}\n", report.error().message);
    return kRefused;
  }
  if (wishes.json) {
    fmt::print("{}\n", verifier::to_json(*report).dump());
  } else {
    fmt::print("{}", verifier::to_text(*report));
  }
  return report->passed() ? kPassed : kRefused;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Checks a mechanism's modules, each in a process of its own, before they go live."};
  app.set_version_flag("--version", RMAC_VERSION);
  Wishes wishes;
  app.add_option("FILE", wishes.device_json, "the mechanism's device.json, or the folder that holds it")->required();
  app.add_option("--modules", wishes.module_folders,
                 "a folder with modules that are not beside it; the installation's shared ones unless given");
  app.add_option("--samples", wishes.samples, "joint vectors a check takes")
      ->check(CLI::Range(1, 100'000'000))
      ->capture_default_str();
  app.add_option("--seed", wishes.seed, "of what is taken at random")->capture_default_str();
  app.add_option("--period", wishes.period_s, "cycle of the servo loop, s (period_s in rmacd.json)")
      ->check(CLI::Range(0.0001, 0.1))
      ->capture_default_str();
  app.add_flag("--json", wishes.json, "print for programs");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kPassed : kUsage;
  }
  gateway::offer_memory();
  try {
    return run(wishes);
  } catch (const std::exception& error) {
    fmt::print(stderr, "rmac-verify: {}\n", error.what());
    return kRefused;
  }
}
