#include "gateway/rmac/terminal/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace rmac::cli {

namespace {

constexpr std::size_t kBarCells = 30;
constexpr auto kRedraw = std::chrono::milliseconds(100);

}  // namespace

void Progress::draw(std::size_t done, std::size_t total, const std::string& note) {
  const auto now = std::chrono::steady_clock::now();
  if (!shown_ || total == 0 || (now - last_ < kRedraw && done < total)) {
    return;
  }
  last_ = now;
  drawn_ = true;
  const auto filled = std::min(done, total) * kBarCells / total;
  fmt::print(stderr, "\r\x1b[K[{}{}] {}/{} moves  {}", std::string(filled, '#'), std::string(kBarCells - filled, '.'),
             done, total, note);
  std::fflush(stderr);
}

void Progress::clear() {
  if (drawn_) {
    fmt::print(stderr, "\r\x1b[K");
    std::fflush(stderr);
    drawn_ = false;
  }
}

}  // namespace rmac::cli
