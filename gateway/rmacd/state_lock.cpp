#include "gateway/rmacd/state_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <utility>

namespace rmac::gateway {
namespace {

constexpr int kMode = 0640;
constexpr const char* kName = "rmacd.lock";

/// What the owner has left of itself; empty when it has nothing yet.
std::string owner(int descriptor) {
  std::array<char, 32> text{};
  const ssize_t size = ::pread(descriptor, text.data(), text.size(), 0);
  return size > 0 ? std::string(text.data(), static_cast<std::size_t>(size)) : std::string();
}

}  // namespace

Expected<StateLock> StateLock::take(const std::filesystem::path& state_folder) {
  const int descriptor = ::open((state_folder / kName).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kMode);
  if (descriptor < 0) return StateLock(-1);
  StateLock lock(descriptor);
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) return lock;
    return failure(MinorCode::Other,
                   fmt::format("{} is in use by another rmacd (process {}); end that one, or give this one another "
                               "state_folder",
                               state_folder.string(), owner(descriptor)));
  }
  const std::string self = std::to_string(::getpid());
  // Only for people: the lock holds without it.
  if (::ftruncate(descriptor, 0) == 0) (void)!::pwrite(descriptor, self.data(), self.size(), 0);
  return lock;
}

StateLock::StateLock(StateLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

StateLock::~StateLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace rmac::gateway
