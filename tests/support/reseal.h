// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

namespace cdprep::test {

/// Makes every checksum and the stated size right again, as far as the section
/// table makes sense, so that a changed file is judged by its content. Header
/// fields keep the values that they have.
void reseal(std::span<std::byte> file);

}  // namespace cdprep::test
