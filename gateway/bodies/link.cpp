#include "gateway/bodies/link.hpp"

#include <algorithm>

namespace rmac::gateway {

std::optional<std::size_t> link_number(std::span<const std::string> chain, const std::string& name) {
  const auto place = [&](const std::string& entry) {
    return static_cast<std::size_t>(std::find(chain.begin(), chain.end(), entry) - chain.begin());
  };
  if (name == kTable) return 0;
  if (name == kSpindle) return chain.size() - 1;
  const std::size_t at = place(name);
  if (at == chain.size()) return std::nullopt;
  // On the table's side of the base, entry k is a joint with k links before it, and the link that it moves is the last
  // of them. The base is one of the entries, so behind it joint k of the chain leads to link k.
  return at;
}

}  // namespace rmac::gateway
