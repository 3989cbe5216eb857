#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace rmac::cli {

/// One line on the terminal's stderr that is drawn over itself. Silent unless `shown`.
class Progress {
 public:
  explicit Progress(bool shown) : shown_(shown) {}
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void draw(std::size_t done, std::size_t total, const std::string& note);
  void clear();

 private:
  bool shown_, drawn_ = false;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace rmac::cli
