// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/parse_number.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <system_error>

// std::from_chars does not give the digits, which decide Number::single. So parse_odd_number(),
// which calls it, reads the text again. Numbers of 6 to 9 digits take six times as long there.
namespace cdprep::import {
namespace {

constexpr int kMaxSingleDigits = 9;  // digits that identify a float

/// A finite decimal without sign, leading zeros and point:
/// digits[0].digits[1]digits[2]... * 10^exponent.
struct Decimal {
    std::array<char, kMaxSingleDigits + 1> digits{};
    int count = 0;  ///< kMaxSingleDigits + 1: that many or more
    std::int64_t exponent = 0;
};

Decimal to_decimal(std::string_view text) noexcept {
    Decimal decimal;
    bool after_point = false;
    std::size_t i = text.find_first_of("+-") == 0 ? 1 : 0;
    for (; i < text.size() && text[i] != 'e' && text[i] != 'E'; ++i) {
        if (text[i] == '.') {
            after_point = true;
            continue;
        }
        const bool leading_zero = decimal.count == 0 && text[i] == '0';
        if (leading_zero && after_point) --decimal.exponent;
        if (leading_zero) continue;
        if (!after_point) ++decimal.exponent;
        if (decimal.count <= kMaxSingleDigits) {
            decimal.digits[static_cast<std::size_t>(decimal.count++)] = text[i];
        }
    }
    --decimal.exponent;  // one digit is before the point
    if (i < text.size()) {
        ++i;
        if (i < text.size() && text[i] == '+') ++i;
        std::int64_t power = 0;
        const auto read = std::from_chars(text.data() + i, text.data() + text.size(), power);
        constexpr std::int64_t kFarAway = 1 << 30;
        if (read.ec != std::errc{}) power = text[i] == '-' ? -kFarAway : kFarAway;
        decimal.exponent += power;
    }
    return decimal;
}

char lower(char c) noexcept {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool starts_with(std::string_view text, std::string_view lower_prefix) noexcept {
    return text.size() >= lower_prefix.size() &&
           std::equal(lower_prefix.begin(), lower_prefix.end(), text.begin(),
                      [](char a, char b) { return a == lower(b); });
}

/// Returns true and sets `value` if `token` spells infinity, NaN or a hexadecimal number.
bool spells_no_decimal(std::string_view token, double& value) noexcept {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const bool negative = token.front() == '-';
    if (negative || token.front() == '+') token.remove_prefix(1);
    if (starts_with(token, "inf") || starts_with(token, "1.#inf")) {
        value = negative ? -kInfinity : kInfinity;
        return true;
    }
    value = std::numeric_limits<double>::quiet_NaN();
    return starts_with(token, "nan") || starts_with(token, "1.#qnan") ||
           starts_with(token, "1.#snan") || starts_with(token, "1.#ind") ||
           starts_with(token, "0x");
}

}  // namespace

bool single_prints_the_same(const char* first, const char* last, double value) noexcept {
    const std::string_view text(first, static_cast<std::size_t>(last - first));
    const auto nearest = static_cast<float>(value);
    if (static_cast<double>(nearest) == value) return true;
    if (!std::isfinite(nearest)) return false;
    const Decimal decimal = to_decimal(text);
    if (decimal.count == 0 || decimal.count > kMaxSingleDigits) return false;

    // Rounding from text to double to float may differ from rounding once. If it does, the
    // number stays a double.
    float rounded_once = 0;
    const char* unsigned_first = first + (text.find_first_of("+-") == 0 ? 1 : 0);
    const auto read = std::from_chars(unsigned_first, last, rounded_once);
    if (read.ec != std::errc{} || rounded_once != std::fabs(nearest)) return false;

    std::array<char, 32> printed{};
    const auto wrote = std::to_chars(printed.data(), printed.data() + printed.size(), rounded_once,
                                     std::chars_format::scientific, decimal.count - 1);
    const Decimal back =
        to_decimal({printed.data(), static_cast<std::size_t>(wrote.ptr - printed.data())});
    return back.count == decimal.count && back.exponent == decimal.exponent &&
           back.digits == decimal.digits;
}

// x87 registers hold both operands exactly and round their quotient or product to 64 bits. The
// result lies on the same side of every point halfway between two doubles as the true value,
// unless it is such a point. Rounding it again is therefore correct, except in that case.
Number parse_long_number(const char* first, const char* last, std::uint64_t significand,
                         int exponent) noexcept {
    using Limits = std::numeric_limits<long double>;
    constexpr int kMaxExponent = 27;  // 5^27 < 2^64
    if (Limits::digits != 64 || exponent < -kMaxExponent || exponent > kMaxExponent) {
        return parse_odd_number(first, last);
    }
    static constexpr std::array<long double, kMaxExponent + 1> kPowers = [] {
        std::array<long double, kMaxExponent + 1> powers{};
        long double power = 1;
        for (long double& entry : powers) {
            entry = power;
            power *= 10;
        }
        return powers;
    }();
    const auto whole = static_cast<long double>(significand);
    const long double wide = exponent < 0 ? whole / kPowers[static_cast<std::size_t>(-exponent)]
                                          : whole * kPowers[static_cast<std::size_t>(exponent)];
    std::uint64_t bits = 0;
    std::memcpy(&bits, &wide, sizeof bits);
    constexpr std::uint64_t kDropped = 0x7ff;  // 64 bits to 53
    if ((bits & kDropped) == 0x400) return parse_odd_number(first, last);
    const auto value = static_cast<double>(wide);
    const bool single = single_prints_the_same(first, last, value);
    return {*first == '-' ? -value : value, last, single};
}

Number parse_odd_number(const char* first, const char* last) noexcept {
    const char* const end = std::find_if(first, last, detail::ends_number);
    if (first == end) return {};
    const std::string_view token(first, static_cast<std::size_t>(end - first));
    const char* const word_end = std::find_if(
        first, last, [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == '\\'; });
    const std::string_view word(first, static_cast<std::size_t>(word_end - first));
    if (double value = 0; spells_no_decimal(word, value)) return {value, word_end, false};

    const bool negative = *first == '-';
    const char* const magnitude = first + (negative || *first == '+' ? 1 : 0);
    double value = 0;
    const auto read = std::from_chars(magnitude, end, value);
    if (read.ptr != end || magnitude == end || *magnitude == '-') return {};
    if (read.ec == std::errc::result_out_of_range) {
        // Too large or too small for a double: the decimal exponent decides which.
        const bool large = to_decimal(token).exponent > 0;
        value = large ? std::numeric_limits<double>::infinity() : 0.0;
    }
    const bool single = std::isfinite(value) && single_prints_the_same(first, end, value);
    return {negative ? -value : value, end, single};
}

}  // namespace cdprep::import
