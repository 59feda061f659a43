// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace cdprep::format {

/// The numbers that elements of sections are made of; little-endian, IEEE 754.
enum class Scalar : std::uint8_t { u8, u32, i32, u64, f32, f64 };

/// Bytes of one number.
[[nodiscard]] std::uint32_t scalar_size(Scalar scalar) noexcept;

/// "u8", "f64", ...: as FORMAT.md spells it.
[[nodiscard]] const char* scalar_name(Scalar scalar) noexcept;

/// A member of an on-disk struct: one number, or an array of up to three dimensions.
struct Field {
    const char* name;
    std::uint32_t offset;
    Scalar scalar;
    std::array<std::uint32_t, 3> shape = {};  ///< zeros past its dimensions

    /// How many numbers.
    [[nodiscard]] constexpr std::uint32_t count() const noexcept {
        std::uint32_t product = 1;
        for (const std::uint32_t extent : shape) product *= extent == 0 ? 1 : extent;
        return product;
    }
};

/// How one element of a section is laid out: a struct with fields, or `columns` numbers of one
/// kind.
struct Element {
    const char* name;       ///< "BvhNode", or "u32"
    std::uint32_t size;     ///< bytes
    Scalar scalar;          ///< of an element without fields
    std::uint32_t columns;  ///< of an element without fields; HDF5 datasets have as many, 1: none
    std::span<const Field> fields;
};

/// In the section table: a section of one element, and one of text (UTF-8).
template <class T>
struct One {};
struct Text {};

}  // namespace cdprep::format
