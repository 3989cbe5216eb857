#include "gateway/verifier/supervisor.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <fstream>
#include <memory>
#include <new>

#include "gateway/json/printable.hpp"

namespace rmac::verifier {
namespace {

using Clock = std::chrono::steady_clock;

/// A line of a report is shorter by far.
constexpr std::size_t kMostUnread = std::size_t{1} << 20U;

const std::string kNotConfined =
    "nothing is run that cannot be kept apart from everything else, and this system does not let it be (see "
    "user_namespaces(7), kernel.unprivileged_userns_clone, and RestrictNamespaces= of a unit): ";

struct Unmap {
  void operator()(Place* place) const noexcept { munmap(place, sizeof(Place)); }
};

std::unique_ptr<Place, Unmap> shared_place() {
  void* memory = mmap(nullptr, sizeof(Place), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  return std::unique_ptr<Place, Unmap>(new (memory) Place{});
}

/// The whole of `text`, or as much as the other end takes.
void send(int pipe, const std::string& text) noexcept {
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t now = write(pipe, text.data() + sent, text.size() - sent);
    if (now < 0 && errno != EINTR) return;
    if (now > 0) sent += static_cast<std::size_t>(now);
  }
}

nlohmann::json found_so_far(const ModuleReport& report) {
  nlohmann::json json{{"build_id", report.build_id}, {"passed", report.passed}, {"not_checked", report.not_checked}};
  if (report.refusal) json["refusal"] = to_json(*report.refusal);
  return json;
}

/// Leaves open the pipe alone: what a module prints is not part of the report, and what else is open is not its own.
void close_files(int pipe) noexcept {
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, standard);
  const auto kept = static_cast<unsigned>(pipe);
  if (kept > STDERR_FILENO + 1) close_range(STDERR_FILENO + 1, kept - 1, 0);
  close_range(kept + 1, ~0U, 0);
}

[[noreturn]] void work(const Job& job, const Task& task, const Bounds& bounds, Place& place, int pipe) noexcept {
  close_files(pipe);
  // A sanitizer's handlers would turn a crash into an exit.
  for (const int crash : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) signal(crash, SIG_DFL);
  Watch watch(place);
  watch.step("start");
  ModuleReport report;
  report.module = job.module;
  const auto tell = [&] { send(pipe, gateway::text_of(found_so_far(report)) + "\n"); };
  (void)prepare_trap();
  if (const auto refused = confine(bounds, place.forbidden_call)) {
    report.refusal = CounterExample{"start", kNotConfined + *refused, -1, {}};
    tell();
  } else {
    job.run(task, watch, report, tell);
  }
  watch.step("end");
  _exit(0);  // what other modules registered to do at the end is not waited for
}

double cpu_time_s(pid_t process) {
  clockid_t clock{};
  timespec used{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &used) != 0) return 0;
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

/// Whether it computes, or would if a processor were free.
bool wants_processor(pid_t process) {
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  std::string stat;
  std::getline(file, stat);
  const std::size_t name_end = stat.rfind(')');  // behind it, a blank, and the state
  return name_end != std::string::npos && stat.compare(name_end, 3, ") R") == 0;
}

/// Watches one process from its start to its end.
class Watcher {
 public:
  Watcher(pid_t worker, int pipe, const Place& place, const Bounds& bounds)
      : worker_(worker), pipe_(pipe), place_(place), bounds_(bounds) {}

  /// Until it ends, or is killed for what it does; why it was.
  std::string watch() {
    std::string why;
    while (true) {
      pollfd waiting{pipe_, POLLIN, 0};
      constexpr int kLook_ms = 20;
      const int ready = poll(&waiting, 1, kLook_ms);
      if (ready < 0 && errno != EINTR) break;
      if (ready > 0 && !read_some()) {
        kill(worker_, SIGKILL);  // who ends by itself has its exit code by now
        break;
      }
      why = hangs();
      if (!why.empty()) {
        kill(worker_, SIGKILL);
        break;
      }
    }
    return why;
  }
  /// The last whole line that it sent.
  [[nodiscard]] const std::string& last_line() const { return line_; }

 private:
  /// False once it has closed its end.
  bool read_some() {
    char buffer[4096];
    const ssize_t got = read(pipe_, buffer, sizeof(buffer));
    if (got <= 0) return got < 0 && errno == EINTR;
    unread_.append(buffer, static_cast<std::size_t>(got));
    if (unread_.size() > kMostUnread) return false;
    for (std::size_t end = 0; (end = unread_.find('\n')) != std::string::npos;) {
      line_ = unread_.substr(0, end);
      unread_.erase(0, end + 1);
    }
    return true;
  }

  std::string hangs() {
    // What waits uses no CPU time, and what would compute may get little of it on a busy computer; on one that stands
    // still for seconds nobody gets any, and a look that comes so late says nothing of them.
    constexpr double kIdle_s = 0.1, kLongestLook_s = 0.1;
    const std::uint64_t steps = place_.steps.load(std::memory_order_acquire);
    const double cpu_s = cpu_time_s(worker_);
    const auto now = Clock::now();
    const double since_look_s = std::chrono::duration<double>(now - looked_).count();
    looked_ = now;
    if (steps != steps_) {
      steps_ = steps;
      cpu_since_s_ = cpu_s;
      waited_s_ = 0;
    } else if (cpu_s - cpu_since_s_ > bounds_.call_cpu_s) {
      return fmt::format("it computes for more than {} s", bounds_.call_cpu_s);
    } else if (cpu_s - cpu_since_s_ < kIdle_s && !wants_processor(worker_)) {
      waited_s_ += std::min(since_look_s, kLongestLook_s);
      if (waited_s_ <= bounds_.silence_s) return "";
      return fmt::format("it does not come back within {} s", bounds_.silence_s);
    }
    return "";
  }

  pid_t worker_;
  int pipe_;
  const Place& place_;
  const Bounds& bounds_;
  std::string unread_, line_;
  std::uint64_t steps_ = 0;
  double cpu_since_s_ = 0;
  double waited_s_ = 0;  ///< since the last step
  Clock::time_point looked_ = Clock::now();
};

std::string ending(int status, double cpu_s, const Bounds& bounds) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == kAborted) return "it crashes (ABRT, Aborted)";
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGKILL && cpu_s < 0.9 * bounds.cpu_s) return "it does something to the pipe for its report";
    if (signal == SIGXCPU || signal == SIGKILL) return fmt::format("it uses more than {} s of CPU time", bounds.cpu_s);
    return fmt::format("it crashes ({}, {})", sigabbrev_np(signal), sigdescr_np(signal));
  }
  return fmt::format("it ends the process with exit code {}", WEXITSTATUS(status));
}

/// False where the line is none of a report: a module wrote to the pipe.
bool take_line(const std::string& line, ModuleReport& report) try {
  if (line.empty()) return true;
  const auto json = nlohmann::json::parse(line);
  report.build_id = json.at("build_id");
  report.passed = json.at("passed").get<std::vector<std::string>>();
  report.not_checked = json.at("not_checked").get<std::vector<std::string>>();
  if (json.contains("refusal")) report.refusal = example_of(json["refusal"]);
  return true;
} catch (const nlohmann::json::exception&) {
  return false;
}

}  // namespace

ModuleReport supervise(const Job& job, const Task& task, const Bounds& bounds) {
  ModuleReport report{job.role, job.module, "", {}, {}, std::nullopt, 0};
  const auto place = shared_place();
  int ends[2];
  const bool piped = pipe2(ends, O_CLOEXEC) == 0;
  const pid_t worker = piped ? fork_apart() : -1;
  if (worker < 0) {
    report.refusal = CounterExample{
        "start", kNotConfined + fmt::format("starting a process apart: {}", std::strerror(errno)), -1, {}};
    return report;
  }
  if (worker == 0) {
    close(ends[0]);
    work(job, task, bounds, *place, ends[1]);
  }
  close(ends[1]);
  Watcher watcher(worker, ends[0], *place, bounds);
  const std::string killed_for = watcher.watch();
  close(ends[0]);
  int status = 0;
  rusage used{};
  while (wait4(worker, &status, 0, &used) < 0 && errno == EINTR) {
  }
  report.cpu_s = static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                 1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  if (!take_line(watcher.last_line(), report)) {
    report.refusal = example_at(*place, "confinement", "it writes into the report on itself");
  }
  // A refusal goes before what came of it, such as a crash while the object was destroyed.
  if (report.refusal) return report;
  if (!killed_for.empty()) {
    report.refusal = example_at(*place, "hang", killed_for);
  } else if (WIFEXITED(status) && WEXITSTATUS(status) == kForbiddenCall) {
    report.refusal = example_at(*place, "confinement",
                                fmt::format("it asks the system for {}, which no module may while it is verified,",
                                            system_call_name(place->forbidden_call)));
  } else if (status != 0 || std::strcmp(place->doing, "end") != 0) {
    report.refusal = example_at(*place, "crash", ending(status, report.cpu_s, bounds));
  }
  return report;
}

}  // namespace rmac::verifier
