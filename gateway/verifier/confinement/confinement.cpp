#include "gateway/verifier/confinement/confinement.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "gateway/processes/rights.hpp"
#include "gateway/verifier/confinement/system_call_filter.hpp"

namespace rmac::verifier {
namespace {

/// Files of its own: a folder that every system has, and that no module has any business with.
constexpr const char* kTemporaryFolder = "/sys";
constexpr int kBusyTries = 200;
constexpr useconds_t kBusyPauseUs = 1000;

/// Who the process was before its user namespace, in which that is not known.
uid_t user = 0;
gid_t group = 0;

std::string refused(const char* what) {
  return fmt::format("{}: {}", what, std::strerror(errno));
}

bool write_file(const char* file, const std::string& text) noexcept {
  const int opened = open(file, O_WRONLY | O_CLOEXEC);
  if (opened < 0) return false;
  const bool written = write(opened, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  close(opened);
  return written;
}

/// In the new user namespace it is who it was.
std::optional<std::string> keep_identity() {
  if (!write_file("/proc/self/setgroups", "deny") ||
      !write_file("/proc/self/uid_map", fmt::format("{0} {0} 1", user)) ||
      !write_file("/proc/self/gid_map", fmt::format("{0} {0} 1", group))) {
    return refused("mapping its user into a user namespace");
  }
  return {};
}

/// Nothing that is mounted can be written, nor any device reached, but for an empty folder.
std::optional<std::string> close_file_system(const Bounds& bounds) {
  if (mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return refused("making its mounts its own");
  mount_attr closed{};
  closed.attr_set = MOUNT_ATTR_RDONLY | MOUNT_ATTR_NOSUID | MOUNT_ATTR_NODEV;
  int done = mount_setattr(AT_FDCWD, "/", AT_RECURSIVE, &closed, sizeof(closed));
  // On a busy computer it was seen that a mount counts as written for a moment, though nobody holds a file in it.
  for (int i = 0; done != 0 && errno == EBUSY && i < kBusyTries; ++i) {
    usleep(kBusyPauseUs);
    done = mount_setattr(AT_FDCWD, "/", AT_RECURSIVE, &closed, sizeof(closed));
  }
  if (done != 0) {
    return refused("making the file system read-only (a change of root must be one of the mounts, not chroot)");
  }
  // The processes of its own namespace, which is itself alone. Where parts of /proc are hidden, as a service manager
  // may do, the kernel keeps to what is there: read-only by now.
  (void)mount("proc", "/proc", "proc", MS_NOSUID | MS_NODEV | MS_NOEXEC | MS_RDONLY, nullptr);
  const std::string size = fmt::format("size={},mode=0700", bounds.memory_bytes / 4);
  if (mount("tmpfs", kTemporaryFolder, "tmpfs", MS_NOSUID | MS_NODEV, size.c_str()) != 0 ||
      setenv("TMPDIR", kTemporaryFolder, 1) != 0) {
    return refused("mounting a temporary folder");
  }
  return {};
}

/// The first process of a namespace is not ended by signals that it leaves to the system, those that it sends to itself
/// among them.
void end_when_aborted() noexcept {
  struct sigaction action {};
  action.sa_handler = [](int) { _exit(kAborted); };
  sigaction(SIGABRT, &action, nullptr);
}

}  // namespace

pid_t fork_apart() noexcept {
  user = geteuid();
  group = getegid();
  constexpr unsigned long kApart = CLONE_NEWUSER | CLONE_NEWPID | CLONE_NEWNET | CLONE_NEWNS | CLONE_NEWIPC;
  // The C library has no fork with flags; a stack of 0 means a copy of this one.
  return static_cast<pid_t>(syscall(SYS_clone, kApart | SIGCHLD, nullptr, nullptr, nullptr, nullptr));
}

std::optional<std::string> confine(const Bounds& bounds, std::atomic<int>& forbidden) {
  if (setsid() < 0) return refused("leaving its process group, which signals reach across namespaces");
  end_when_aborted();
  if (auto problem = keep_identity()) return problem;
  if (auto problem = close_file_system(bounds)) return problem;
  if (auto problem = gateway::give_up_rights(bounds.cpu_s, bounds.memory_bytes)) return problem;
  return filter_system_calls(forbidden);
}

}  // namespace rmac::verifier
