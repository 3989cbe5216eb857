#include "gateway/queue/built_move.hpp"

#include <optional>
#include <utility>

namespace rmac::gateway {

Expected<std::vector<BuiltMove>> build_moves(PathBuilder& builder, const std::vector<PartOfMove>& parts) {
  // A single move that is refused leaves the builder as it was.
  std::optional<PathBuilder> before;
  if (parts.size() > 1) before = builder;
  std::vector<BuiltMove> built;
  for (const PartOfMove& part : parts) {
    ProgramStep as_sent = step_at(builder, *part.move);
    auto segments = builder.build(*part.move);
    if (!segments) {
      if (before) builder = std::move(*before);
      return tl::unexpected(segments.error());
    }
    built.push_back({std::move(as_sent), part.part, std::move(*segments)});
  }
  return built;
}

}  // namespace rmac::gateway
