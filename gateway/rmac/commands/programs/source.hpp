#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gateway/rmac/commands/command.hpp"
#include "gateway/rmac/program/program.hpp"

namespace rmac::cli {

/// Reads programs of other controls; installed beside this program.
inline constexpr const char* kImporter = "rmac-import";

/// Path of a program that is installed beside this one.
[[nodiscard]] std::string beside_rmac(const char* program);

/// The file of a program that is to run, and what there is to say about it where it is another control's. The importer
/// reads that, as `rmac import` would.
struct Source {
  std::string file, dialect;
  std::array<std::string, 13> values;                ///< of options that are given once; empty: not given
  std::array<std::vector<std::string>, 7> repeated;  ///< of options that may be given again
  bool assume_g43 = false, assume_end = false, block_delete = false, multax = false;
};

/// FILE, and the options of the importer.
void declare_source(Command& command, Source& source);

/// By the file's ending it is `.rmac`, or a program of another control that is imported first; `--dialect` says it of
/// any file.
[[nodiscard]] Result<Program> read_source(const Source& source);

}  // namespace rmac::cli
