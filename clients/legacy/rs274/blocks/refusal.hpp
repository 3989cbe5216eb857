#pragma once

#include "clients/legacy/program/refusal.hpp"

namespace rmac::rs274 {

// Places are those of Line::text().
using legacy::Refusal, legacy::refuse;

}  // namespace rmac::rs274
