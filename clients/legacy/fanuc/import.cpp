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
        system_(rules(dialect), interpreter_, flow_),
        extent_(options.assume_end) {
    variables_.set_system({[this](int number, std::size_t place) { return system_.read(number, place); },
                           [this](int number, gcode::Maybe value, std::string_view message, std::size_t place) {
                             writer_.at_line(flow_.number());
                             system_.write(number, value, message, place);
                           }});
  }

  tl::expected<Summary, Error> run() {
    return gcode::carry_out(
        flow_, writer_, extent_, [this](std::string_view text) { take(text); }, [this] { interpreter_.end(); });
  }

 private:
  void take(std::string_view text) {
    if (text.substr(std::min(flow_.words(), text.size())).starts_with('%')) return mark(text);
    const Ordered ordered = reader_.read(text, flow_.words(), variables_, interpreter_.modes(), block_);
    const HaasWords& own = reader_.haas();
    if (!block_.empty() || own.cycle) extent_.begin();
    const bool moves = moves_of(block_);
    if (!own.switched.empty()) interpreter_.require_no_contour(own.switched.front().place);
    haas::switch_on(own, block_, options_, interpreter_);
    if (execute(own.cycle)) return extent_.end();
    haas::switch_off(own, options_, interpreter_);
    flow_.go_on(ordered, moves);
  }

  /// The block, and the cycle that a Haas has in it. True where the program ends.
  bool execute(const std::optional<gcode::Code>& own_cycle) {
    std::optional<haas::Cycle> cycle;
    if (own_cycle && flow_.calls_behind_moves())
      refuse(own_cycle->place, "a cycle of many moves, behind each of which G66 would call; write G67 before it");
    if (own_cycle) cycle.emplace(*own_cycle, block_, interpreter_);
    const bool ends = interpreter_.execute(block_, flow_.line()).what == gcode::After::What::End;
    if (!cycle) return ends;
    for (gcode::Block& part : cycle->written_out(options_, interpreter_))
      static_cast<void>(interpreter_.execute(part, flow_.line()));
    if (cycle->leaves_place_open()) interpreter_.leave_place_open(haas::kBehindHoles);
    return false;
  }

  /// Whether G66 calls behind it.
  [[nodiscard]] static bool moves_of(const gcode::Block& block) {
    return (block.has_any("XYZ") || block.is_polar()) && (!block.g(gcode::GGroup::Once) || block.once(530));
  }

  void mark(std::string_view text) {
    require_line_end(text, flow_.words() + 1);
    if (extent_.mark(flow_.running())) interpreter_.end();
  }

  const Options& options_;
  Variables variables_;
  Writer writer_;
  gcode::Interpreter interpreter_;
  Flow flow_;
  BlockReader reader_;
  gcode::Block block_;
  SystemVariables system_;
  gcode::Extent extent_;
};

}  // namespace

bool may_pass_over(int number, Dialect dialect) noexcept {
  constexpr int kLocalCall = 97, kCall = 98, kReturn = 99;
  const bool is_haas = dialect == Dialect::Haas;
  if (number == kCall || number == kReturn || (is_haas && number == kLocalCall)) return false;
  if (const HaasM* own = is_haas ? find_haas_m(number) : nullptr) return own->use != HaasM::Use::As;
  const gcode::MCode* known = find_m(number);
  return known == nullptr || !known->refusal.empty();
}

bool switches_output(int number) noexcept {
  const HaasM* own = find_haas_m(number);
  return own != nullptr && own->use == HaasM::Use::SwitchOn;
}

tl::expected<Summary, Error> import_program(std::string_view program, const Options& options, Writer::Sink sink,
                                            Dialect dialect) {
  return Import(program, options, std::move(sink), dialect).run();
}

}  // namespace rmac::fanuc
