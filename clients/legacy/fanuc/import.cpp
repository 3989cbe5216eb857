#include "clients/legacy/fanuc/import.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "clients/legacy/fanuc/blocks/reader.hpp"
#include "clients/legacy/fanuc/blocks/refusal.hpp"
#include "clients/legacy/fanuc/flow/flow.hpp"
#include "clients/legacy/fanuc/haas/cycle.hpp"
#include "clients/legacy/fanuc/haas/switches.hpp"
#include "clients/legacy/fanuc/rules.hpp"
#include "clients/legacy/fanuc/system_variables.hpp"
#include "clients/legacy/gcode/flow/carry_out.hpp"
#include "clients/legacy/gcode/interpreter.hpp"

namespace rmac::fanuc {

namespace {

/// One import.
class Import {
 public:
  Import(std::string_view program, const Options& options, Writer::Sink sink, Dialect dialect)
      : options_(options),
        variables_(options.variables),
        writer_(std::move(sink), options.ids),
        interpreter_(options, rules(dialect), writer_),
        flow_(program, options.block_delete, options.bounds, variables_, interpreter_.modes(),
              [this] {
                return gcode::Made{writer_.moves(), writer_.bytes()};
              }),
        reader_(options.passed_m, dialect),
        own_switches_(options, writer_),
        system_(rules(dialect), interpreter_, flow_, writer_),
        extent_(options.assume_end) {
    variables_.set_system({[this](int number, std::size_t place) { return system_.read(number, place); },
                           [this](int number, gcode::Maybe value, std::string_view message, std::size_t place) {
                             writer_.at_line(flow_.number());
                             system_.write(number, value, message, place);
                           }});
  }

  tl::expected<Summary, Error> run() {
    return gcode::carry_out(
        flow_, writer_, extent_, [this](std::string_view text) { take(text); },
        [this] {
          interpreter_.end_all();
          own_switches_.all_off();
        });
  }

 private:
  void take(std::string_view text) {
    if (text.substr(std::min(flow_.words(), text.size())).starts_with('%')) return mark(text);
    const Ordered ordered = reader_.read(text, flow_.words(), variables_, interpreter_.modes(), block_);
    const HaasWords& own = reader_.haas();
    if (!block_.empty() || own.cycle) extent_.begin();
    const bool moves = moves_of(block_);
    if (!own.switched.empty()) interpreter_.require_no_contour(own.switched.front().place);
    if (block_.m(gcode::MGroup::Tool)) own_switches_.all_off();
    own_switches_.on(own);
    if (execute(own.cycle)) return extent_.end();
    own_switches_.off(own);
    flow_.go_on(ordered, moves);
  }

  /// The block, and the cycle that a Haas has in it. True where the program ends.
  bool execute(const std::optional<gcode::Code>& own_cycle) {
    std::optional<haas::Cycle> cycle;
    if (own_cycle && flow_.calls_behind_moves())
      refuse(own_cycle->place, "a cycle of many moves, behind each of which G66 would call; write G67 before it");
    if (own_cycle) cycle.emplace(*own_cycle, block_, interpreter_);
    const bool ends = interpreter_.execute(block_, flow_.line()).what == gcode::After::What::End;
    if (ends) own_switches_.all_off();
    if (!cycle) return ends;
    for (gcode::Block& part : cycle->written_out(options_, interpreter_))
      static_cast<void>(interpreter_.execute(part, flow_.line()));
    return false;
  }

  /// Whether G66 calls behind it.
  [[nodiscard]] static bool moves_of(const gcode::Block& block) {
    return (block.has_any("XYZ") || block.is_polar()) && (!block.g(gcode::GGroup::Once) || block.once(530));
  }

  void mark(std::string_view text) {
    require_line_end(text, flow_.words() + 1);
    if (extent_.mark(flow_.running())) interpreter_.end(0);
  }

  const Options& options_;
  Variables variables_;
  Writer writer_;
  gcode::Interpreter interpreter_;
  Flow flow_;
  BlockReader reader_;
  haas::Switches own_switches_;
  gcode::Block block_;
  SystemVariables system_;
  gcode::Extent extent_;
};

}  // namespace

tl::expected<Summary, Error> import_program(std::string_view program, const Options& options, Writer::Sink sink,
                                            Dialect dialect) {
  return Import(program, options, std::move(sink), dialect).run();
}

}  // namespace rmac::fanuc
