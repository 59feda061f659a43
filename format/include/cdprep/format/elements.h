// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "cdprep/format/api.h"

namespace cdprep::format {

/// The number types of section elements; little-endian, IEEE 754.
enum class Scalar : std::uint8_t { u8, u32, i32, u64, f32, f64 };

/// Returns the size in bytes of one number of this type.
[[nodiscard]] CDPREP_API std::uint32_t scalar_size(Scalar scalar) noexcept;

/// Returns the type's name in FORMAT.md: "u8", "f64" and so on.
[[nodiscard]] CDPREP_API const char* scalar_name(Scalar scalar) noexcept;

/// A member of an on-disk struct: one number, or an array of up to three dimensions.
struct Field {
    const char* name;
    std::uint32_t offset;
    Scalar scalar;
    std::array<std::uint32_t, 3> shape = {};  ///< extents; 0 for unused dimensions

    /// Returns how many numbers the field holds.
    [[nodiscard]] constexpr std::uint32_t count() const noexcept {
        std::uint32_t product = 1;
        for (const std::uint32_t extent : shape) product *= extent == 0 ? 1 : extent;
        return product;
    }
};

/// The layout of one element of a section: a struct with fields, or `columns` numbers of one type.
struct Element {
    const char* name;       ///< "BvhNode", or "u32"
    std::uint32_t size;     ///< bytes
    Scalar scalar;          ///< type of its numbers, if it has no fields
    std::uint32_t columns;  ///< count of numbers, if it has no fields; 1: one-dimensional dataset
    std::span<const Field> fields;
};

/// Element types in the section table: One<T> marks a section of one element of type T. Text marks
/// a section of UTF-8 text.
template <class T>
struct One {};
struct Text {};

}  // namespace cdprep::format
