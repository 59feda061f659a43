// SPDX-License-Identifier: MIT
// tests/full/mutants compiles this into every file: CDPREP_MUTANT is the one that is on, and
// CDPREP_MUTANTS_MET a file that is told which were met since the last test began.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>

inline int chosen_mutant() noexcept {
    const char* chosen = std::getenv("CDPREP_MUTANT");
    return chosen == nullptr ? 0 : std::atoi(chosen);
}

inline const int kChosenMutant = chosen_mutant();
inline const char* const kMutantsMet = std::getenv("CDPREP_MUTANTS_MET");
inline std::atomic<bool> mutant_met[4096];

inline void tell_mutants_met(const char* text) noexcept {
    char line[512];
    const int size = std::snprintf(line, sizeof line, "%s\n", text);
    const int file = open(kMutantsMet, O_WRONLY | O_APPEND | O_CREAT, 0666);
    if (write(file, line, static_cast<std::size_t>(size)) != size) std::abort();
    close(file);
}

inline bool cdprep_mutant(int id) noexcept {
    if (kMutantsMet != nullptr && !mutant_met[id].exchange(true)) {
        char number[16];
        std::snprintf(number, sizeof number, "%d", id);
        tell_mutants_met(number);
    }
    return id == kChosenMutant;
}
