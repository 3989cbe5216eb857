#pragma once

#include <set>

#include "clients/legacy/fanuc/blocks/haas_codes.hpp"
#include "clients/legacy/gcode/modes/modes.hpp"

namespace rmac::fanuc::haas {

/// M73, M83 and M88, which switch on what an option gives a name of the machine's outputs, and M74, M84 and M89. A
/// change of tool and the program's end switch off what is on.
class Switches {
 public:
  Switches(const gcode::Options& options, gcode::Writer& writer) : options_(options), writer_(writer) {}

  /// What a block switches on, before it moves. Throws a Refusal where nothing says which output that is.
  void on(const HaasWords& words);
  /// What it switches off, behind that.
  void off(const HaasWords& words);
  void all_off();

 private:
  void write(int number, bool on);

  const gcode::Options& options_;
  gcode::Writer& writer_;
  std::set<int> on_;
};

}  // namespace rmac::fanuc::haas
