#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "gateway/controller/machine_state.hpp"
#include "gateway/controller/mechanism.hpp"
#include "gateway/controller/snapshot.hpp"

namespace rmac::gateway {

/// What the servo loop is to do beside following plans. Written whole under the motion supervisor's lock.
struct ServoWishes {
  bool power = false;
  bool reset = false;
  Frames frames;
  std::array<double, kMaxSpindles> spindle_rpm{};
  std::uint64_t outputs = 0;
  CycleState state = CycleState::Idle;  ///< goes into the samples
};

/// The little of a cycle that planning and the cycle states need.
struct ServoStatus {
  ServoProgress progress;
  std::uint64_t generation = 0;  ///< counts mechanisms put in; a status of another one is stale
  double t_s = 0;
  ServoState state = ServoState::Off;
  ServoFault fault;
  bool follows = false;  ///< joints follow the plan, and may be moved
  bool moving = false;
  std::uint64_t moves_done = 0;
  std::uint32_t joint_count = 0;
  std::uint32_t axis_count = 0;
  std::array<double, kMaxJoints> position_set{};
  std::array<double, kMaxSpindles> spindle_rpm{};
};

struct FaultRecord {
  double t_s = 0;
  std::uint64_t generation = 0;
  std::int64_t move_id = 0;
  double s_mm = 0;
  ServoFault fault;
};

/// Another mechanism for the servo loop, or none. It is put in between two cycles, at standstill; `refused` otherwise.
struct SwapRequest {
  enum class Result : std::uint8_t { Waiting, Done, Refused };
  Mechanism* next = nullptr;
  std::uint64_t generation = 0;
  std::atomic<Result> result{Result::Waiting};
};

/// Everything that the servo thread shares with others. No lock, and nobody allocates.
struct ServoLink {
  LatestValue<ServoWishes> wishes;
  std::atomic<SwapRequest*> swap{nullptr};

  SequenceLocked<ServoStatus> status;
  SequenceLocked<CycleSample> sample;
  SpscRing<CycleSample, 4096> samples;
  SpscRing<FaultRecord, 64> faults;
};

}  // namespace rmac::gateway
