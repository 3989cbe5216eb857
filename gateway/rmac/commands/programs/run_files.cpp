#include "gateway/rmac/commands/programs/run_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

namespace rmac::cli {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(const gateway::Setup& setup) {
  std::vector<fs::path> files;
  const auto add = [&files](const gateway::Body& body) {
    if (const auto* const mesh = std::get_if<gateway::MeshShape>(&body.shape)) files.push_back(mesh->file);
  };
  if (setup.stock) add(*setup.stock);
  if (setup.part) add(*setup.part);
  std::ranges::for_each(setup.fixtures, add);
  return files;
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) files.push_back(entry.path());
  return files;
}

Result<> refuse_used(const std::string& file, const char* option, const std::vector<fs::path>& used) {
  std::error_code none;
  for (const fs::path& other : used) {
    // Two names of one file, or one name of a file that is not there yet.
    const bool same = fs::equivalent(file, other, none) ||
                      (!other.empty() && fs::weakly_canonical(file, none) == fs::weakly_canonical(other, none));
    if (same) return fail(fmt::format("{}: this run uses this file; choose another name with {}", file, option));
  }
  return {};
}

}  // namespace rmac::cli
