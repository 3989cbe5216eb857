#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "clients/legacy/rs274/blocks/codes.hpp"
#include "clients/legacy/rs274/blocks/line.hpp"
#include "clients/legacy/rs274/blocks/parameters.hpp"

namespace rmac::rs274 {

struct Word {
  double value = 0;
  std::size_t place = 0;
};

/// One code of a modal group, where the block has one.
struct Code {
  int number = 0;  ///< of G its tenfold
  std::size_t place = 0;
};

/// What one line says, before anything of it is done. Reading it sets the parameters that it assigns, after all of its
/// values were read, as the report has it.
class Block {
 public:
  /// Throws a Refusal for what is no block, for two codes of one group, and for a code that is not taken.
  void read(const Line& line, Parameters& parameters);

  /// Nothing but comments, numbers of lines and parameters.
  [[nodiscard]] bool empty() const noexcept { return words_ == 0 && codes_ == 0; }
  [[nodiscard]] const std::optional<Code>& g(GGroup group) const { return g_.at(static_cast<std::size_t>(group)); }
  [[nodiscard]] const std::optional<Code>& m(MGroup group) const { return m_.at(static_cast<std::size_t>(group)); }
  /// Whether the one code of group 0 is this one.
  [[nodiscard]] bool once(int tenfold) const { return g(GGroup::Once) && g(GGroup::Once)->number == tenfold; }

  /// How many codes it has.
  [[nodiscard]] std::size_t codes() const noexcept { return codes_; }
  /// Whether it has a code beside one of motion.
  [[nodiscard]] bool does_more_than_move() const noexcept;

  [[nodiscard]] bool has(char letter) const noexcept { return (words_ & bit(letter)) != 0; }
  [[nodiscard]] bool has_any(std::string_view letters) const noexcept;
  /// Where a word stands that the block has.
  [[nodiscard]] std::size_t place(char letter) const { return word_.at(static_cast<std::size_t>(letter - 'A')).place; }
  /// A word that the block has; whoever asks for it, uses it.
  [[nodiscard]] const Word& use(char letter);
  /// The same, where the block has it.
  [[nodiscard]] const Word* find(char letter) { return has(letter) ? &use(letter) : nullptr; }
  /// Throws a Refusal where nothing used a word.
  void require_all_used() const;

 private:
  static constexpr std::uint32_t bit(char letter) noexcept { return 1U << static_cast<unsigned>(letter - 'A'); }

  struct Assignment {
    std::variant<int, std::string_view> name;
    double value = 0;
  };

  void read_word(std::string_view text, std::size_t& at, Parameters& parameters);
  void read_assignment(std::string_view text, std::size_t& at, Parameters& parameters);
  void add_g(double value, std::size_t place);
  void add_m(double value, std::size_t place);
  void check_together() const;

  std::array<std::optional<Code>, kGGroups> g_{};
  std::array<std::optional<Code>, kMGroups> m_{};
  std::array<Word, 26> word_{};
  std::uint32_t words_ = 0, used_ = 0;
  std::size_t codes_ = 0;
  std::vector<Assignment> assignments_;
};

}  // namespace rmac::rs274
