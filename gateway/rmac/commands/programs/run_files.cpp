#include "gateway/rmac/commands/programs/run_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <variant>

namespace rmac::cli {

namespace fs = std::filesystem;

namespace {

/// Where a file is, or will be, whatever its name; links that lead to nothing yet are followed.
fs::path place_of(const fs::path& file) {
  constexpr int kMostLinks = 40;  // as the kernel follows
  std::error_code none;
  fs::path place = fs::absolute(file, none);
  for (int i = 0; i < kMostLinks && fs::is_symlink(place, none); ++i) {
    place = place.parent_path() / fs::read_symlink(place, none);
  }
  return fs::weakly_canonical(place, none);
}

void add_mesh(const gateway::Body& body, std::vector<fs::path>& files) {
  const auto* const mesh = std::get_if<gateway::MeshShape>(&body.shape);
  if (mesh != nullptr && !mesh->surface) files.push_back(mesh->file);
}

}  // namespace

std::vector<fs::path> files_of(const gateway::Setup& setup) {
  std::vector<fs::path> files;
  if (setup.stock) add_mesh(*setup.stock, files);
  if (setup.part) add_mesh(*setup.part, files);
  for (const gateway::Body& fixture : setup.fixtures) add_mesh(fixture, files);
  return files;
}

std::vector<fs::path> files_of(const gateway::MachineBodies& machine) {
  std::vector<fs::path> files;
  for (const gateway::Body& body : machine.bodies) add_mesh(body, files);
  return files;
}

Result<> refuse_unwritable(const std::string& file, const char* option) {
  const fs::path path(file);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code none;
  const bool there = fs::exists(path, none);
  if ((there && (!fs::is_regular_file(path, none) || ::access(file.c_str(), W_OK) != 0)) ||
      ::access(folder.c_str(), W_OK) != 0 || !fs::is_directory(folder, none)) {
    return fail(fmt::format("{}: cannot be written; choose another place with {}", file, option));
  }
  return {};
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) files.push_back(entry.path());
  return files;
}

Result<> refuse_used(const std::string& file, const char* option, const std::vector<fs::path>& used) {
  std::error_code none;
  const fs::path place = place_of(file);
  for (const fs::path& other : used) {
    // Two names of one file, or one name of a file that is not there yet.
    const bool same = !other.empty() && (fs::equivalent(file, other, none) || place == place_of(other));
    if (same) return fail(fmt::format("{}: this run uses this file; choose another name with {}", file, option));
  }
  return {};
}

}  // namespace rmac::cli
