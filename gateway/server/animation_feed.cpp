#include "gateway/server/animation_feed.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/api/topics.hpp"
#include "gateway/json/printable.hpp"

namespace rmac::gateway {
namespace {

/// The members of a notification but for its samples, without braces.
std::string head_of(const Scene& scene) {
  const MachineDrawing& drawing = *scene.drawing;
  std::string head = fmt::format(R"("geometry":{},"machine":{},"missing":{},"virtual":{},"tool":{})", drawing.number,
                                 drawing.machine.empty() ? "null" : text_of(drawing.machine), text_of(drawing.missing),
                                 scene.virtual_mode, scene.tool ? std::to_string(*scene.tool) : "null");
  head += R"(,"part_frame":)";
  append_frame(scene.frames.part, head);
  head += R"(,"tool_frame":)";
  append_frame(scene.frames.tool, head);
  return head;
}

}  // namespace

void AnimationFeed::start(double every_cycles, std::int64_t since) noexcept {
  pace_.start(every_cycles, since);
  told_ = -1;
}

void AnimationFeed::take(const CycleSample& sample) {
  if (!pace_.due(sample.cycle)) return;
  const Scene scene = look_();
  const MachineDrawing& drawing = *scene.drawing;
  // What was written before the machine was changed is handed out after that.
  const bool shows =
      drawing.links && sample.cycle > drawing.after_cycle && sample.joint_count == drawing.links->joint_count();
  if (!shows && (drawing.links || told_ == drawing.number)) return;
  if (std::string head = head_of(scene); head != head_) {
    close();
    head_ = std::move(head);
  }
  if (shows) {
    if (!samples_.empty()) samples_ += ',';
    append_animation(sample, *drawing.links, samples_);
    told_ = -1;
  } else {
    told_ = drawing.number;
    lines_.push_back(notification(topic::kAnimation, fmt::format("{{{},\"samples\":[]}}", head_)));
    head_.clear();
  }
}

void AnimationFeed::close() {
  if (samples_.empty()) return;
  lines_.push_back(notification(topic::kAnimation, fmt::format("{{{},\"samples\":[{}]}}", head_, samples_)));
  samples_.clear();
}

void AnimationFeed::take_out(std::vector<std::string>& lines) {
  close();
  for (std::string& line : lines_) lines.push_back(std::move(line));
  lines_.clear();
}

}  // namespace rmac::gateway
