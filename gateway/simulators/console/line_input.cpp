#include "gateway/simulators/console/line_input.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace rmac::vdrive {

Expected<LineInput> LineInput::open(const std::string& path) {
  // A FIFO is opened for both directions, so that it does not end when a writer goes.
  const int file = path == "-" ? dup(STDIN_FILENO) : ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) {
    return failure(
        MinorCode::InvalidParameterValue,
        fmt::format("{}: cannot be opened for commands: {}; make it with mkfifo", path, std::strerror(errno)));
  }
  return LineInput(file);
}

LineInput::~LineInput() {
  if (file_ >= 0) close(file_);
}

std::optional<std::string> LineInput::next() {
  constexpr std::size_t kMostKept = 4096;
  std::array<char, 512> read_now{};
  pollfd readable{.fd = file_, .events = POLLIN, .revents = 0};
  while (kept_.find('\n') == std::string::npos && file_ >= 0 && poll(&readable, 1, 0) > 0) {
    const ssize_t size = read(file_, read_now.data(), read_now.size());
    if (size <= 0) {
      if (size == 0 || (errno != EAGAIN && errno != EINTR)) close(std::exchange(file_, -1));
      break;
    }
    kept_.append(read_now.data(), static_cast<std::size_t>(size));
    // No command is that long: what is left of it is none either, and is refused as what it is.
    if (kept_.size() > kMostKept && kept_.find('\n') == std::string::npos) kept_.resize(kMostKept);
  }
  const std::size_t end = kept_.find('\n');
  if (end == std::string::npos) return {};
  std::string line = kept_.substr(0, end);
  kept_.erase(0, end + 1);
  return line;
}

}  // namespace rmac::vdrive
