// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "c/call.h"

namespace cdprep::c {

/// A block that an allocator gave, or none. Freed by release() alone.
struct Memory {
    cdprep_allocator allocator{};
    void* start = nullptr;
    std::size_t size = 0;
};

/// Reads an allocator; null gives the default one.
int read_allocator(Call& call, const Name& name, const cdprep_allocator* given,
                   cdprep_allocator& allocator) noexcept;

/// Allocates `size` bytes, aligned to CDPREP_ALIGNMENT; none for 0.
int allocate(Call& call, const cdprep_allocator& allocator, std::size_t size,
             Memory& memory) noexcept;

void release(const Memory& memory) noexcept;

}  // namespace cdprep::c
