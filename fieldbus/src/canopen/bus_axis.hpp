#pragma once

#include <algorithm>
#include <vector>

#include "canopen/boot_plan.hpp"
#include "canopen/watch/sync_answers.hpp"
#include "rmac/fieldbus/canopen/canopen_config.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"

namespace rmac::fieldbus::canopen {

/// An axis as its bus has it: where its node is, and what came of it.
struct BusAxis {
  AxisConfig config;
  std::size_t node = 0;  ///< its place among the bus's nodes
  /// One PDO of its answers.
  struct Answer {
    std::uint16_t id = 0;
    std::vector<MappedObject> contents;
    std::uint32_t unanswered = 0;  ///< SYNCs
    bool answered = false;         ///< since its node came up
    ObjectAddress transmission_type;
    SyncAnswers count;
  };
  std::vector<Answer> answers;
  DriveFeedback feedback;

  /// Axis of the node at `place`, with one answer or two.
  [[nodiscard]] static BusAxis of(const AxisConfig& axis, std::size_t place) {
    BusAxis made{.config = axis, .node = place, .answers = {}, .feedback = {}};
    const auto answer = [&](std::uint16_t id, const std::vector<MappedObject>& contents, bool second) {
      made.answers.push_back(
          {.id = id, .contents = contents, .transmission_type = transmission_type(axis, second), .count = {}});
    };
    answer(answer_id(axis), axis.answers, false);
    if (!axis.more_answers.empty()) answer(more_answers_id(axis), axis.more_answers, true);
    return made;
  }

  void forget() noexcept {
    for (Answer& answer : answers) answer.answered = false;
  }
  /// A SYNC was sent: each PDO is to come once more.
  void sync() noexcept {
    for (Answer& answer : answers) answer.count.sync();
  }
  [[nodiscard]] bool answered() const noexcept {
    return std::all_of(answers.begin(), answers.end(), [](const Answer& answer) { return answer.answered; });
  }
  [[nodiscard]] std::uint32_t unanswered() const noexcept {
    std::uint32_t most = 0;
    for (const Answer& answer : answers) most = std::max(most, answer.unanswered);
    return most;
  }
  /// Among its setpoints.
  [[nodiscard]] bool is_told(std::uint16_t index) const noexcept {
    const auto same = [index](const MappedObject& mapped) { return mapped.object.index == index; };
    return std::any_of(config.setpoints.begin(), config.setpoints.end(), same) ||
           std::any_of(config.more_setpoints.begin(), config.more_setpoints.end(), same);
  }
  /// Told in one of its PDOs.
  [[nodiscard]] bool tells(std::uint16_t index) const noexcept {
    return std::any_of(answers.begin(), answers.end(), [index](const Answer& answer) {
      return std::any_of(answer.contents.begin(), answer.contents.end(),
                         [index](const MappedObject& mapped) { return mapped.object.index == index; });
    });
  }
};

}  // namespace rmac::fieldbus::canopen
