// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace cdprep::import {

/// A number read from text.
struct Number {
    double value = 0;            ///< correctly rounded; NaN for spellings of no finite number
    const char* next = nullptr;  ///< just past it; null if there is no number
    /// The nearest float represents the number without loss. Either that float equals `value`, or
    /// it reads the same when printed with as many digits as the text. The text then has at most 9
    /// significant digits. static_cast<float>(value) is that float.
    bool single = false;
};

/// Reads the decimal number at `first`, correctly rounded. It must end before a
/// blank, a '#', a backslash or `last`; otherwise `next` is null.
///
/// Infinity and NaN in the spellings of C libraries ("inf", "nan", "-nan(ind)", "1.#QNAN", ...)
/// give that value. A number too large for a double gives infinity, a hexadecimal spelling NaN.
/// `first` < `last` is not required. Takes about 5 ns; about 50 ns for numbers of more than 19
/// digits or with large exponents.
[[nodiscard]] inline Number parse_number(const char* first, const char* last) noexcept;

/// Handles the case of parse_number() with more digits than a double holds. [first, last) spells
/// significand * 10^exponent with at most 19 digits.
[[nodiscard]] Number parse_long_number(const char* first, const char* last,
                                       std::uint64_t significand, int exponent) noexcept;

/// Handles the general case of parse_number(): any length, any exponent, any spelling.
[[nodiscard]] Number parse_odd_number(const char* first, const char* last) noexcept;

/// Returns `Number::single` for the finite text [first, last) of value `value`. It prints the
/// nearest float to decide.
[[nodiscard]] bool single_prints_the_same(const char* first, const char* last,
                                          double value) noexcept;

/// Appends the decimal digits at `first` to `value` (modulo 2^64) and returns the
/// first character that is not a digit.
[[nodiscard, gnu::always_inline]] inline const char* take_digits(const char* first,
                                                                 const char* last,
                                                                 std::uint64_t& value) noexcept;

/// A whole number read from text.
struct WholeNumber {
    std::int64_t value = 0;
    const char* next = nullptr;  ///< just past it; null if there is no number
};

/// Reads the whole number of at most 18 digits at `first`. The rules for its end are those of
/// parse_number().
[[nodiscard]] inline WholeNumber parse_whole_number(const char* first, const char* last) noexcept;

// ---------------------------------------------------------------- inline parts

namespace detail {

inline constexpr std::array<double, 23> kPowerOfTen = {
    1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
inline constexpr std::array<double, 23> kNegativePowerOfTen = {
    1e-0,  1e-1,  1e-2,  1e-3,  1e-4,  1e-5,  1e-6,  1e-7,  1e-8,  1e-9,  1e-10, 1e-11,
    1e-12, 1e-13, 1e-14, 1e-15, 1e-16, 1e-17, 1e-18, 1e-19, 1e-20, 1e-21, 1e-22};
inline constexpr std::array<std::uint32_t, 9> kSmallPowerOfTen = {
    1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};

/// Returns the number with these eight digits. The first digit is in the lowest byte.
constexpr std::uint64_t eight_digits(std::uint64_t digits) noexcept {
    constexpr std::uint64_t kEverySecond = 0x000000ff000000ff;
    digits = digits * 10 + (digits >> 8);
    return ((digits & kEverySecond) * (100 + (std::uint64_t{1000000} << 32)) +
            ((digits >> 16) & kEverySecond) * (1 + (std::uint64_t{10000} << 32))) >>
           32;
}

constexpr bool is_digit(char c) noexcept {
    return c >= '0' && c <= '9';
}

constexpr bool ends_number(char c) noexcept {
    return static_cast<unsigned char>(c) <= ' ' || c == '#' || c == '\\';
}

enum class Loss : std::uint8_t { none, some, unclear };

/// Returns the loss of a float that holds significand * 10^exponent = value. The significand is at
/// most 2^53 and the exponent from -22 to 22, so no float overflows or is subnormal. Up to 6 digits
/// always survive. For 7 to 9 digits the float must be nearer than half a unit of the last digit.
/// The error of `value` is less than 2^-53 of at most 10^9 units. The result is therefore
/// `unclear` within a millionth of a unit to either side. It is also `unclear` at powers of ten,
/// below which digits are finer. The same holds for doubles halfway between two floats, where
/// rounding twice could differ from rounding once.
inline Loss loss_as_single(std::uint64_t significand, int exponent, double value) noexcept {
    constexpr double kDoubt = 1e-6;  // of half a unit
    constexpr std::uint64_t kHalfway = std::uint64_t{1} << 28;
    const double nearest = static_cast<float>(value);
    if (significand >= 1000000000) return nearest == value ? Loss::none : Loss::some;
    const double half_unit =
        0.5 * (exponent < 0 ? kNegativePowerOfTen[static_cast<std::size_t>(-exponent)]
                            : kPowerOfTen[static_cast<std::size_t>(exponent)]);
    const double difference = nearest > value ? nearest - value : value - nearest;
    const bool halfway = (std::bit_cast<std::uint64_t>(value) & (2 * kHalfway - 1)) == kHalfway;
    const bool decade =
        (significand == 1000000) | (significand == 10000000) | (significand == 100000000);
    if ((difference < half_unit * (1 - kDoubt)) & !halfway & !decade) return Loss::none;
    if (significand < 1000000 || nearest == value) return Loss::none;
    return halfway || decade || difference <= half_unit * (1 + kDoubt) ? Loss::unclear : Loss::some;
}

}  // namespace detail

inline const char* take_digits(const char* first, const char* last, std::uint64_t& value) noexcept {
    static_assert(std::endian::native == std::endian::little);
    while (last - first >= 8) {
        std::uint64_t text;
        std::memcpy(&text, first, 8);
        const std::uint64_t digits = text ^ 0x3030303030303030;
        // The high bit of each byte above 9. A carry out of a byte above 0x89 only corrupts
        // later bytes, and the first byte that is not a digit decides.
        const std::uint64_t others = ((digits + 0x7676767676767676) | digits) & 0x8080808080808080;
        const auto count = static_cast<unsigned>(std::countr_zero(others)) / 8;
        if (count == 0) return first;
        value = value * detail::kSmallPowerOfTen[count] +
                detail::eight_digits(digits << (64 - 8 * count));
        first += count;
        // A single branch, seldom taken: lengths vary too much to be predicted.
        const bool more = (count == 8) & (first < last) && detail::is_digit(*first);
        if (!more) return first;
    }
    for (; first < last && detail::is_digit(*first); ++first) {
        value = value * 10 + static_cast<std::uint64_t>(*first - '0');
    }
    return first;
}

inline WholeNumber parse_whole_number(const char* first, const char* last) noexcept {
    constexpr int kMaxDigits = 18;
    const char* at = first;
    const bool negative = at < last && *at == '-';
    if (negative || (at < last && *at == '+')) ++at;
    std::uint64_t value = 0;
    const char* const digits = at;
    at = take_digits(at, last, value);
    if (at == digits || at - digits > kMaxDigits) return {};
    if (at < last && !detail::ends_number(*at)) return {};
    const auto whole = static_cast<std::int64_t>(value);
    return {negative ? -whole : whole, at};
}

inline Number parse_number(const char* first, const char* last) noexcept {
    const char* at = first;
    if (at >= last) return {};
    const bool negative = *at == '-';
    at += negative | (*at == '+');

    std::uint64_t significand = 0;
    const char* const digits = at;
    if (last - at > 1 && at[1] == '.' && detail::is_digit(*at)) {
        significand = static_cast<std::uint64_t>(*at++ - '0');
    } else {
        at = take_digits(at, last, significand);
    }
    auto digit_count = at - digits;
    int exponent = 0;
    if (at < last && *at == '.') {
        const char* const fraction = ++at;
        at = take_digits(at, last, significand);
        digit_count += at - fraction;
        if (digit_count > 19) return parse_odd_number(first, last);
        exponent = static_cast<int>(fraction - at);
    }
    if (digit_count == 0 || digit_count > 19) return parse_odd_number(first, last);
    if (at < last && (*at == 'e' || *at == 'E')) {
        ++at;
        const bool below = at < last && *at == '-';
        if (below || (at < last && *at == '+')) ++at;
        std::uint64_t power = 0;
        const char* const power_digits = at;
        at = take_digits(at, last, power);
        if (at == power_digits || at - power_digits > 4) return parse_odd_number(first, last);
        exponent += below ? -static_cast<int>(power) : static_cast<int>(power);
    }
    // A '#' may begin a comment, or belong to 1.#INF.
    if (at<last&& static_cast<unsigned char>(*at)> ' ') return parse_odd_number(first, last);

    // Both operands are exact doubles, so the one operation rounds once.
    constexpr std::uint64_t kExact = std::uint64_t{1} << 53;
    if (significand > kExact || exponent < -22 || exponent > 22) {
        return parse_long_number(first, at, significand, exponent);
    }
    const auto whole = static_cast<double>(significand);
    const double value = exponent < 0
                             ? whole / detail::kPowerOfTen[static_cast<std::size_t>(-exponent)]
                             : whole * detail::kPowerOfTen[static_cast<std::size_t>(exponent)];
    const detail::Loss loss = detail::loss_as_single(significand, exponent, value);
    const bool single = loss == detail::Loss::none ||
                        (loss == detail::Loss::unclear && single_prints_the_same(first, at, value));
    return {negative ? -value : value, at, single};
}

}  // namespace cdprep::import
