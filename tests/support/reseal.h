// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

namespace cdprep::test {

/// Corrects every checksum and the stated size, as far as the section table is valid. A changed
/// file is then judged by its content. Header fields keep their values.
void reseal(std::span<std::byte> file);

}  // namespace cdprep::test
