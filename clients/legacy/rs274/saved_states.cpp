#include "clients/legacy/rs274/saved_states.hpp"

#include "clients/legacy/gcode/blocks/refusal.hpp"

namespace rmac::rs274 {

namespace {

constexpr int kSave = 70, kForget = 71, kRestore = 72, kSaveUntilEnd = 73;

}  // namespace

void SavedStates::act(const gcode::After& code, std::size_t level) {
  switch (code.label) {
    case kSave:
    case kSaveUntilEnd:
      saved_.insert_or_assign(level, Saved{interpreter_.state(code.place), code.label == kSaveUntilEnd});
      return;
    case kForget:
      saved_.erase(level);
      return;
    case kRestore: {
      const auto saved = saved_.find(level);
      if (saved == saved_.end())
        gcode::refuse(code.place,
                      "M72 without an M70 or M73 before it in the same sub, or the program: nothing was saved there");
      return interpreter_.restore(saved->second.state, code.place);
    }
    default:
      return;
  }
}

void SavedStates::leave(std::size_t level, std::size_t place) {
  const auto saved = saved_.find(level);
  if (saved == saved_.end()) return;
  if (saved->second.until_end) interpreter_.restore(saved->second.state, place);
  saved_.erase(saved);
}

}  // namespace rmac::rs274
