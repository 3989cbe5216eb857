#pragma once

#include <set>
#include <utility>
#include <vector>

#include "clients/legacy/gcode/blocks/block.hpp"
#include "clients/legacy/gcode/blocks/line.hpp"
#include "clients/legacy/rs274/blocks/parameters.hpp"

namespace rmac::rs274 {

using gcode::Block, gcode::Line, gcode::Word;

/// Reads lines of RS274/NGC as blocks.
class BlockReader {
 public:
  /// `passed_m`: M codes that mean nothing here.
  explicit BlockReader(std::set<int> passed_m = {}) : passed_m_(std::move(passed_m)) {}

  /// Sets the parameters that the line assigns, after all of its values were read, as the report has it. Throws a
  /// Refusal for what is no block.
  void read(const Line& line, Parameters& parameters, Block& block);

 private:
  struct Assignment {
    gcode::Name name;
    double value = 0;
  };

  void read_word(std::string_view text, std::size_t& at, const Parameters& parameters, Block& block);
  void read_assignment(std::string_view text, std::size_t& at, const Parameters& parameters);

  void add_m(double value, std::size_t place, Block& block);

  std::set<int> passed_m_;
  std::vector<Assignment> assignments_;
  bool passes_over_ = false;  ///< the block has one of those
};

}  // namespace rmac::rs274
