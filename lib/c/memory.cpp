// SPDX-License-Identifier: MIT
#include "c/memory.h"

#include <array>
#include <cassert>
#include <cstdint>
#include <cstdio>
#include <new>

namespace cdprep::c {
namespace {

void* allocate_by_default(void* /*context*/, std::size_t size, std::size_t alignment) {
    return ::operator new (size, std::align_val_t{alignment}, std::nothrow);
}

void release_by_default(void* /*context*/, void* memory, std::size_t /*size*/) {
    ::operator delete (memory, std::align_val_t{CDPREP_ALIGNMENT}, std::nothrow);
}

bool is_aligned(const void* memory) noexcept {
    return reinterpret_cast<std::uintptr_t>(memory) % CDPREP_ALIGNMENT == 0;
}

}  // namespace

int read_allocator(Call& call, const Name& name, const cdprep_allocator* given,
                   cdprep_allocator& allocator) noexcept {
    if (given == nullptr) {
        allocator = {allocate_by_default, release_by_default, nullptr};
        return CDPREP_OK;
    }
    allocator = *given;
    if (allocator.allocate == nullptr || allocator.release == nullptr) {
        return call.refuse(CDPREP_WHY_NULL, name, "lacks one of its two functions.");
    }
    return CDPREP_OK;
}

int allocate(Call& call, const cdprep_allocator& allocator, std::size_t size, Memory& memory,
             const Name& name) noexcept {
    assert(allocator.allocate != nullptr && allocator.release != nullptr);
    memory = {allocator, nullptr, size};
    if (size == 0) return CDPREP_OK;
    memory.start = allocator.allocate(allocator.context, size, CDPREP_ALIGNMENT);
    if (memory.start == nullptr) {
        return call.fail(CDPREP_OVER_BUDGET, "The allocator is out of memory.");
    }
    if (is_aligned(memory.start)) return CDPREP_OK;
    release(memory);
    memory.start = nullptr;
    return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name,
                       "returned memory that does not start at a multiple of %d.",
                       CDPREP_ALIGNMENT);
}

int check_size(Call& call, const char* what, std::uint64_t needed, std::size_t& size) noexcept {
    if (needed <= PTRDIFF_MAX) {
        size = static_cast<std::size_t>(needed);
        return CDPREP_OK;
    }
    std::array<char, 128> sentence{};
    std::snprintf(sentence.data(), sentence.size(),
                  "%s needs at least %llu bytes; memory holds at most %llu.", what,
                  static_cast<unsigned long long>(needed),
                  static_cast<unsigned long long>(PTRDIFF_MAX));
    return call.fail(CDPREP_OVER_BUDGET, sentence.data());
}

OwnedMemory::~OwnedMemory() {
    release(memory_);
}

int OwnedMemory::allocate(Call& call, const cdprep_allocator& allocator, std::size_t size,
                          const Name& name) noexcept {
    assert(memory_.start == nullptr);  // else nobody would release the first block
    return c::allocate(call, allocator, size, memory_, name);
}

void release(const Memory& memory) noexcept {
    if (memory.start == nullptr) return;
    assert(memory.allocator.release != nullptr);
    memory.allocator.release(memory.allocator.context, memory.start, memory.size);
}

int check_memory(Call& call, const Given& given, std::size_t needed,
                 const cdprep_allocator* allocator) noexcept {
    if (given.start == nullptr) {
        if (given.size == 0) return CDPREP_OK;
        return call.refuse(CDPREP_WHY_NULL, {"memory"}, "is null, but its size is %zu.",
                           given.size);
    }
    if (given.size < needed) {
        return call.refuse(CDPREP_WHY_TOO_SMALL, {"size"}, "is %zu; %zu bytes are needed.",
                           given.size, needed);
    }
    if (!is_aligned(given.start)) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"memory"},
                           "does not start at a multiple of %d.", CDPREP_ALIGNMENT);
    }
    if (allocator == nullptr) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_NO_MEANING, given.allocator, "is set, but the memory is given.");
}

int take_memory(Call& call, const Given& given, std::size_t needed,
                const cdprep_allocator& allocator, OwnedMemory& own, std::byte*& start) noexcept {
    if (const int code = check_memory(call, given, needed, nullptr)) return code;
    if (given.start == nullptr) {
        if (const int code = own.allocate(call, allocator, needed, given.allocator)) return code;
    }
    start = static_cast<std::byte*>(given.start != nullptr ? given.start : own.get().start);
    return CDPREP_OK;
}

}  // namespace cdprep::c
