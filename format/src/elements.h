// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/format/elements.h"

namespace cdprep::format {

/// Returns the layout of an element type of the section table; each has a specialisation.
template <class T>
[[nodiscard]] Element element_of() noexcept;

}  // namespace cdprep::format
