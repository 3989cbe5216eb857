#include "gateway/simulators/vdrive/outlet.hpp"

#include <algorithm>

namespace rmac::vdrive {

void Outlet::send(std::uint16_t id, const Bytes& data) {
  CanFrame frame;
  frame.id = id;
  frame.size = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), frame.data.begin());
  frames_.push_back(frame);
}

std::vector<CanFrame> Outlet::take(Time now) {
  std::vector<CanFrame> frames = std::exchange(frames_, {});
  if (mute_) frames.clear();
  if (delay_.count() == 0 && delayed_.empty()) return frames;
  for (const CanFrame& frame : frames) delayed_.emplace_back(now + delay_, frame);
  frames.clear();
  while (!delayed_.empty() && delayed_.front().first <= now) {
    frames.push_back(delayed_.front().second);
    delayed_.pop_front();
  }
  return frames;
}

void Outlet::clear() {
  frames_.clear();
  delayed_.clear();
}

}  // namespace rmac::vdrive
