#pragma once

#include "clients/legacy/program/arc_geometry.hpp"

namespace rmac::gcode {

using legacy::Arc, legacy::Plane, legacy::Point, legacy::Writer;

}  // namespace rmac::gcode
