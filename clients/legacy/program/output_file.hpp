#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace rmac::legacy {

/// A program's file, under another name until it is whole: nobody should run half a program. "-" is standard output,
/// which gets nothing before the end either, and so are devices and pipes. Of a link it is the file that it leads to.
class OutputFile {
 public:
  explicit OutputFile(const std::string& name);
  /// What is not finished leaves no file, and an old one of that name as it was.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  [[nodiscard]] bool open() const noexcept { return file_ != nullptr; }
  void write(std::string_view text) noexcept;
  /// Once. False where not all of it could be written.
  [[nodiscard]] bool finish();

 private:
  bool copy_out();

  std::string name_, partial_;
  std::FILE* file_ = nullptr;
  std::FILE* out_ = nullptr;  ///< where all of it goes in the end, if that is no file
  bool good_ = true;
};

}  // namespace rmac::legacy
