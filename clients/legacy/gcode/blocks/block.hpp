#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "clients/legacy/gcode/blocks/codes.hpp"

namespace rmac::gcode {

struct Word {
  double value = 0;
  std::size_t place = 0;
  bool whole = false;     ///< it has no decimal point, where that counts
  bool relative = false;  ///< a way from where the tool is, whatever mode is in force
};

/// One code of a modal group, where the block has one.
struct Code {
  int number = 0;  ///< of G its tenfold
  std::size_t place = 0;
};

/// What one line says, before anything of it is done. A language's reader puts it together.
class Block {
 public:
  void clear() noexcept;
  /// Throws a Refusal for two codes of one group, and for a code that is not taken.
  void add_g(const GCode& code, std::size_t place);
  void add_m(const MCode& code, std::size_t place);
  /// Throws a Refusal for two words of one letter.
  void add_word(char letter, const Word& word);
  /// A word that the block has, and has no more then.
  Word take(char letter) noexcept;
  /// @ and ^, as above.
  void add_polar_radius(const Word& word);
  void add_polar_angle(const Word& word);
  /// Throws a Refusal for what does not go together.
  void check_together() const;

  /// Nothing but comments, numbers of lines and parameters.
  [[nodiscard]] bool empty() const noexcept { return words_ == 0 && codes_ == 0 && !is_polar(); }
  [[nodiscard]] const std::optional<Code>& g(GGroup group) const { return g_.at(static_cast<std::size_t>(group)); }
  [[nodiscard]] const std::optional<Code>& m(MGroup group) const { return m_.at(static_cast<std::size_t>(group)); }
  /// Whether the one code of group 0 is this one.
  [[nodiscard]] bool once(int tenfold) const { return g(GGroup::Once) && g(GGroup::Once)->number == tenfold; }
  /// Whether G10, G28, G30, G52 or G92 has X, Y and Z, which are no end of a motion then.
  [[nodiscard]] bool axes_are_taken() const;

  /// How many codes it has.
  [[nodiscard]] std::size_t codes() const noexcept { return codes_; }
  /// Whether it has a code beside one of motion.
  [[nodiscard]] bool does_more_than_move() const noexcept;

  [[nodiscard]] bool has(char letter) const noexcept { return (words_ & bit(letter)) != 0; }
  [[nodiscard]] bool has_any(std::string_view letters) const noexcept;
  /// Where a word stands that the block has.
  [[nodiscard]] std::size_t place(char letter) const { return word_.at(static_cast<std::size_t>(letter - 'A')).place; }
  [[nodiscard]] bool is_polar() const noexcept { return polar_radius_ || polar_angle_; }
  [[nodiscard]] const std::optional<Word>& polar_radius() const noexcept { return polar_radius_; }
  [[nodiscard]] const std::optional<Word>& polar_angle() const noexcept { return polar_angle_; }
  /// A word that the block has; whoever asks for it, uses it.
  [[nodiscard]] const Word& use(char letter);
  /// The same, where the block has it.
  [[nodiscard]] const Word* find(char letter) { return has(letter) ? &use(letter) : nullptr; }
  /// Throws a Refusal where nothing used a word.
  void require_all_used() const;

 private:
  static constexpr std::uint32_t bit(char letter) noexcept { return 1U << static_cast<unsigned>(letter - 'A'); }

  std::array<std::optional<Code>, kGGroups> g_{};
  std::array<std::optional<Code>, kMGroups> m_{};
  std::array<Word, 26> word_{};
  std::optional<Word> polar_radius_, polar_angle_;
  std::uint32_t words_ = 0, used_ = 0;
  std::size_t codes_ = 0;
};

/// As programs write it: G92.1 of 921.
[[nodiscard]] std::string g_name(int tenfold);

}  // namespace rmac::gcode
