#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "gateway/rmac/simulator/collision_watch.hpp"
#include "gateway/rmac/simulator/shaped_machine.hpp"
#include "gateway/rmac/view/film.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// What `rmac simulate` says of the page that it wrote.
struct ViewReport {
  std::string file;
  std::size_t bytes = 0;
  double within_mm = 0;  ///< of poses, at the moments that were looked at
};

/// Refuses a page that could not be written, before anything is done for it, and files that are `taken` otherwise or
/// that the machine is read from.
[[nodiscard]] Result<> check_view(const std::string& file, const ShapedMachine& machine,
                                  std::vector<std::filesystem::path> taken);

/// Writes the page of a run that is over. `watch` may be null; `dynamics` as `--json` has it.
[[nodiscard]] Result<ViewReport> report_view(const Film& film, const CollisionWatch* watch, nlohmann::json dynamics,
                                             const std::string& program, const std::string& file);

void add_to_json(const ViewReport& report, nlohmann::json& line);
/// A row of the table: what, where, and a remark.
[[nodiscard]] std::vector<std::string> row_of(const ViewReport& report);

}  // namespace rmac::cli
