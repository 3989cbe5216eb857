#include "gateway/processes/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace rmac::gateway {
namespace {

using Clock = std::chrono::steady_clock;

class Pipe {
 public:
  Pipe() { made_ = pipe2(ends_, O_CLOEXEC) == 0; }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  [[nodiscard]] bool made() const noexcept { return made_; }
  [[nodiscard]] int end(int which) const noexcept { return ends_[which]; }
  void close_end(int which) noexcept {
    if (ends_[which] >= 0) close(ends_[which]);
    ends_[which] = -1;
  }

 private:
  int ends_[2] = {-1, -1};
  bool made_ = false;
};

tl::unexpected<Error> cannot_run(const std::string& program, int problem) {
  return failure(MinorCode::Other,
                 fmt::format("{} cannot be run: {}", program, std::generic_category().message(problem)));
}

/// Signals as in a new process, a process group of its own.
class Attributes {
 public:
  Attributes() {
    posix_spawnattr_init(&value_);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&value_, &none);
    posix_spawnattr_setsigdefault(&value_, &all);
    posix_spawnattr_setpgroup(&value_, 0);
    posix_spawnattr_setflags(&value_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  }
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;
  ~Attributes() { posix_spawnattr_destroy(&value_); }
  [[nodiscard]] const posix_spawnattr_t* get() const noexcept { return &value_; }

 private:
  posix_spawnattr_t value_{};
};

/// Only the two pipes, as standard output and error.
class Files {
 public:
  Files(int output, int complaint) {
    posix_spawn_file_actions_init(&value_);
    posix_spawn_file_actions_addopen(&value_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&value_, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&value_, complaint, STDERR_FILENO);
    posix_spawn_file_actions_addclosefrom_np(&value_, STDERR_FILENO + 1);
  }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;
  ~Files() { posix_spawn_file_actions_destroy(&value_); }
  [[nodiscard]] const posix_spawn_file_actions_t* get() const noexcept { return &value_; }

 private:
  posix_spawn_file_actions_t value_{};
};

/// Until both ends are closed; false when that takes until `give_up`, or is cancelled.
bool read_all(Pipe& output, Pipe& complaint, ChildOutcome& outcome, Clock::time_point give_up,
              const std::atomic<bool>& cancelled) {
  std::array<pollfd, 2> waiting{pollfd{output.end(0), POLLIN, 0}, pollfd{complaint.end(0), POLLIN, 0}};
  const std::array<std::string*, 2> texts{&outcome.output, &outcome.complaint};
  while (waiting[0].fd >= 0 || waiting[1].fd >= 0) {
    constexpr int kLook_ms = 100;
    if (cancelled || Clock::now() >= give_up) return false;
    if (poll(waiting.data(), waiting.size(), kLook_ms) < 0 && errno != EINTR) return false;
    for (std::size_t i = 0; i < waiting.size(); ++i) {
      if (waiting[i].fd < 0 || waiting[i].revents == 0) continue;
      std::array<char, 4096> buffer{};
      const ssize_t got = read(waiting[i].fd, buffer.data(), buffer.size());
      if (got > 0) texts[i]->append(buffer.data(), static_cast<std::size_t>(got));
      if (got == 0 || (got < 0 && errno != EINTR)) waiting[i].fd = -1;
    }
  }
  return true;
}

}  // namespace

Expected<ChildOutcome> run_child(const std::vector<std::string>& words, std::chrono::milliseconds patience,
                                 const std::atomic<bool>& cancelled) {
  Pipe output, complaint;
  if (!output.made() || !complaint.made()) return cannot_run(words.front(), errno);
  std::vector<char*> pointers;
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  pid_t child = 0;
  const Files files(output.end(1), complaint.end(1));
  const Attributes attributes;
  if (const int problem =
          posix_spawn(&child, words.front().c_str(), files.get(), attributes.get(), pointers.data(), environ);
      problem != 0) {
    return cannot_run(words.front(), problem);
  }
  output.close_end(1);
  complaint.close_end(1);
  ChildOutcome outcome;
  const bool ended = read_all(output, complaint, outcome, Clock::now() + patience, cancelled);
  if (!ended) kill(-child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!ended) {
    return failure(MinorCode::ResponseTimeout,
                   cancelled
                       ? fmt::format("{} was killed: nobody waits for it any more", words.front())
                       : fmt::format("{} was killed: it did not end within {} ms", words.front(), patience.count()));
  }
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return outcome;
}

}  // namespace rmac::gateway
