#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gateway/forces/force_coefficients.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

struct WorkMaterial {
  std::string name;
  std::vector<std::string> also_called;
  ForceCoefficients coefficients;
  std::string tool;    ///< with what that was measured
  std::string source;  ///< who says so
};

/// The work materials of a `materials.json`.
class WorkMaterials {
 public:
  /// Reads the file and checks it against etc/materials.schema.json; two materials of one name are refused. An error
  /// begins with the file's name.
  [[nodiscard]] static Expected<WorkMaterials> read(const std::filesystem::path& file);

  /// By one of its names, of which letters, in either case, and digits count. Where there is none the error says which
  /// one may have been meant, and which there are. The material lives as long as this.
  [[nodiscard]] Expected<const WorkMaterial*> find(const std::string& name) const;

  [[nodiscard]] const std::vector<WorkMaterial>& all() const noexcept { return materials_; }

 private:
  std::filesystem::path file_;
  std::vector<WorkMaterial> materials_;
};

}  // namespace rmac::gateway
