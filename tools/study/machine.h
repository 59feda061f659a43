// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace cdprep::study {

/// What numbers were measured on: without it they mean nothing.
struct Machine {
    std::string processor;         ///< as it calls itself; "unknown" where it does not say
    std::size_t processors = 0;    ///< that the program may use
    std::uint64_t memory = 0;      ///< bytes
    std::uint64_t last_cache = 0;  ///< bytes of the largest cache; 0: not known
    std::string system;            ///< of the kernel: name and release
    std::string compiler;
    std::string build;    ///< CMake's build type
    std::string kernels;  ///< the table of kernels that answers: "scalar", "avx2", ...
};

/// Asks the system; the same for the life of a process.
[[nodiscard]] Machine describe_machine();

}  // namespace cdprep::study
