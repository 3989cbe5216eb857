#pragma once

#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace rmac::legacy {

/// The text of a program, or why there is none; - is standard input.
[[nodiscard]] tl::expected<std::string, std::string> read_file(const std::string& name);

struct NamedText {
  std::string name, text;
};

/// The file of that name in the first of the folders that has one, but not the program itself; none where no folder has
/// it, and else why it is not read.
[[nodiscard]] tl::expected<std::optional<NamedText>, std::string> find_file(const std::vector<std::string>& folders,
                                                                            const std::string& name,
                                                                            const std::string& program);

}  // namespace rmac::legacy
