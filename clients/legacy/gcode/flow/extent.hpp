#pragma once

#include <cstddef>
#include <string>

namespace rmac::gcode {

/// From where to where a file is a program: between two lines with %, or up to M30 or M2 where it begins with none.
/// What is neither may be cut off, and throws a Refusal. `running`: what was called and has not ended yet, empty in the
/// main program.
class Extent {
 public:
  /// `ends_anyhow`: the end of the file is the program's.
  explicit Extent(bool ends_anyhow = false) : ends_anyhow_(ends_anyhow) {}

  [[nodiscard]] bool ended() const noexcept { return ended_; }
  /// Something stood there that is no %.
  void begin() noexcept { begun_ = true; }
  /// M30 or M2.
  void end() noexcept { ended_ = true; }
  /// A line with %. Whether it ends the program.
  bool mark(const std::string& running);
  /// The file has no more lines, and the program has not ended.
  void require_end(std::size_t place, const std::string& running) const;

 private:
  bool ends_anyhow_;
  bool begun_ = false, marked_ = false, ended_ = false;
};

}  // namespace rmac::gcode
