#pragma once

#include <optional>
#include <set>

#include "clients/legacy/fanuc/blocks/haas_codes.hpp"
#include "clients/legacy/fanuc/blocks/words.hpp"
#include "clients/legacy/gcode/blocks/block.hpp"

namespace rmac::fanuc {

/// What a block asks of the order of lines, behind what it does.
struct Ordered {
  enum class What { Next, Call, CallLocal, Return };
  What what = What::Next;
  std::size_t place = 0;
  int program = 0, times = 1;  ///< of M98; how the number was written tells the latter, where L does not
  bool times_are_said = false;
  std::optional<int> label;  ///< of M99 P and M97 P
  bool ends_modal_call = false;
};

/// Reads blocks of words, one after the other: G16 holds from one to the next.
class BlockReader {
 public:
  /// `passed_m`: M codes that mean nothing here.
  BlockReader(const std::set<int>& passed_m, Dialect dialect)
      : passed_m_(passed_m), is_haas_(dialect == Dialect::Haas) {}

  /// From `at` of the text on. Throws a Refusal for what is no block.
  [[nodiscard]] Ordered read(std::string_view text, std::size_t at, const Variables& variables,
                             const gcode::Modes& modes, gcode::Block& block);
  /// What the block that was read last has beside what block and order say.
  [[nodiscard]] const HaasWords& haas() const noexcept { return haas_; }

 private:
  void add(const FanucWord& word, gcode::Block& block, Ordered& ordered);
  void add_g(const gcode::Word& word, gcode::Block& block, Ordered& ordered);
  void add_m(const gcode::Word& word, gcode::Block& block, Ordered& ordered);
  /// False where a Haas means nothing of its own by it.
  [[nodiscard]] bool add_haas_m(int number, std::size_t place, gcode::Block& block);
  void add_switched(const HaasWords::Switched& switched);
  void set_only(std::optional<gcode::Code>& there, const gcode::Code& code);

  const std::set<int>& passed_m_;
  bool is_haas_;
  HaasWords haas_;
  std::optional<gcode::Code> look_ahead_;
  bool polar_ = false;  ///< G16 holds
};

}  // namespace rmac::fanuc
