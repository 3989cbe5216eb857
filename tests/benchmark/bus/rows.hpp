#pragma once

#include "figures.hpp"

namespace rmac::bench {

inline constexpr int kWantedTransactions = 10'000;

/// How long a Modbus transaction takes beyond its deadline, against peers of bad manners; nothing stale is taken.
void modbus_deadlines(Figures& figures, int transactions);

/// The bits of a cycle that the bus budget predicts, against those of the frames that master and drives exchange.
void predicted_bits(Figures& figures, bool quick);

}  // namespace rmac::bench
