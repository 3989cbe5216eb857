#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// A file that has its name only once it is whole and on the disk. Until then, and for good where it is not finished, a
/// disk is full, or the process is killed, that name has what it had before. Of a link it is the file that it leads to;
/// what is no file (a pipe, a terminal) gets the bytes as they come. Access rights are those of the old file. One
/// thread at a time.
class WholeFile {
 public:
  /// `rights`: of a new file, less what the process's umask takes.
  explicit WholeFile(const std::filesystem::path& file, mode_t rights = 0666);
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;
  ~WholeFile();

  /// Trouble is told by `finish`, and by `good` from when it is known: bytes are written many at a time.
  void write(std::string_view bytes);
  [[nodiscard]] bool good() const noexcept { return trouble_.empty(); }
  /// Once. The error names the file, what could not be done, and the system's reason.
  [[nodiscard]] Expected<> finish();

 private:
  void open(mode_t rights);
  void flush();
  void name();
  void cannot(const char* what);

  std::filesystem::path file_, part_;  ///< `part_`: its name until it is whole; empty as long as it has none
  std::string waiting_;
  std::string trouble_;
  int descriptor_ = -1;
  bool is_file_ = true;
};

/// All of a file at once.
[[nodiscard]] Expected<> write_whole(const std::filesystem::path& file, std::string_view bytes);

}  // namespace rmac::gateway
