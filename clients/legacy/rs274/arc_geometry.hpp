#pragma once

#include "clients/legacy/program/arc_geometry.hpp"

namespace rmac::rs274 {

using legacy::Arc, legacy::Plane, legacy::Point, legacy::Writer;

}  // namespace rmac::rs274
