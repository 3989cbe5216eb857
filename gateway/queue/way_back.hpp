#pragma once

#include <vector>

#include "gateway/queue/built_move.hpp"

namespace rmac::gateway {

/// What takes a program up again: the way from where `builder` stands to where `first` goes on, at most a millimetre,
/// and what is left of `first`. Empty where `first` is a tool change and the tool stands there. Frames may be others
/// than when the step was queued. Afterwards `builder` stands at its end; an error says how far the tool is from the
/// place, or which joint, and leaves `builder` alone.
[[nodiscard]] Expected<std::vector<BuiltMove>> build_rest_of(PathBuilder& builder, const ProgramStep& first);

}  // namespace rmac::gateway
