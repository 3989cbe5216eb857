#pragma once

#include "clients/legacy/program/refusal.hpp"

namespace rmac::fanuc {

// Places are those of Line::text().
using legacy::Refusal, legacy::refuse;

}  // namespace rmac::fanuc
