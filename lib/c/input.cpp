// SPDX-License-Identifier: MIT
#include "c/input.h"

#include <cassert>
#include <cmath>

#include "cdprep/format/float_environment.h"
#include "cdprep/format/limits.h"

namespace cdprep::c {
namespace {

const char* at(const void* given, std::size_t offset) noexcept {
    return static_cast<const char*>(given) + offset;
}

std::uint32_t word_at(const void* given, const Field& field) noexcept {
    std::uint32_t word = 0;
    std::memcpy(&word, at(given, field.offset), sizeof word);
    return word;
}

bool is_null(const void* given, const Field& field) noexcept {
    const void* pointer = nullptr;
    std::memcpy(static_cast<void*>(&pointer), at(given, field.offset), sizeof pointer);
    return pointer == nullptr;
}

/// NaN is in no range. The caller's floating-point environment may trap it, or take a small
/// negative number for 0.
bool is_in_range(Holds holds, double number) noexcept {
    const format::FloatEnvironment environment;
    switch (holds) {
        case Holds::length:
            return number >= 0 && number <= format::kMaxCoordinate;
        case Holds::limit:
            return number >= 0 && (number <= format::kMaxCoordinate || std::isinf(number));
        default:
            return std::fabs(number) <= format::kMaxCoordinate;
    }
}

int refuse_number(Call& call, const Name& name, Holds holds, double number) noexcept {
    const char* const allowed = holds == Holds::number ? "a number of at most 2^1000 in magnitude"
                                : holds == Holds::length
                                    ? "0 or more, and at most 2^1000"
                                    : "0 or more, and at most 2^1000 or infinite";
    const format::FloatEnvironment environment;
    const bool is_finite = std::isfinite(number) || (holds == Holds::limit && number > 0);
    return call.refuse(is_finite ? CDPREP_WHY_OUT_OF_RANGE : CDPREP_WHY_NOT_FINITE, name,
                       "is %.17g; it must be %s.", number, allowed);
}

int check_field(Call& call, const Name& name, const Field& field, const void* given) noexcept {
    switch (field.holds) {
        case Holds::pointer:
            if (!is_null(given, field)) return CDPREP_OK;
            return call.need(nullptr, name.of(field.name));
        case Holds::choice:
            if (word_at(given, field) <= field.most) return CDPREP_OK;
            return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name.of(field.name),
                               "is %u; the greatest value is %u.", word_at(given, field),
                               field.most);
        case Holds::reserved:
            if (word_at(given, field) == 0) return CDPREP_OK;
            return call.refuse(CDPREP_WHY_NEWER_FIELD, name.of(field.name),
                               "is %u; this version of the library needs 0.",
                               word_at(given, field));
        default:
            break;
    }
    assert(field.count > 0 && field.offset % alignof(double) == 0);
    for (std::uint32_t i = 0; i < field.count; ++i) {
        double number = 0;
        std::memcpy(&number, at(given, field.offset + i * sizeof number), sizeof number);
        if (is_in_range(field.holds, number)) continue;
        return refuse_number(call, name.of(field.name, field.count > 1 ? i : Name::kNone),
                             field.holds, number);
    }
    return CDPREP_OK;
}

bool is_zero(const char* bytes, std::size_t count) noexcept {
    return std::all_of(bytes, bytes + count, [](char byte) { return byte == 0; });
}

}  // namespace

int check_head(Call& call, const Name& name, const InputType& type, const void* from) noexcept {
    if (const int code = call.need(from, name)) return code;
    cdprep_head head;
    std::memcpy(&head, from, sizeof head);
    if (head.tag != type.tag || head.size < type.first_size || head.size > kGreatestSize) {
        return call.refuse(CDPREP_WHY_NOT_INITIALISED, name,
                           "is not initialised: call %s_init() with its sizeof first.", type.name);
    }
    if (head.size > type.size && !is_zero(at(from, type.size), head.size - type.size)) {
        return call.refuse(
            CDPREP_WHY_NEWER_FIELD, name,
            "has %u bytes of a newer version, and some that this version does not know are not 0.",
            head.size);
    }
    return CDPREP_OK;
}

int check_stride(Call& call, const Name& name, const void* first, const void* given) noexcept {
    cdprep_head head, expected;
    std::memcpy(&head, given, sizeof head);
    std::memcpy(&expected, first, sizeof expected);
    if (head.size == expected.size) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_NOT_INITIALISED, name,
                       "has size %u, but the first of the array has %u.", head.size, expected.size);
}

int check_fields(Call& call, const Name& name, const InputType& type, const void* given) noexcept {
    for (const Field& field : type.fields) {
        if (const int code = check_field(call, name, field, given)) return code;
    }
    return CDPREP_OK;
}

bool is_infinite(double number) noexcept {
    const format::FloatEnvironment environment;
    return std::isinf(number);
}

int check_numbers(Call& call, const Name& name, Holds holds, const double* numbers,
                  std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
        if (is_in_range(holds, numbers[i])) continue;
        Name wrong = name;
        if (count > 1) (wrong.field != nullptr ? wrong.place : wrong.index) = i;
        return refuse_number(call, wrong, holds, numbers[i]);
    }
    return CDPREP_OK;
}

}  // namespace cdprep::c
