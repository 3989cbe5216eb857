#pragma once

#include <string>
#include <vector>

#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// A file of this process that goes when it goes.
class TemporaryFile {
 public:
  TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile();
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  std::string path_;
};

/// Runs one of the Python programs of this folder: what it prints. A failure holds the last line that it said on
/// standard error.
[[nodiscard]] Result<std::string> run_plot(const std::string& program, const std::vector<std::string>& arguments);

/// Refuses a picture that could not be drawn, before anything is done for it.
[[nodiscard]] Result<> check_picture(const std::string& file);

}  // namespace rmac::cli
