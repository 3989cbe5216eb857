#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

#include "clients/legacy/program/input_file.hpp"
#include "clients/legacy/rs274/flow/outline.hpp"

namespace rmac::rs274 {

using SubFile = legacy::NamedText;

/// The file of this name without its folder, as `pocket.ngc`; none where there is none, and else why it is not read.
using FindFile = std::function<tl::expected<std::optional<SubFile>, std::string>(const std::string& name)>;

/// A text with O words.
struct Source {
  Source(std::string name, std::string_view program, bool block_delete)
      : file(std::move(name)), text(program), outline(text, block_delete) {}

  std::string file;  ///< empty for the program itself
  std::string_view text;
  Outline outline;
};

/// The program, and the files whose subs it calls; each is read once.
class Sources {
 public:
  /// The program outlives it.
  Sources(std::string_view program, bool block_delete, FindFile find_file)
      : find_file_(std::move(find_file)), block_delete_(block_delete), program_({}, program, block_delete) {}

  [[nodiscard]] const Source& program() const noexcept { return program_; }

  /// Name of the file that a label's sub may be in; empty for a label that no file has.
  [[nodiscard]] static std::string file_of(std::string_view label);
  /// That file; null where there is none. It stays where it is. Throws a Refusal at `place` where it cannot be read.
  [[nodiscard]] const Source* find_file(const std::string& label, std::size_t place);
  /// Whether files are looked for at all.
  [[nodiscard]] bool has_files() const noexcept { return static_cast<bool>(find_file_); }

 private:
  struct File {
    explicit File(SubFile found, bool block_delete)
        : text(std::move(found.text)), source(std::move(found.name), text, block_delete) {}
    const std::string text;
    const Source source;
  };

  FindFile find_file_;
  bool block_delete_;
  Source program_;
  std::map<std::string, std::unique_ptr<File>> files_;  ///< by label; null where there is none
};

}  // namespace rmac::rs274
