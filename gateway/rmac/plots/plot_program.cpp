#include "gateway/rmac/plots/plot_program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "gateway/configuration/configuration.hpp"

namespace rmac::cli {

namespace {

constexpr const char* kPython = "/usr/bin/python3";

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The line of a complaint that says what is wrong: a traceback's last one.
std::string last_line(std::string text) {
  text.erase(text.find_last_not_of(" \n") + 1);
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

TemporaryFile::TemporaryFile() : path_((std::filesystem::temp_directory_path() / "rmac-XXXXXX").string()) {
  const int descriptor = ::mkstemp(path_.data());
  if (descriptor >= 0) ::close(descriptor);
}

TemporaryFile::~TemporaryFile() {
  ::unlink(path_.c_str());
}

Result<std::string> run_plot(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> words{kPython, "-B", (gateway::default_folders().helpers / program).string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);

  const TemporaryFile output, complaint;
  posix_spawn_file_actions_t actions{};
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.path().c_str(), O_WRONLY | O_TRUNC, 0600);
  ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, complaint.path().c_str(), O_WRONLY | O_TRUNC, 0600);
  pid_t child = 0;
  const int problem = ::posix_spawn(&child, kPython, &actions, nullptr, pointers.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (problem != 0) {
    return fail(fmt::format("{} cannot be run: {}; install python3, python3-scipy and python3-matplotlib", kPython,
                            std::generic_category().message(problem)));
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return text_of(output.path());
  return fail(fmt::format("{}: {}", program, last_line(text_of(complaint.path()))));
}

Result<> check_picture(const std::string& file) {
  const std::filesystem::path path(file);
  const std::string kind = path.extension();
  if (kind != ".png" && kind != ".svg" && kind != ".pdf") {
    return fail(fmt::format("{}: a picture's name ends in .png, .svg or .pdf", file));
  }
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (std::filesystem::is_directory(path) || ::access(folder.c_str(), W_OK) != 0) {
    return fail(fmt::format("{}: cannot be written; choose another place with --output", file));
  }
  return {};
}

}  // namespace rmac::cli
