// SPDX-License-Identifier: MIT
#include "import/parse_number.h"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

namespace cdprep::import {
namespace {

/// Parses from an allocation of exactly the text's size, so that a sanitizer sees
/// one byte too many.
Number parse(const std::string& text) {
    const std::vector<char> exact(text.begin(), text.end());
    Number number = parse_number(exact.data(), exact.data() + exact.size());
    if (number.next) number.next = text.data() + (number.next - exact.data());
    return number;
}

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// The significant digits of a decimal text as written, and its exponent, by the
/// plainest means.
struct Digits {
    std::string digits;
    long exponent = 0;  // of the last digit
};

Digits digits_of(const std::string& text) {
    Digits result;
    const std::size_t e = text.find_first_of("eE");
    const std::string mantissa = text.substr(0, e);
    if (e != std::string::npos) result.exponent = std::atol(text.c_str() + e + 1);
    const std::size_t point = mantissa.find('.');
    if (point != std::string::npos) {
        result.exponent -= static_cast<long>(mantissa.size() - point - 1);
    }
    for (const char c : mantissa) {
        if (c >= '0' && c <= '9' && !(result.digits.empty() && c == '0')) result.digits += c;
    }
    return result;
}

/// The rule of Number::single in words: the float is the double, or at most nine
/// digits and printed with as many digits it reads the same.
bool single_by_printing(const std::string& text) {
    const double value = std::strtod(text.c_str(), nullptr);
    const float nearest = std::strtof(text.c_str(), nullptr);
    if (!std::isfinite(value)) return false;
    if (static_cast<double>(static_cast<float>(value)) == value) return true;
    if (static_cast<float>(value) != nearest) return false;
    const Digits wanted = digits_of(text);
    if (wanted.digits.empty() || wanted.digits.size() > 9 || !std::isfinite(nearest)) return false;
    char printed[64];
    std::snprintf(printed, sizeof printed, "%.*e", static_cast<int>(wanted.digits.size()) - 1,
                  static_cast<double>(std::fabs(nearest)));
    const Digits found = digits_of(printed);
    return found.digits == wanted.digits && found.exponent == wanted.exponent;
}

void expect_like_strtod(const std::string& text) {
    const Number number = parse(text);
    ASSERT_NE(number.next, nullptr) << text;
    EXPECT_EQ(number.next, text.data() + text.size()) << text;
    EXPECT_TRUE(same_bits(number.value, std::strtod(text.c_str(), nullptr))) << text;
    EXPECT_EQ(number.single, single_by_printing(text)) << text;
}

// Known by the C library, which rounds correctly.
TEST(ParseNumber, ReadsEverySpellingOfADecimal) {
    for (const char* text : {"0",
                             "-0",
                             "+0",
                             "1",
                             "-1",
                             "+1.5",
                             ".5",
                             "-.5",
                             "5.",
                             "-5.e3",
                             "1e5",
                             "1E+5",
                             "1e-5",
                             "00012.500",
                             "0.0000000000000000000001",
                             "123456789012345678901234567890",
                             "1.7976931348623157e308",
                             "4.9e-324",
                             "2.2250738585072014e-308",
                             "0.1",
                             "0.3",
                             "9007199254740993",
                             "9007199254740992.999",
                             "1e22",
                             "1e23",
                             "8.5e22",
                             "3.4028235e38",
                             "1.17549435e-38",
                             "0.00000000000000000000000000000000000000000000001",
                             "1e0000000005"}) {
        expect_like_strtod(text);
    }
}

TEST(ParseNumber, StopsAtABlankACommentAndABackslash) {
    for (const char* text : {"1.25 2", "1.25\t2", "1.25\r\n", "1.25\n", "1.25#c", "1.25\\\n"}) {
        const std::string line = text;
        const Number number = parse(line);
        EXPECT_EQ(number.next, line.data() + 4) << text;
        EXPECT_EQ(number.value, 1.25) << text;
    }
}

TEST(ParseNumber, RefusesWhatIsNoNumber) {
    for (const char* text : {"", " ", "-", "+", ".", "-.", "e5", "1e", "1e+", "1x", "abc", "1,5",
                             "--1", "+-1", "1..2", "1e5.5", "1/2", "\xff"}) {
        EXPECT_EQ(parse(text).next, nullptr) << text;
    }
}

TEST(ParseNumber, ReadsSpellingsOfNoFiniteNumberAsThat) {
    for (const char* text : {"nan", "NaN", "-nan", "nan(0x1)", "-nan(ind)", "1.#QNAN", "1.#IND",
                             "-1.#IND", "0x1.8p3", "0XFF"}) {
        const std::string word = text;
        const Number number = parse(word);
        EXPECT_EQ(number.next, word.data() + word.size()) << text;
        EXPECT_TRUE(std::isnan(number.value)) << text;
        EXPECT_FALSE(number.single) << text;
    }
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const char* text :
         {"inf", "Inf", "+inf", "INFINITY", "1.#INF", "1e309", "1e99999999999"}) {
        EXPECT_EQ(parse(text).value, kInfinity) << text;
    }
    EXPECT_EQ(parse("-inf").value, -kInfinity);
    EXPECT_EQ(parse("-1.#INF").value, -kInfinity);
    EXPECT_EQ(parse("1e-400").value, 0.0);
    EXPECT_TRUE(std::signbit(parse("-1e-99999999999").value));
}

// 0.1 has one digit, and the nearest float printed with one digit is 0.1; with
// seventeen it is not. 0.5 is a float however it is written.
TEST(ParseNumber, CallsSingleWhatAFloatKeeps) {
    for (const char* text : {"0.1", "0.123456", "-0.5", "0.50000000000", "16777216", "3.402823e38",
                             "1e-30", "0.100000001", "1000.500000", "-0"}) {
        EXPECT_TRUE(parse(text).single) << text;
    }
    for (const char* text : {"0.1000000000", "0.10000000149", "0.123456789012", "16777217", "1e39",
                             "0.100000002", "0.999999999", "123456789.5"}) {
        EXPECT_FALSE(parse(text).single) << text;
    }
}

TEST(ParseNumber, AgreesWithTheCLibraryOnPrintedFloatsAndDoubles) {
    constexpr unsigned kSeed = 20261121;
    constexpr int kRounds = 400'000;
    SCOPED_TRACE(kSeed);
    std::mt19937_64 random(kSeed);
    int singles = 0;
    for (int i = 0; i < kRounds && !HasFailure(); ++i) {
        const std::uint64_t bits = random();
        double value = std::bit_cast<double>(bits);
        if (i % 2 == 0) value = static_cast<double>(std::bit_cast<float>(std::uint32_t(bits)));
        if (!std::isfinite(value)) continue;
        char text[64];
        const int digits = 1 + static_cast<int>(bits % 18);
        std::snprintf(text, sizeof text, i % 3 == 0 ? "%.*e" : "%.*g", digits, value);
        expect_like_strtod(text);
        singles += parse(text).single;
    }
    EXPECT_GT(singles, kRounds / 10);
    EXPECT_LT(singles, kRounds * 9 / 10);
}

// Coordinates as mesh files have them: few digits, fixed notation; many of them
// within a unit of the seventh to ninth digit of a float.
TEST(ParseNumber, AgreesWithTheCLibraryOnCoordinates) {
    constexpr unsigned kSeed = 7;
    constexpr int kRounds = 1'000'000;
    SCOPED_TRACE(kSeed);
    std::mt19937_64 random(kSeed);
    int singles = 0;
    for (int i = 0; i < kRounds && !HasFailure(); ++i) {
        const auto whole = static_cast<long long>(random() % 2'000'000'000);
        const auto decimals = static_cast<int>(random() % 12);
        const double scale = std::pow(10.0, decimals);
        char text[64];
        std::snprintf(text, sizeof text, "%s%.*f", random() % 2 ? "-" : "", decimals,
                      static_cast<double>(whole >> random() % 31) / scale);
        expect_like_strtod(text);
        singles += parse(text).single;
    }
    EXPECT_GT(singles, kRounds / 10);
    EXPECT_LT(singles, kRounds * 9 / 10);
}

// More digits than a double holds, where two roundings must give what one does.
TEST(ParseNumber, AgreesWithTheCLibraryOnLongNumbers) {
    constexpr unsigned kSeed = 53;
    SCOPED_TRACE(kSeed);
    std::mt19937_64 random(kSeed);
    for (int i = 0; i < 500'000 && !HasFailure(); ++i) {
        const std::uint64_t digits = random() % 10'000'000'000'000'000'000u >> random() % 12;
        const auto exponent = static_cast<int>(random() % 64) - 32;
        std::string text = std::to_string(digits) + "e" + std::to_string(exponent);
        expect_like_strtod(text);
        text = std::to_string(digits);
        const std::size_t point = random() % text.size();
        expect_like_strtod(text.substr(0, point) + '.' + text.substr(point));
    }
}

/// The exact decimal expansion of a double.
std::string exact_text(double value) {
    char text[1200];
    const auto wrote =
        std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, 1074);
    std::string result(text, wrote.ptr);
    result.erase(result.find_last_not_of('0') + 1);
    return result;
}

// Halfway between two neighbours, and one digit to either side of it.
TEST(ParseNumber, RoundsHalfwayCasesToEven) {
    constexpr unsigned kSeed = 99;
    SCOPED_TRACE(kSeed);
    std::mt19937_64 random(kSeed);
    for (int i = 0; i < 20'000 && !HasFailure(); ++i) {
        const std::uint64_t odd_24 = (random() >> 40) | 0x800001;
        const int exponent = static_cast<int>(random() % 80) - 40;
        // Halfway between two floats: a double exactly.
        const double halfway = std::ldexp(static_cast<double>(2 * odd_24 + 1), exponent);
        std::string text = exact_text(halfway);
        expect_like_strtod(text);
        // Halfway between two doubles: one bit more than a double has.
        const std::uint64_t odd_53 = (random() >> 11) | 1;
        const long double beyond = std::ldexp(static_cast<long double>(odd_53) * 2 + 1, exponent);
        char printed[400];
        std::snprintf(printed, sizeof printed, "%.100Lf", beyond);
        text = printed;
        expect_like_strtod(text);
        expect_like_strtod(text + "1");
        text.erase(text.find_last_not_of('0') + 1);
        expect_like_strtod(text);
    }
}

// Nine digits or fewer that round to a double halfway between floats, decades,
// and the borders of the float range: where the quick decision must not guess.
TEST(ParseNumber, DecidesBordersOfTheFloatRuleByPrinting) {
    for (const char* text :
         {"0.01000000",     "0.010000000",  "0.00100000",   "1.000000e-10",  "1.0000000e-3",
          "9.999999e-5",    "9.99999999e9", "100000000",    "1e8",           "10000000.0",
          "0.1000000",      "16777217e-7",  "33554433",     "1.1754944e-38", "1.4e-45",
          "1.401298e-45",   "7e-46",        "3.4028236e38", "3.40282347e38", "3.40282357e38",
          "1.17549421e-38", "9.403955e-38"}) {
        expect_like_strtod(text);
    }
    std::mt19937_64 random(3);
    for (int i = 0; i < 200'000 && !HasFailure(); ++i) {
        const auto power = static_cast<int>(random() % 9);
        const auto near = static_cast<long>(std::pow(10.0, power)) + long(random() % 5) - 2;
        const auto exponent = static_cast<int>(random() % 90) - 50;
        expect_like_strtod(std::to_string(std::labs(near)) + "e" + std::to_string(exponent));
    }
}

TEST(ParseWholeNumber, ReadsSignsAndRefusesEverythingElse) {
    const auto whole = [](const std::string& text) {
        return parse_whole_number(text.data(), text.data() + text.size());
    };
    EXPECT_EQ(whole("123").value, 123);
    EXPECT_EQ(whole("-7 ").value, -7);
    EXPECT_EQ(whole("+7\n").value, 7);
    EXPECT_EQ(whole("123456789012345678").value, 123456789012345678);
    for (const char* text : {"", "-", "1.5", "1x", "1234567890123456789", "a"}) {
        EXPECT_EQ(whole(text).next, nullptr) << text;
    }
}

TEST(TakeDigits, AgreesWithALoopForEveryLengthAndNeighbour) {
    int asked = 0;
    for (int length = 0; length <= 19; ++length) {
        for (int after = 0; after < 256; ++after) {
            std::string text;
            std::uint64_t expected = 0;
            for (int i = 0; i < length; ++i) {
                text += static_cast<char>('0' + (i * 7 + 3) % 10);
                expected = expected * 10 + static_cast<std::uint64_t>(text.back() - '0');
            }
            const bool is_digit = after >= '0' && after <= '9';
            text += static_cast<char>(after);
            text += "\xff\x80 9:/";
            std::uint64_t value = 0;
            const char* const next = take_digits(text.data(), text.data() + text.size(), value);
            if (is_digit) continue;
            ++asked;
            ASSERT_EQ(next - text.data(), length) << after;
            ASSERT_EQ(value, expected) << after;
        }
    }
    EXPECT_GT(asked, 3'000);
}

}  // namespace
}  // namespace cdprep::import
