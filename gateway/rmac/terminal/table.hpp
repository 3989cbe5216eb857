#pragma once

#include <string>
#include <vector>

namespace rmac::cli {

/// Rows as a person reads them: columns aligned, numbers (cells that begin with a digit, sign or point) to the right.
/// Whatever a cell holds, it stays within its line.
[[nodiscard]] std::string table(const std::vector<std::string>& header, std::vector<std::vector<std::string>> rows);

/// A number as a person reads it: at most `digits` after the point, no trailing zeros.
[[nodiscard]] std::string number(double value, int digits = 3);

}  // namespace rmac::cli
