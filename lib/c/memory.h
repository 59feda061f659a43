// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "c/call.h"

namespace cdprep::c {

/// A block from an allocator, or none. Only release() frees it.
struct Memory {
    cdprep_allocator allocator{};
    void* start = nullptr;
    std::size_t size = 0;
};

/// Returns a size rounded up to a multiple of CDPREP_ALIGNMENT.
template <std::unsigned_integral Size>
constexpr Size aligned(Size size) noexcept {
    return (size + CDPREP_ALIGNMENT - 1) / CDPREP_ALIGNMENT * CDPREP_ALIGNMENT;
}

/// Reads an allocator; null gives the default one.
int read_allocator(Call& call, const Name& name, const cdprep_allocator* given,
                   cdprep_allocator& allocator) noexcept;

/// The argument that most functions take their allocator from.
inline constexpr Name kAllocatorOfOptions = {"options", Name::kNone, "allocator"};

/// Allocates `size` bytes, aligned to CDPREP_ALIGNMENT. Allocates nothing for 0.
int allocate(Call& call, const cdprep_allocator& allocator, std::size_t size, Memory& memory,
             const Name& name = kAllocatorOfOptions) noexcept;

/// Stores the size of a block that is needed for `what`, such as "The scene". Fails if no memory
/// holds it. With 32 bits, limits may ask for more.
int check_size(Call& call, const char* what, std::uint64_t needed, std::size_t& size) noexcept;

void release(const Memory& memory) noexcept;

/// Memory of the caller, from the arguments `memory` and `size`; null to allocate one block.
struct Given {
    void* start;
    std::size_t size;
    Name allocator = kAllocatorOfOptions;
};

/// Refuses memory that is smaller than `needed` bytes, misaligned, or given together with an
/// allocator. `allocator` is that of the caller, or null.
int check_memory(Call& call, const Given& given, std::size_t needed,
                 const cdprep_allocator* allocator) noexcept;

/// A block that is released unless it is taken over, also when an exception is thrown.
class OwnedMemory {
public:
    OwnedMemory() noexcept = default;
    OwnedMemory(const OwnedMemory&) = delete;
    OwnedMemory& operator=(const OwnedMemory&) = delete;
    ~OwnedMemory();

    int allocate(Call& call, const cdprep_allocator& allocator, std::size_t size,
                 const Name& name = kAllocatorOfOptions) noexcept;
    [[nodiscard]] const Memory& get() const noexcept {
        return memory_;
    }
    /// Hands the block over.
    [[nodiscard]] Memory take() noexcept {
        return std::exchange(memory_, {});
    }

private:
    Memory memory_;
};

/// Stores the start of the caller's memory. If none is given, `own` gets one block of `needed`
/// bytes. Refuses as check_memory() does.
int take_memory(Call& call, const Given& given, std::size_t needed,
                const cdprep_allocator& allocator, OwnedMemory& own, std::byte*& start) noexcept;

}  // namespace cdprep::c
