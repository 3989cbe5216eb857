#include "gateway/processes/rights.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/capability.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "gateway/threads/sanitized.hpp"

namespace rmac::gateway {
namespace {

void limit(__rlimit_resource resource, rlim_t most) noexcept {
  const rlimit wanted{most, most};
  (void)setrlimit(resource, &wanted);
}

void limit_resources(double cpu_s, std::size_t memory_bytes) noexcept {
  constexpr rlim_t kFiles = 64, kFileBytes = rlim_t{256} << 20U;
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_NOFILE, kFiles);
  limit(RLIMIT_FSIZE, kFileBytes);
  limit(RLIMIT_RTPRIO, 0);
  limit(RLIMIT_CPU, static_cast<rlim_t>(cpu_s));
  if (!kSanitized) limit(RLIMIT_AS, memory_bytes);
  constexpr int kNice = 5;
  (void)setpriority(PRIO_PROCESS, 0, kNice);
}

}  // namespace

std::optional<std::string> give_up_rights(double cpu_s, std::size_t memory_bytes) {
  (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
  limit_resources(cpu_s, memory_bytes);
  (void)prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> none{};
  if (syscall(SYS_capset, &header, none.data()) != 0) {
    return fmt::format("giving up its capabilities: {}", std::strerror(errno));
  }
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) {
    return fmt::format("giving up the right to gain privileges: {}", std::strerror(errno));
  }
  return {};
}

void offer_memory() noexcept {
  constexpr std::string_view kFirst = "1000";
  const int file = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  (void)!write(file, kFirst.data(), kFirst.size());
  close(file);
}

}  // namespace rmac::gateway
