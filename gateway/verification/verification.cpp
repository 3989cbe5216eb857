#include "gateway/verification/verification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include "gateway/device_database/device_database.hpp"
#include "gateway/device_database/device_json.hpp"
#include "gateway/files/content_hash.hpp"
#include "gateway/files/whole_file.hpp"
#include "gateway/modules/module_loader.hpp"
#include "gateway/processes/child_process.hpp"
#include "gateway/processes/temporary_folder.hpp"
#include "rmac/sdk/servo_law_names.hpp"

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::set<std::string> modules_of(const sdk::DeviceObject& device) {
  std::set<std::string> names{device.device_driver, device.kinematics.name, device.actuator_map.name};
  for (std::size_t j = 0; j < device.joint_count_with_held(); ++j) {
    names.insert(sdk::servo_law_module(sdk::joint_at(device, j).servo_law.name));
  }
  names.erase("");  // of a joint whose drive closes the loop itself
  return names;
}

/// One file a verdict: a mechanism may go back to a build that passed.
fs::path verdict_file(const fs::path& folder, const std::string& mechanism, const std::string& fingerprint) {
  return folder / (mechanism + "@" + fingerprint + ".json");
}

/// The verdicts on one mechanism beyond the few that were needed last go.
void forget_old(const fs::path& folder, const std::string& mechanism) {
  constexpr std::size_t kKept = 16;
  std::error_code ignored;
  std::vector<std::pair<fs::file_time_type, fs::path>> verdicts;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (!entry.path().filename().string().starts_with(mechanism + "@")) continue;
    verdicts.emplace_back(entry.last_write_time(ignored), entry.path());
  }
  std::sort(verdicts.rbegin(), verdicts.rend());
  for (std::size_t i = kKept; i < verdicts.size(); ++i) fs::remove(verdicts[i].second, ignored);
}

/// A verdict that cannot be kept costs time at the next loading, and nothing else.
void keep(const fs::path& folder, const verifier::Report& report, const std::string& fingerprint) {
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  const fs::path file = verdict_file(folder, report.mechanism, fingerprint);
  (void)write_whole(file, verifier::to_json(report).dump(2) + "\n");
  forget_old(folder, report.mechanism);
}

}  // namespace

Verification::Subject Verification::beside(const fs::path& device_json) const {
  Subject subject{device_json, {device_json.parent_path()}};
  subject.folders.insert(subject.folders.end(), options_.module_folders.begin(), options_.module_folders.end());
  return subject;
}

std::string Verification::period() const {
  return fmt::format("{}", options_.period_s);
}

std::string Verification::fingerprint(const Subject& subject, const sdk::DeviceObject& device) const {
  const ModuleLoader loader(subject.folders);
  ContentHash hash;
  hash.add(period());
  if (!hash.add_file(options_.program) || !hash.add_file(subject.device_json)) return "";
  for (const std::string& name : modules_of(device)) {
    const auto file = loader.find_file("", name, ".so", "module");
    hash.add(name);
    if (!file || !hash.add_file(*file)) return "";
  }
  // Interfaces are modules only where they are not built in.
  for (const sdk::ModuleChoice* interface : {&device.digital_control_interface, &device.digital_io_interface}) {
    if (const auto file = loader.find_file("", interface->name, ".so", "module"); file && !hash.add_file(*file)) {
      return "";
    }
  }
  return hash.text();
}

Expected<verifier::Report> Verification::verify(const fs::path& device_json) const {
  return verify(beside(device_json));
}

Expected<verifier::Report> Verification::verify(const Subject& subject) const {
  const auto device = read_device_database(subject.device_json);
  if (!device) return tl::unexpected(device.error());
  // Before it runs: what changes meanwhile is not what passed.
  const std::string before = fingerprint(subject, *device);
  std::vector<std::string> words{options_.program.string(), subject.device_json.string(), "--json", "--period",
                                 period()};
  for (const fs::path& folder : subject.folders) {
    words.emplace_back("--modules");
    words.push_back(folder.string());
  }
  const auto done = run_child(words, options_.patience, cancelled_);
  if (!done) return tl::unexpected(done.error());
  const Json json = Json::parse(done->output, nullptr, false);
  if (json.is_discarded()) {
    std::string why = done->complaint;
    while (!why.empty() && why.back() == '\n') why.pop_back();
    return failure(
        MinorCode::InvalidParameterValue,
        why.empty() ? fmt::format("the verifier {} ended without a report", options_.program.string()) : why);
  }
  verifier::Report report = verifier::report_of(json);
  if (report.passed() && !before.empty() && !options_.verdicts.empty()) keep(options_.verdicts, report, before);
  return report;
}

Expected<> Verification::require(const fs::path& device_json) const {
  return require(beside(device_json));
}

Expected<> Verification::require(const sdk::DeviceObject& device, const fs::path& folder) const {
  const TemporaryFolder room("draft");
  if (room.path().empty()) {
    return failure(MinorCode::Other,
                   "no folder can be made to verify the draft in; see that the system's folder for "
                   "temporary files ($TMPDIR, or /tmp) is there and has room");
  }
  Subject subject = beside(room.path() / "device.json");
  subject.folders.front() = folder;
  std::ofstream(subject.device_json) << to_device_json(device).dump(2) << '\n';
  return require(subject).map_error([&](const Error& error) {
    // The file is nobody's to look into.
    const std::string file = subject.device_json.string();
    std::string message = error.message;
    if (const auto at = message.find(file); at != std::string::npos) message.replace(at, file.size(), "the draft");
    return Error{error.code, message};
  });
}

Expected<> Verification::require(const Subject& subject) const {
  const auto device = read_device_database(subject.device_json);
  if (!device) return tl::unexpected(device.error());
  const std::string now = fingerprint(subject, *device);
  std::error_code ignored;
  if (!now.empty() && !options_.verdicts.empty()) {
    const fs::path verdict = verdict_file(options_.verdicts, device->name, now);
    if (fs::exists(verdict, ignored)) {
      fs::last_write_time(verdict, fs::file_time_type::clock::now(), ignored);
      return {};
    }
  }
  const auto report = verify(subject);
  if (!report) return tl::unexpected(report.error());
  if (report->passed()) return {};
  return failure(MinorCode::InvalidParameterValue, "its verification refuses it: " + report->refusal());
}

}  // namespace rmac::gateway
