#pragma once

#include <optional>
#include <set>

#include "clients/legacy/fanuc/blocks/codes.hpp"
#include "clients/legacy/fanuc/blocks/words.hpp"
#include "clients/legacy/gcode/blocks/block.hpp"

namespace rmac::fanuc {

/// What a block asks of the order of lines, behind what it does.
struct Ordered {
  enum class What { Next, Call, Return };
  What what = What::Next;
  std::size_t place = 0;
  int program = 0, times = 1;  ///< of M98; how the number was written tells the latter, where L does not
  bool times_are_said = false;
  std::optional<int> label;  ///< of M99 P
  bool ends_modal_call = false;
};

/// Reads blocks of words.
class BlockReader {
 public:
  /// `passed_m`: M codes that mean nothing here.
  explicit BlockReader(const std::set<int>& passed_m) : passed_m_(passed_m) {}

  /// From `at` of the text on. Throws a Refusal for what is no block.
  [[nodiscard]] Ordered read(std::string_view text, std::size_t at, const Variables& variables,
                             const gcode::Modes& modes, gcode::Block& block);

 private:
  void add(const FanucWord& word, gcode::Block& block, Ordered& ordered);
  void add_g(const gcode::Word& word, gcode::Block& block, Ordered& ordered);
  void add_m(const gcode::Word& word, gcode::Block& block, Ordered& ordered);

  const std::set<int>& passed_m_;
  std::optional<gcode::Code> look_ahead_;
};

}  // namespace rmac::fanuc
