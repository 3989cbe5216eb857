#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "clients/legacy/apt/axis_systems.hpp"
#include "clients/legacy/apt/moves/motions.hpp"
#include "clients/legacy/apt/switches.hpp"
#include "clients/legacy/apt/tools.hpp"

namespace rmac::apt {

/// Carries out statements, each by its major word.
class Interpreter {
 public:
  Interpreter(const Options& options, Writer& writer);
  Interpreter(const Interpreter&) = delete;
  Interpreter& operator=(const Interpreter&) = delete;

  /// Throws a Refusal. False where the program ends.
  [[nodiscard]] bool execute(const Statement& statement);
  /// Where the text ends without FINI: refused, unless a tool path or the program ended before.
  void end(std::size_t place);
  [[nodiscard]] Coordinates& coordinates() noexcept { return coordinates_; }

 private:
  /// What a major word does.
  using Deed = void (*)(Interpreter&, Arguments&);
  struct Verb {
    Deed deed;
    bool moves;
  };

  [[nodiscard]] static const std::map<std::string_view, Verb>& verbs();
  [[nodiscard]] bool take_text(const Statement& statement);
  void dwell(Arguments& arguments);
  void stop(Arguments& arguments, bool optional);
  void load(Arguments& arguments);
  void end_program(Arguments& arguments);
  void end_path(Arguments& arguments);

  Writer& writer_;
  Coordinates coordinates_;
  Mover mover_;
  Motions motions_;
  Switches switches_;
  Tools tools_;
  AxisSystems systems_;
  std::string message_;  ///< of the PPRINT right before
  bool ended_ = false, path_ended_ = false;
};

}  // namespace rmac::apt
