#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace rmac::gateway {

/// A folder of one's own under the system's temporary one, which ends with its owner. Its path is empty where none can
/// be made.
class TemporaryFolder {
 public:
  /// `purpose` is part of its name.
  explicit TemporaryFolder(const std::string& purpose) {
    std::error_code none;
    const std::filesystem::path under = std::filesystem::temp_directory_path(none);
    std::string name = (under / ("rmac-" + purpose + "-XXXXXX")).string();
    if (!none && mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace rmac::gateway
