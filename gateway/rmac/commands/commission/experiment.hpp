#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gateway/rmac/plots/plot_program.hpp"
#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/failure.hpp"

// A machine is moved, the record of it is kept, and a program of `plots/` says what it shows.

namespace rmac::cli {

/// Does `work` with the lease, and tells it of faults; what goes wrong stops the machine before the lease goes back.
[[nodiscard]] Result<> commission(Connection& connection,
                                  const std::function<Result<>(const std::string& fault)>& work);

/// Puts the record of the seconds up to now into a file.
[[nodiscard]] Result<> keep_record(Connection& connection, const TemporaryFile& file);

/// What a program of `plots/` answers.
[[nodiscard]] Result<nlohmann::json> plot_answer(const std::string& program, const std::vector<std::string>& arguments);

/// A list of numbers, to five digits.
[[nodiscard]] std::string list_text(const nlohmann::json& numbers);

}  // namespace rmac::cli
