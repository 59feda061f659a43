// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "cdprep/result.h"

namespace cdprep::build {

[[nodiscard]] inline Error bad_argument(const std::string& message) {
    return {ErrorCode::bad_argument, message};
}

}  // namespace cdprep::build
