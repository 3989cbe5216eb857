#include "gateway/files/whole_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDescriptors = "/proc/self/fd";
constexpr std::size_t kAtOnce = std::size_t{64} << 10;

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}  // namespace

WholeFile::WholeFile(const fs::path& file, mode_t rights) : file_(file) {
  std::error_code none;
  if (fs::is_symlink(file, none)) file_ = fs::weakly_canonical(file, none);
  open(rights);
  if (descriptor_ < 0) cannot("cannot be opened");
}

WholeFile::~WholeFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!part_.empty()) ::unlink(part_.c_str());
}

void WholeFile::open(mode_t rights) {
  struct stat old {};
  const bool there = ::stat(file_.c_str(), &old) == 0;
  is_file_ = !there || S_ISREG(old.st_mode);
  if (!is_file_) {
    descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CLOEXEC);
    return;
  }
  // Without a name it is gone with the process, however that ends.
  if (::access(kDescriptors, X_OK) == 0) {
    descriptor_ = ::open(folder_of(file_).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, rights);
  }
  if (descriptor_ < 0) {
    part_ = fmt::format("{}.{}.part", file_.string(), ::getpid());
    descriptor_ = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, rights);
    if (descriptor_ < 0) part_.clear();
  }
  constexpr mode_t kRights = 07777;
  if (there && descriptor_ >= 0) ::fchmod(descriptor_, old.st_mode & kRights);
}

void WholeFile::write(std::string_view bytes) {
  if (!good()) return;
  waiting_ += bytes;
  if (waiting_.size() >= kAtOnce || !is_file_) flush();
}

void WholeFile::flush() {
  std::string_view bytes = waiting_;
  while (!bytes.empty() && good()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written >= 0) bytes.remove_prefix(static_cast<std::size_t>(written));
    if (written < 0 && errno != EINTR) cannot("cannot be written");
  }
  waiting_.clear();
}

void WholeFile::name() {
  if (part_.empty()) {
    const fs::path part = fmt::format("{}.{}.part", file_.string(), ::getpid());
    ::unlink(part.c_str());
    const std::string open = fmt::format("{}/{}", kDescriptors, descriptor_);
    if (::linkat(AT_FDCWD, open.c_str(), AT_FDCWD, part.c_str(), AT_SYMLINK_FOLLOW) != 0)
      return cannot("cannot be named");
    part_ = part;
  }
  if (::rename(part_.c_str(), file_.c_str()) != 0) return cannot("cannot be named");
  part_.clear();
  // The new name is on the disk only when its folder is.
  const int folder = ::open(folder_of(file_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0 || ::fsync(folder) != 0) cannot("cannot be made durable");
  if (folder >= 0) ::close(folder);
}

Expected<> WholeFile::finish() {
  if (good()) flush();
  if (good() && is_file_) {
    // Power may go next, as after a fault it often does.
    if (::fsync(descriptor_) != 0) cannot("cannot be written");
    if (good()) name();
  }
  if (!good()) return failure(MinorCode::Other, trouble_);
  return {};
}

void WholeFile::cannot(const char* what) {
  trouble_ = fmt::format("{}: {}: {}", file_.string(), what, std::generic_category().message(errno));
}

Expected<> write_whole(const fs::path& file, std::string_view bytes) {
  WholeFile whole(file);
  whole.write(bytes);
  return whole.finish();
}

}  // namespace rmac::gateway
