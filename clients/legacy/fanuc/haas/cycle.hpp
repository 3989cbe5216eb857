#pragma once

#include <map>
#include <string_view>
#include <vector>

#include "clients/legacy/gcode/blocks/block.hpp"
#include "clients/legacy/gcode/interpreter.hpp"

namespace rmac::fanuc::haas {

/// Why the place of the tool is not known there.
inline constexpr std::string_view kBehindHoles =
    "where the tool is behind the holes of G70 and G71, manuals leave open";

/// G12, G13, G70 or G71 of a block: what they mean is written out as blocks of plain moves and holes.
class Cycle {
 public:
  /// Takes the words that are its own out of the block. The rest, which is left, is carried out before the blocks that
  /// it is written out as. Throws a Refusal for what does not go with it.
  Cycle(const gcode::Code& code, gcode::Block& block, const gcode::Interpreter& interpreter);

  /// Where the tool is behind it in X and Y, manuals leave open.
  [[nodiscard]] bool leaves_place_open() const noexcept { return !is_pocket(); }
  /// By what holds behind the rest. Throws a Refusal.
  [[nodiscard]] std::vector<gcode::Block> written_out(const gcode::Options& options,
                                                      const gcode::Interpreter& interpreter) const;

 private:
  struct Lengths {
    const gcode::Modes& modes;
    std::size_t place = 0;
    /// A way of so many mm, in the unit that is in force.
    [[nodiscard]] gcode::Word way(double mm) const { return {mm / modes.unit(place), place, false, true}; }
  };

  [[nodiscard]] bool is_pocket() const noexcept;
  /// What of the block would drill where the tool is only sets what holes have.
  void take_holes(gcode::Block& block) const;
  [[nodiscard]] const gcode::Word& word(char letter) const;
  [[nodiscard]] const gcode::Word* find(char letter) const;
  [[nodiscard]] int count(char letter, int least) const;
  [[nodiscard]] std::vector<gcode::Block> pocket(const gcode::Options& options,
                                                 const gcode::Interpreter& interpreter) const;
  [[nodiscard]] std::vector<double> radii_mm(const gcode::Modes& modes, double tool_mm) const;
  void add_circles(const std::vector<double>& radii, const Lengths& lengths, std::vector<gcode::Block>& blocks) const;
  [[nodiscard]] std::vector<gcode::Block> holes(const gcode::Interpreter& interpreter) const;

  gcode::Code code_;
  std::map<char, gcode::Word> words_;
  int motion_before_ = gcode::Modes::kNoMotion;
};

}  // namespace rmac::fanuc::haas
