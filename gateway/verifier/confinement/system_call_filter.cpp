#include "gateway/verifier/confinement/system_call_filter.hpp"

#include <fmt/format.h>
#include <sched.h>
#include <seccomp.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "gateway/verifier/confinement/confinement.hpp"

namespace rmac::verifier {
namespace {

/// What a C++ program needs that computes, reads files, and writes to those that it may. No socket, no process, no
/// tracing, no mount, no key, no other user.
constexpr const char* kAllowed[] = {
    // Memory
    "brk", "madvise", "membarrier", "mincore", "mmap", "mprotect", "mremap", "munmap",
    // Files
    "access", "close", "close_range", "copy_file_range", "dup", "dup2", "dup3", "faccessat", "faccessat2", "fadvise64",
    "fallocate", "fchmod", "fcntl", "fdatasync", "fstat", "fstatfs", "fsync", "ftruncate", "getcwd", "getdents",
    "getdents64", "ioctl", "lseek", "lstat", "memfd_create", "mkdir", "mkdirat", "newfstatat", "open", "openat",
    "openat2", "pipe", "pipe2", "poll", "ppoll", "pread64", "preadv", "pselect6", "pwrite64", "pwritev", "read",
    "readlink", "readlinkat", "readv", "rename", "renameat", "renameat2", "rmdir", "select", "sendfile", "stat",
    "statfs", "statx", "truncate", "umask", "unlink", "unlinkat", "write", "writev",
    // Waiting, as event loops do
    "epoll_create", "epoll_create1", "epoll_ctl", "epoll_pwait", "epoll_pwait2", "epoll_wait", "eventfd", "eventfd2",
    "inotify_add_watch", "inotify_init", "inotify_init1", "inotify_rm_watch", "timerfd_create", "timerfd_gettime",
    "timerfd_settime",
    // Time, signals to itself, and who it is
    "arch_prctl", "clock_getres", "clock_gettime", "clock_nanosleep", "exit", "exit_group", "futex", "getcpu",
    "getegid", "geteuid", "getgid", "getpid", "getppid", "getpriority", "getrandom", "getrlimit", "getrusage", "gettid",
    "gettimeofday", "getuid", "nanosleep", "pause", "prlimit64", "restart_syscall", "rseq", "rt_sigaction",
    "rt_sigpending", "rt_sigprocmask", "rt_sigreturn", "rt_sigsuspend", "rt_sigtimedwait", "sched_getaffinity",
    "sched_getparam", "sched_getscheduler", "sched_yield", "set_robust_list", "set_tid_address", "sigaltstack",
    "sysinfo", "tgkill", "time", "times", "uname"};

struct sigaction before {};
std::atomic<int>* told = nullptr;

void on_system_call(int signal, siginfo_t* info, void* context) {
  constexpr int kFiltered = 1;  // SYS_SECCOMP; other numbers are other reasons for the signal
  if (info->si_code == kFiltered) {
    told->store(info->si_syscall, std::memory_order_release);
    _exit(kForbiddenCall);
  }
  if ((before.sa_flags & SA_SIGINFO) != 0) before.sa_sigaction(signal, info, context);
}

void catch_what_is_filtered(std::atomic<int>& forbidden) noexcept {
  told = &forbidden;
  struct sigaction action {};
  action.sa_sigaction = on_system_call;
  action.sa_flags = SA_SIGINFO | SA_NODEFER;  // what the handler before does may be filtered
  sigaction(SIGSYS, &action, &before);
}

struct Release {
  void operator()(void* filter) const noexcept { seccomp_release(filter); }
};

}  // namespace

std::optional<std::string> filter_system_calls(std::atomic<int>& forbidden) {
  catch_what_is_filtered(forbidden);
  const std::unique_ptr<void, Release> filter(seccomp_init(SCMP_ACT_TRAP));
  int problem = filter ? 0 : -ENOMEM;
  for (const char* name : kAllowed) {
    const int number = seccomp_syscall_resolve_name(name);
    // Not every processor has all of them.
    if (number >= 0 && problem == 0) problem = seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, number, 0);
  }
  // A thread is no process. The C library asks for the newer call first, whose flags a filter cannot see.
  if (problem == 0) {
    problem = seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, SCMP_SYS(clone), 1,
                               SCMP_A0(SCMP_CMP_MASKED_EQ, CLONE_THREAD, CLONE_THREAD));
  }
  if (problem == 0) problem = seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0);
  if (problem == 0) problem = seccomp_load(filter.get());
  if (problem != 0) return fmt::format("filtering its system calls (seccomp): {}", std::strerror(-problem));
  return {};
}

std::string system_call_name(int number) {
  const std::unique_ptr<char, decltype(&std::free)> name(seccomp_syscall_resolve_num_arch(SCMP_ARCH_NATIVE, number),
                                                         &std::free);
  return name ? std::string(name.get()) : fmt::format("system call {}", number);
}

}  // namespace rmac::verifier
