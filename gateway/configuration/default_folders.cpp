#include <cstdlib>
#include <string>
#include <system_error>

#include "gateway/configuration/configuration.hpp"

namespace rmac::gateway {
namespace {

/// systemd gives a colon-separated list; the first is the unit's main one.
std::filesystem::path from_environment(const char* variable, std::filesystem::path otherwise) {
  const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): read once, before threads start
  if (value == nullptr || *value == '\0') return otherwise;
  const std::string list = value;
  return list.substr(0, list.find(':'));
}

/// As etc/install_folders.cmake has it, of the prefix that was installed to; below DESTDIR, where that was given.
std::filesystem::path etc_folder(const std::filesystem::path& prefix) {
  const std::filesystem::path folder = RMAC_SYSCONFDIR;
  if (folder.is_absolute()) return folder / "rmac";
  return (prefix.filename() == "usr" ? prefix.parent_path() : prefix) / folder / "rmac";
}

}  // namespace

DefaultFolders default_folders() {
  std::error_code code;
  const std::filesystem::path program_folder = std::filesystem::read_symlink("/proc/self/exe", code).parent_path();
  const std::filesystem::path build_folder = program_folder.parent_path();
  DefaultFolders folders;
  if (std::filesystem::exists(build_folder / "CMakeCache.txt", code)) {
    folders.device_tree = build_folder / "drivers";
    folders.drives = build_folder / "etc" / "drives";
    folders.materials = build_folder / "etc" / "materials.json";
    folders.state_folder = build_folder / "state";
    folders.runtime_folder = folders.state_folder;
    folders.helpers = build_folder / "helpers";
    folders.verifier = build_folder / "bin" / "rmac-verify";
    folders.searcher = build_folder / "bin" / "rmac-search";
  } else {
    folders.device_tree = (program_folder / RMAC_DRIVERS_FROM_SBIN).lexically_normal();
    folders.drives = etc_folder(program_folder.parent_path()) / "drives";
    folders.materials = folders.drives.parent_path() / "materials.json";
    folders.state_folder = RMAC_STATE_FOLDER;
    folders.runtime_folder = "/run/rmac";
    folders.helpers = (program_folder / RMAC_HELPERS_FROM_SBIN).lexically_normal();
    folders.verifier = folders.helpers / "rmac-verify";
    folders.searcher = folders.helpers / "rmac-search";
  }
  folders.state_folder = from_environment("STATE_DIRECTORY", folders.state_folder);
  folders.runtime_folder = from_environment("RUNTIME_DIRECTORY", folders.runtime_folder);
  return folders;
}

}  // namespace rmac::gateway
