#include "gateway/rmac/all_commands.hpp"
#include "gateway/rmac/commands/command_line.hpp"

int main(int count, char** words) {
  return rmac::cli::carry_out(rmac::cli::all_commands(), count, words);
}
