#include "canopen/lss/fast_scan.hpp"

#include <fmt/format.h>

namespace rmac::fieldbus::canopen {
namespace {

constexpr std::uint8_t kBegin = 0x80, kLastPart = 3, kBits = 32;

}  // namespace

std::size_t FastScan::step(std::uint32_t number, std::uint8_t bit, std::uint8_t part, std::uint8_t next) {
  return master_
      .gather(LssCommand::FastScan,
              {byte(number, 0), byte(number, 1), byte(number, 2), byte(number, 3), bit, part, next},
              LssCommand::Identified, answer_time_)
      .frames.size();
}

bool FastScan::start() {
  return step(0, kBegin, 0, 0) > 0;
}

Expected<std::vector<Identity>> FastScan::find(std::size_t most) {
  // All that have no id answer the beginning: how long the slowest takes is how long each step has to be waited for.
  const auto begun = master_.gather(LssCommand::FastScan, {0, 0, 0, 0, kBegin, 0, 0}, LssCommand::Identified,
                                    master_.options().listen);
  if (begun.frames.empty()) return {};
  answer_time_ = std::max(answer_time_, 2 * begun.last);
  // Nobody has come to the last part yet: only who does not listen answers to it.
  if (step(0, 0, kLastPart, kLastPart) > 0) {
    master_.switch_all(false);
    if (start() && step(0, 0, kLastPart, kLastPart) > 0) {
      return failure(
          MinorCode::Other,
          "a node answers every step of a fast scan, so that no other can be told from it: switch it off and "
          "on, and if that does not help, give it its id alone or by its own switches");
    }
  }
  Search searched;
  for (int attempt = 0; attempt < 3; ++attempt) {
    searched = search(most);
    if (!searched.lost) return searched.found;
    answer_time_ *= 2;
  }
  if (searched.nobody) return {};
  return failure(MinorCode::CommTimeout,
                 fmt::format("nodes without an id answer at times and not at others, within {} ms too, so that none is "
                             "known for sure; connect them one after the other",
                             std::chrono::duration_cast<std::chrono::milliseconds>(answer_time_ / 2).count()));
}

FastScan::Search FastScan::search(std::size_t most) {
  Search result;
  std::vector<Prefix> open{Prefix()};
  while (!open.empty() && result.found.size() < most) {
    Prefix prefix = open.back();
    open.pop_back();
    const std::size_t nodes = replay(prefix) ? descend(prefix, open) : 0;
    if (nodes == 0) {
      result.nobody = prefix.part == 0 && prefix.bit >= kBits - 1;
      result.lost = true;
      return result;
    }
    const auto& [vendor, product, revision, serial] = prefix.parts;
    result.found.insert(result.found.end(), nodes, Identity{vendor, product, revision, serial});
  }
  return result;
}

bool FastScan::replay(const Prefix& prefix) {
  if (!start()) return false;
  for (std::uint8_t part = 0; part < prefix.part; ++part) {
    if (step(prefix.parts.at(part), 0, part, static_cast<std::uint8_t>(part + 1)) == 0) return false;
  }
  return true;
}

std::size_t FastScan::descend(Prefix& prefix, std::vector<Prefix>& others) {
  for (;; ++prefix.part, prefix.bit = kBits) {
    if (!narrow(prefix, others)) return 0;
    // From the last part they go nowhere, lest they configure.
    const auto next = std::min<std::uint8_t>(prefix.part + 1, kLastPart);
    const std::size_t nodes = step(prefix.parts.at(prefix.part), 0, prefix.part, next);
    if (nodes == 0 || prefix.part == kLastPart) return nodes;
  }
}

bool FastScan::narrow(Prefix& prefix, std::vector<Prefix>& others) {
  std::uint32_t& number = prefix.parts.at(prefix.part);
  const auto fits = [&](std::uint32_t guess) { return step(guess, prefix.bit, prefix.part, prefix.part) > 0; };
  while (prefix.bit > 0) {
    const bool first = prefix.bit-- == kBits;
    const std::uint32_t set = number | 1U << prefix.bit;
    const bool can_be_clear = fits(number);
    // Somebody fits all bits before this one, so it is set where it is not clear; of the first nothing is known.
    if (can_be_clear || first) {
      const bool can_be_set = fits(set);
      if (!can_be_clear && !can_be_set) return false;
      if (can_be_clear && can_be_set) {
        others.push_back(prefix);
        others.back().parts.at(prefix.part) = set;
      }
    }
    if (!can_be_clear) number = set;
  }
  return true;
}

Expected<> FastScan::claim(const Identity& identity) {
  const Prefix prefix{.parts = parts_of(identity), .part = kLastPart};
  // The step from the last part back to the first is what has it configure.
  if (replay(prefix) && step(prefix.parts.back(), 0, kLastPart, 0) > 0) return {};
  return failure(MinorCode::CommTimeout,
                 fmt::format("{} was found and does not answer any more; is it still connected?", to_string(identity)));
}

}  // namespace rmac::fieldbus::canopen
