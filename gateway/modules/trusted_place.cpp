#include "gateway/modules/trusted_place.hpp"

#include <fmt/format.h>
#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;

bool is_trusted(uid_t user) {
  if (user == 0 || user == geteuid()) return true;
  const char* const caller = geteuid() == 0 ? std::getenv("SUDO_UID") : nullptr;
  if (caller == nullptr) return false;
  uid_t behind = 0;
  const char* const end = caller + std::strlen(caller);
  const auto read = std::from_chars(caller, end, behind);
  return read.ec == std::errc() && read.ptr == end && user == behind;
}

/// A group of one user's own, as many systems give each.
bool is_private(gid_t group, uid_t owner) {
  if (group == 0) return true;
  const passwd* const user = getpwuid(owner);
  const ::group* const members = getgrgid(group);
  return user != nullptr && members != nullptr && user->pw_gid == group && members->gr_mem[0] == nullptr &&
         std::string_view(user->pw_name) == members->gr_name;
}

tl::unexpected<Error> distrusted(const fs::path& file, const std::string& why) {
  return failure(MinorCode::InvalidParameterValue, fmt::format("{} is not loaded: {}", file.string(), why));
}

std::string name_of(uid_t user) {
  const passwd* const found = getpwuid(user);
  return found != nullptr ? found->pw_name : fmt::format("{}", user);
}

/// `place` is a file, or a folder above it.
Expected<> check_writers(const fs::path& file, const fs::path& place) {
  struct stat seen {};
  if (stat(place.c_str(), &seen) != 0) {
    return distrusted(file,
                      fmt::format("who may write {} cannot be found out: {}", place.string(), std::strerror(errno)));
  }
  if (!is_trusted(seen.st_uid)) {
    return distrusted(file, fmt::format("{} belongs to {}, who could put other code there, and not to root or {}, who "
                                        "runs this; chown it",
                                        place.string(), name_of(seen.st_uid), name_of(geteuid())));
  }
  // In a sticky folder, such as /tmp, nobody renames what others own.
  if (S_ISDIR(seen.st_mode) && (seen.st_mode & S_ISVTX) != 0) return {};
  const bool by_group = (seen.st_mode & S_IWGRP) != 0 && !is_private(seen.st_gid, seen.st_uid);
  if (!by_group && (seen.st_mode & S_IWOTH) == 0) return {};
  return distrusted(file, fmt::format("{} (mode {:04o}) may be written by others than root and {}, who runs this; "
                                      "chmod go-w it",
                                      place.string(), seen.st_mode & 07777U, name_of(geteuid())));
}

bool lies_in(const fs::path& file, const fs::path& folder) {
  std::error_code problem;
  const fs::path whole = fs::canonical(folder, problem);
  return !problem && std::mismatch(whole.begin(), whole.end(), file.begin(), file.end()).first == whole.end();
}

}  // namespace

Expected<> check_trusted(const fs::path& file, std::span<const fs::path> folders) {
  std::error_code problem;
  const fs::path whole = fs::canonical(file, problem);
  if (problem) return distrusted(file, problem.message());
  if (std::none_of(folders.begin(), folders.end(), [&](const fs::path& folder) { return lies_in(whole, folder); })) {
    return distrusted(file, fmt::format("it is a link to {}, out of the folders that modules come from; put the file "
                                        "itself there",
                                        whole.string()));
  }
  for (fs::path place = whole;; place = place.parent_path()) {
    if (auto fine = check_writers(file, place); !fine) return fine;
    if (place == place.root_path()) return {};
  }
}

}  // namespace rmac::gateway
