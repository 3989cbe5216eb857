#include "fakes.hpp"

namespace rmac::gateway::fakes {

FakeMachine::FakeMachine() = default;
FakeMachine::~FakeMachine() = default;

}  // namespace rmac::gateway::fakes
