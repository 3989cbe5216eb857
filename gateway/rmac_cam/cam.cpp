#include "gateway/rmac_cam/cam.hpp"

#include "gateway/mechanism/mechanism.hpp"

namespace rmac::gateway {

Cam::Cam(MotionSupervisor& supervisor, ServoLink& link, ToolRack& rack, std::function<Expected<>()> reset)
    : supervisor_(supervisor),
      link_(link),
      path_(device_, link.history),
      joints_(device_),
      maker_(device_, path_, joints_),
      frames_(device_, supervisor),
      forces_(device_, supervisor),
      tools_(device_, supervisor, rack, maker_),
      spindles_(device_, supervisor, link.history, tools_),
      cycle_(device_, supervisor, forces_, std::move(reset)),
      queue_(device_, supervisor, path_, maker_, tools_),
      cmm_moves_(device_, supervisor, maker_),
      positioning_(device_, supervisor, link, path_, maker_),
      flow_(device_, supervisor, spindles_),
      parking_(device_, supervisor, link, {path_, joints_, spindles_, tools_, forces_, flow_}),
      guard_(device_, supervisor, shape_) {}

void Cam::mechanism_changed(const sdk::DeviceObject* device, bool fresh) {
  device_.change(device);
  const std::shared_ptr<Mechanism> mechanism = device == nullptr ? nullptr : supervisor_.mechanism();
  shape_.mechanism_changed(device, mechanism == nullptr ? nullptr : mechanism->planner_model.kinematics,
                           link_.history.latest().cycle);
  path_.mechanism_changed(fresh);
  joints_.mechanism_changed(fresh);
  cycle_.mechanism_changed(fresh);
  tools_.mechanism_changed(fresh);
  spindles_.mechanism_changed();
  guard_.mechanism_changed(fresh);
  forces_.let_go();
}

}  // namespace rmac::gateway
