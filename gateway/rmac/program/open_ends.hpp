#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>

namespace rmac::cli {

/// Keeps a refused move from leaving a gap that a later one jumps over. Moves are sent before those ahead of them are
/// answered. When one is refused, the appliance refuses the next too, because that begins elsewhere than the queue
/// ends: unless it begins anywhere, or just there. Such a move waits until those ahead of it are answered.
class OpenEnds {
 public:
  using Point = std::array<double, 3>;  ///< of the tool tip, in mm

  /// Where a move begins and ends; none where its parameters do not tell, as of a move in joint space.
  struct Reach {
    std::optional<Point> begin;
    std::optional<Point> end;
  };
  /// By the parameters of a request, which may be anything.
  [[nodiscard]] static Reach of(const nlohmann::json& params);

  /// Whether a move may go out right behind the last that was sent.
  [[nodiscard]] bool may_follow(const Reach& move) const;
  void sent(const Reach& move);
  /// The first of those that were sent is answered.
  void answered();
  /// Another request may move the tool, or its frame.
  void forget();

 private:
  /// Of the last move that was answered, then of those that are not. None: unknown.
  std::deque<std::optional<Point>> ends_{std::nullopt};
};

}  // namespace rmac::cli
