#include "gateway/buses/device_descriptions.hpp"

namespace rmac::gateway {

fieldbus::canopen::FindDescription find_descriptions(const ModuleLoader& loader) {
  return [&loader](const std::string& kind, const std::string& name) {
    return loader.find_file("canopen", name, "." + kind, kind == "eds" ? "EDS" : "DCF")
        .and_then(fieldbus::eds::read_device_description);
  };
}

}  // namespace rmac::gateway
