#pragma once

#include <string_view>

namespace rmac::vdrive {

/// The data sheet that the drives are made from unless another is named: rmac-vdrive.eds.
[[nodiscard]] std::string_view sheet_text();

}  // namespace rmac::vdrive
