// Kinematics of three linear joints that answer as they should, made by a factory that means harm.
#include <arpa/inet.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string>

#include "rmac/modules/chain_kinematics.hpp"
#include "rmac/sdk/module.hpp"

namespace {

enum class Deed { None, KillsParent, KillsItsGroup, Forks, WritesFile, CallsStopNow, Traces, WritesMemory, Reports };
constexpr Deed kDeed = Deed::DEFECT;

double number(rmac::sdk::Parameters parameters, const char* name) {
  for (const rmac::sdk::Parameter& parameter : parameters) {
    if (std::strcmp(parameter.name, name) == 0 && !parameter.numbers.empty()) return parameter.numbers[0];
  }
  return 0;
}

std::string text(rmac::sdk::Parameters parameters, const char* name) {
  for (const rmac::sdk::Parameter& parameter : parameters) {
    if (std::strcmp(parameter.name, name) == 0 && parameter.text != nullptr) return parameter.text;
  }
  return {};
}

void write_to(const std::string& file) {
  const int opened = open(file.c_str(), O_WRONLY | O_CREAT, 0666);
  if (opened < 0) return;
  (void)!write(opened, "here", 4);
  close(opened);
}

void call_stop_now(int port) {
  const int connection = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in daemon{};
  daemon.sin_family = AF_INET;
  daemon.sin_port = htons(static_cast<std::uint16_t>(port));
  inet_pton(AF_INET, "127.0.0.1", &daemon.sin_addr);
  if (connect(connection, reinterpret_cast<sockaddr*>(&daemon), sizeof(daemon)) != 0) return;
  constexpr const char* kStop = "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"RMAC_CAM.StopNow\"}\n";
  (void)!write(connection, kStop, std::strlen(kStop));
  (void)!read(connection, nullptr, 0);
}

/// Whatever pipe it has: what stands there is read as its report.
void report() {
  for (int file = 3; file < 64; ++file) (void)!write(file, "{\"passed\":7}\n", 13);
  for (int file = 3; file < 64; ++file) close(file);
  while (true) pause();
}

void do_harm(rmac::sdk::Parameters parameters) {
  switch (kDeed) {
    case Deed::None:
      break;
    case Deed::KillsParent:
      kill(getppid() == 0 ? static_cast<pid_t>(number(parameters, "daemon")) : getppid(), SIGKILL);
      break;
    case Deed::KillsItsGroup:
      kill(0, SIGKILL);
      break;
    case Deed::Forks:
      for (int i = 0; i < 300; ++i) {
        if (fork() == 0) pause();
      }
      break;
    case Deed::WritesFile:
      write_to(text(parameters, "file"));
      break;
    case Deed::CallsStopNow:
      call_stop_now(static_cast<int>(number(parameters, "port")));
      break;
    case Deed::Traces:
      ptrace(PTRACE_ATTACH, static_cast<pid_t>(number(parameters, "daemon")), nullptr, nullptr);
      break;
    case Deed::WritesMemory:
      write_to("/proc/" + std::to_string(static_cast<int>(number(parameters, "daemon"))) + "/mem");
      break;
    case Deed::Reports:
      report();
      break;
  }
}

struct Made {
  static rmac::Kinematics* create(rmac::sdk::Parameters parameters) {
    do_harm(parameters);
    return new rmac::modules::ChainKinematics(rmac::modules::cartesian(3));
  }
};

}  // namespace

extern "C" __attribute__((visibility("default"))) const rmac::sdk::ModuleDescriptor* rmac_module() noexcept {
  static constexpr rmac::sdk::ModuleDescriptor kDescriptor{
      rmac::sdk::kModuleAbi,
      rmac::sdk::ModuleKind::Kinematics,
      "HostileKinematics",
      __DATE__ " " __TIME__,
      [](rmac::sdk::Parameters parameters, char*, std::size_t) noexcept -> void* { return Made::create(parameters); },
      [](void* object) noexcept { delete static_cast<rmac::Kinematics*>(object); }};
  return &kDescriptor;
}
