#include "gateway/rmac_cam/settings/cam_frame_settings.hpp"

#include "rmac/motion/frame.hpp"

namespace rmac::gateway {

Expected<> CamFrameSettings::set(const char* function, const Frames& frames) {
  return device_.require(function).and_then([&] { return supervisor_.require_rest(function); }).map([&] {
    supervisor_.set_frames(frames);
  });
}

Expected<> CamFrameSettings::set_part(const Frame& frame) {
  constexpr const char* kFunction = "SetPartFrame";
  return check_frame(frame, kFunction).and_then([&] { return set(kFunction, {normalized(frame), tool_interface()}); });
}

Frame CamFrameSettings::part() const {
  return supervisor_.wishes().frames.part;
}

Expected<> CamFrameSettings::set_tool_interface(const Frame& frame) {
  constexpr const char* kFunction = "SetToolInterfaceFrame";
  return check_frame(frame, kFunction).and_then([&] { return set(kFunction, {part(), normalized(frame)}); });
}

Frame CamFrameSettings::tool_interface() const {
  return supervisor_.wishes().frames.tool;
}

}  // namespace rmac::gateway
