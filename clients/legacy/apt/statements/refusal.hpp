#pragma once

#include "clients/legacy/program/refusal.hpp"

namespace rmac::apt {

// Places are those of the program's text, in bytes.
using legacy::Refusal, legacy::refuse;

}  // namespace rmac::apt
