// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "cdprep/cdprep.h"

// Invalid input structs of the C API, and how they must be refused.

namespace cdprep::test {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// How a question went.
struct Outcome {
    int code;
    int why;
    std::string argument;
    bool is_unknown;
};

/// One change of an input struct, and how it must be refused.
template <class T>
struct Mistake {
    const char* what;
    std::function<void(T&)> make;
    int why;
    const char* argument;
};

/// The mistakes that any input struct can have. `first_size` is that of its first version.
template <class T>
std::vector<Mistake<T>> struct_mistakes(const char* argument, std::size_t first_size = sizeof(T)) {
    const auto sized = [](std::uint32_t size) {
        return [size](T& given) { given.head.size = size; };
    };
    constexpr int kWhy = CDPREP_WHY_NOT_INITIALISED;
    return {
        {"zeros", [](T& given) { std::memset(static_cast<void*>(&given), 0, sizeof given); }, kWhy,
         argument},
        {"what memory held",
         [](T& given) { std::memset(static_cast<void*>(&given), 0xcd, sizeof given); }, kWhy,
         argument},
        {"another tag", [](T& given) { given.head.tag += 1; }, kWhy, argument},
        {"no tag", [](T& given) { given.head.tag = 0; }, kWhy, argument},
        {"size 0", sized(0), kWhy, argument},
        {"size 1", sized(1), kWhy, argument},
        {"size 8", sized(8), kWhy, argument},
        {"a smaller size than the first version's",
         sized(static_cast<std::uint32_t>(first_size) - 8), kWhy, argument},
        {"a size of 4 GiB", sized(UINT32_MAX), kWhy, argument},
    };
}

/// Numbers that no field takes, and 2^1001 that only limits to infinity would.
inline std::vector<std::pair<double, int>> bad_numbers() {
    return {{kNan, CDPREP_WHY_NOT_FINITE},
            {-kInfinity, CDPREP_WHY_NOT_FINITE},
            {0x1p1001, CDPREP_WHY_OUT_OF_RANGE}};
}

inline Outcome outcome(int code, const cdprep_error& error, bool is_unknown) {
    return {code, error.why, error.argument, is_unknown};
}

/// A longer struct is taken when what is unknown is 0.
template <class T, class Ask>
void expect_sizes(const T& right, Ask&& ask) {
    struct {
        T known;
        std::uint64_t unknown;
    } longer = {right, 0};
    longer.known.head.size = sizeof longer;
    EXPECT_EQ(ask(&longer.known).code, CDPREP_OK);
    longer.unknown = 1;
    const Outcome refused = ask(&longer.known);
    EXPECT_EQ(refused.code, CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(refused.why, CDPREP_WHY_NEWER_FIELD);
    EXPECT_TRUE(refused.is_unknown);
    EXPECT_EQ(ask(static_cast<const T*>(nullptr)).why, CDPREP_WHY_NULL);
}

/// Every mistake is refused as it says, and the struct without it is taken.
template <class T, class Ask>
void expect_refused(const T& right, const std::vector<Mistake<T>>& mistakes, Ask&& ask) {
    const Outcome taken = ask(&right);
    ASSERT_EQ(taken.code, CDPREP_OK) << taken.argument;
    for (const Mistake<T>& mistake : mistakes) {
        T wrong = right;
        mistake.make(wrong);
        const Outcome refused = ask(&wrong);
        EXPECT_EQ(refused.code, CDPREP_BAD_ARGUMENT) << mistake.what;
        EXPECT_EQ(refused.why, mistake.why) << mistake.what;
        EXPECT_EQ(refused.argument, mistake.argument) << mistake.what;
        EXPECT_TRUE(refused.is_unknown) << mistake.what;
    }
    expect_sizes(right, ask);
}

}  // namespace cdprep::test
