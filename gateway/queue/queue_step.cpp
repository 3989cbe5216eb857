#include "gateway/queue/queue_step.hpp"

#include <fmt/format.h>

namespace rmac::gateway {
namespace {

struct Noun {
  const char* operator()(const Dwell& /*dwell*/) const { return "dwell"; }
  const char* operator()(const ProgramStop& stop) const { return stop.optional ? "optional stop" : "program stop"; }
  const char* operator()(const AwaitInput& /*input*/) const { return "wait for an input"; }
};

}  // namespace

std::string name_of(const InTurn& turn) {
  return fmt::format("{} {}", std::visit(Noun{}, turn.what), turn.move_id);
}

}  // namespace rmac::gateway
