// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "c/call.h"

namespace cdprep::c {

/// The values that a field of an input struct may hold.
enum class Holds : std::uint8_t {
    pointer,   ///< not null
    choice,    ///< uint32, at most Field::most
    reserved,  ///< uint32, 0
    number,    ///< double, finite, at most 2^1000 in magnitude
    length,    ///< the same, and not negative
    limit,     ///< double, not negative; may be infinite
};

/// One field of an input struct that is checked for every query.
struct Field {
    const char* name;
    std::size_t offset;
    Holds holds;
    std::uint32_t most = 0;
    std::uint32_t count = 1;  ///< consecutive doubles
};

/// A type of input struct, as the checks know it.
struct InputType {
    const char* name;
    std::uint32_t tag;
    std::uint32_t first_size;       ///< of the first version that had it
    std::uint32_t size;             ///< as this library knows it
    std::span<const Field> fields;  ///< checked in this order: pointers, choices, numbers
};

/// The greatest size of a struct that is accepted. No version will be larger.
inline constexpr std::uint32_t kGreatestSize = 4096;

/// Checks size and tag, and that bytes unknown to this library are 0. Refuses null.
int check_head(Call& call, const Name& name, const InputType& type, const void* from) noexcept;

/// Refuses an element of another size than the first, because its position would be unknown.
int check_stride(Call& call, const Name& name, const void* first, const void* given) noexcept;

/// Checks every field of a struct that was read.
int check_fields(Call& call, const Name& name, const InputType& type, const void* given) noexcept;

/// Checks `count` numbers of a caller. Names the invalid one.
int check_numbers(Call& call, const Name& name, Holds holds, const double* numbers,
                  std::size_t count) noexcept;

/// Returns whether a number is infinite, in any floating-point environment of the caller.
[[nodiscard]] bool is_infinite(double number) noexcept;

/// Checks a number that is an argument of its own.
inline int check_number(Call& call, const char* name, Holds holds, double number) noexcept {
    return check_numbers(call, {name}, holds, &number, 1);
}

/// For each input struct: its InputType, as `type`, and the values that its _init() writes.
template <class T>
struct Input;

/// Writes the default values, for the _init() functions.
template <class T>
void initialise(T* to, std::size_t size) noexcept {
    if (to == nullptr || size < sizeof(cdprep_head) || size > kGreatestSize) return;
    T made = Input<T>::defaults();
    made.head = {static_cast<std::uint32_t>(size), Input<T>::type.tag};
    std::memset(static_cast<void*>(to), 0, size);
    std::memcpy(static_cast<void*>(to), &made, std::min(size, sizeof made));
}

/// Reads a caller's struct, whose size may differ: missing fields get their defaults. Checks all
/// but what depends on the kind of query.
template <class T>
int read_input(Call& call, const Name& name, const T* from, T& to) noexcept {
    if (const int code = check_head(call, name, Input<T>::type, from)) return code;
    cdprep_head head;
    std::memcpy(&head, static_cast<const void*>(from), sizeof head);
    to = Input<T>::defaults();
    std::memcpy(static_cast<void*>(&to), static_cast<const void*>(from),
                std::min<std::size_t>(head.size, sizeof to));
    return check_fields(call, name, Input<T>::type, &to);
}

/// The same, except that null gives the defaults.
template <class T>
int read_options(Call& call, const Name& name, const T* from, T& to) noexcept {
    if (from != nullptr) return read_input(call, name, from, to);
    to = Input<T>::defaults();
    return CDPREP_OK;
}

/// Returns element `index` of an array of input structs. The first element holds the size of all.
template <class T>
const T* element(const T* first, std::size_t index) noexcept {
    cdprep_head head;
    std::memcpy(&head, static_cast<const void*>(first), sizeof head);
    return reinterpret_cast<const T*>(reinterpret_cast<const char*>(first) + index * head.size);
}

}  // namespace cdprep::c
