// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace cdprep::study {

/// The machine of a measurement. Measured times mean nothing without it.
struct Machine {
    std::string processor;         ///< its own name; "unknown" if it gives none
    std::size_t processors = 0;    ///< the number that the program may use
    std::uint64_t memory = 0;      ///< bytes
    std::uint64_t last_cache = 0;  ///< bytes of the largest cache; 0: not known
    std::string system;            ///< of the kernel: name and release
    std::string compiler;
    std::string build;    ///< CMake's build type
    std::string kernels;  ///< the kernel table in use: "scalar", "avx2", ...
};

/// Returns the description of this machine. It stays the same during a process.
[[nodiscard]] Machine describe_machine();

/// Returns the machine as an object of JSON, in the type of nlohmann-json that the caller uses.
template <class Json>
[[nodiscard]] Json machine_json(const Machine& machine) {
    return {{"processor", machine.processor}, {"processors", machine.processors},
            {"memory_bytes", machine.memory}, {"last_cache_bytes", machine.last_cache},
            {"system", machine.system},       {"compiler", machine.compiler},
            {"build", machine.build},         {"kernels", machine.kernels}};
}

}  // namespace cdprep::study
