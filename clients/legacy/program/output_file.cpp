#include "clients/legacy/program/output_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <vector>

namespace rmac::legacy {

namespace fs = std::filesystem;

OutputFile::OutputFile(const std::string& name) : name_(name) {
  constexpr int kMostParts = 1000;
  std::error_code none;
  if (fs::is_symlink(name, none)) name_ = fs::weakly_canonical(name, none).string();
  const bool is_file = fs::is_regular_file(name_, none) || !fs::exists(name_, none);
  if (name == "-") {
    out_ = stdout;
  } else if (!is_file) {
    out_ = std::fopen(name_.c_str(), "wb");
    if (out_ == nullptr) return;
  }
  if (out_ != nullptr) {
    file_ = std::tmpfile();
    return;
  }
  // What has such a name already is somebody's.
  for (int number = 0; file_ == nullptr && number < kMostParts; ++number) {
    partial_ = fmt::format("{}.{}.part", name_, number);
    file_ = std::fopen(partial_.c_str(), "wbx");
    if (file_ == nullptr && errno != EEXIST) break;
  }
  if (file_ == nullptr) partial_.clear();
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) std::fclose(file_);
  if (out_ != nullptr && out_ != stdout) std::fclose(out_);
  std::error_code ignored;
  if (!partial_.empty()) fs::remove(partial_, ignored);
}

void OutputFile::write(std::string_view text) noexcept {
  good_ = good_ && std::fwrite(text.data(), 1, text.size(), file_) == text.size();
}

bool OutputFile::finish() {
  if (partial_.empty()) return copy_out();
  const bool closed = std::fclose(file_) == 0;
  file_ = nullptr;
  std::error_code failed;
  if (good_ && closed) fs::rename(partial_, name_, failed);
  return good_ && closed && !failed;
}

bool OutputFile::copy_out() {
  std::rewind(file_);
  std::vector<char> part(1U << 16U);
  for (std::size_t got = 0; good_ && (got = std::fread(part.data(), 1, part.size(), file_)) > 0;) {
    good_ = std::fwrite(part.data(), 1, got, out_) == got;
  }
  return good_ && std::fflush(out_) == 0;
}

}  // namespace rmac::legacy
