// SPDX-License-Identifier: MIT
#include "cdprep/format/float_environment.h"

#include <gtest/gtest.h>

#include <string_view>

#include "support/float_modes.h"

namespace cdprep::format {
namespace {

using test::control_bits;
using test::float_modes;
using test::FloatMode;
using test::run_in;

constexpr double kSmallest = 0x1p-1074;

// Numbers that the compiler cannot know.
[[gnu::noinline]] double sum(const volatile double* a, const volatile double* b) {
    return *a + *b;
}

// By definition of the modes: a guard computes as the default does, so 2^-1074 + 2^-1074 is
// 2^-1073 and 1 + 2^-60 is 1.
TEST(FloatEnvironment, ComputesAsByDefaultInEveryMode) {
    for (const FloatMode& mode : float_modes()) {
        volatile double tiny = kSmallest;
        volatile double one = 1;
        volatile double less = 0x1p-60;
        volatile double doubled = 0;
        volatile double rounded = 0;
        const std::uint64_t left = run_in(mode, [&] {
            const FloatEnvironment guard;
            doubled = sum(&tiny, &tiny);
            rounded = sum(&one, &less);
        });
        EXPECT_EQ(doubled, 2 * kSmallest) << mode.name;
        EXPECT_EQ(rounded, 1) << mode.name;
        EXPECT_EQ(left, control_bits(mode.control)) << mode.name;
    }
}

// The modes must differ without a guard, or the test above would prove nothing.
TEST(FloatEnvironment, ModesChangeSumsWithoutAGuard) {
    for (const FloatMode& mode : float_modes()) {
        const std::string_view name = mode.name;
        if (name == "default" || name == "trapping") continue;
        volatile double tiny = kSmallest;
        volatile double one = 1;
        volatile double less = 0x1p-60;
        volatile double doubled = 0;
        volatile double rounded = 0;
        volatile double lowered = 0;
        volatile double minus = -0x1p-60;
        (void)run_in(mode, [&] {
            doubled = sum(&tiny, &tiny);
            rounded = sum(&one, &less);
            lowered = sum(&one, &minus);
        });
        EXPECT_TRUE(doubled != 2 * kSmallest || rounded != 1 || lowered != 1) << mode.name;
    }
}

// By definition: the inner guard finds the default and changes nothing.
TEST(FloatEnvironment, NestedGuardsRestoreTheCallersEnvironmentOnce) {
    for (const FloatMode& mode : float_modes()) {
        std::uint64_t between = 0;
        const std::uint64_t left = run_in(mode, [&] {
            const FloatEnvironment outer;
            { const FloatEnvironment inner; }
            between = float_control();
        });
        EXPECT_TRUE(is_default_float_control(between)) << mode.name;
        EXPECT_EQ(left, control_bits(mode.control)) << mode.name;
    }
}

// By definition: outside() returns to the caller's environment and back.
TEST(FloatEnvironment, OutsideRunsInTheCallersEnvironment) {
    for (const FloatMode& mode : float_modes()) {
        std::uint64_t during = 0;
        std::uint64_t after = 0;
        const std::uint64_t left = run_in(mode, [&] {
            FloatEnvironment guard;
            during = guard.outside([] { return float_control(); });
            after = float_control();
        });
        EXPECT_EQ(control_bits(during), control_bits(mode.control)) << mode.name;
        EXPECT_TRUE(is_default_float_control(after)) << mode.name;
        EXPECT_EQ(left, control_bits(mode.control)) << mode.name;
    }
}

// A visitor that sets a mode means it for its own program: the guard neither computes in it
// nor takes it back.
TEST(FloatEnvironment, WhatIsSetOutsideStaysSetForTheCaller) {
    for (const FloatMode& mode : float_modes()) {
        for (const FloatMode& set : float_modes()) {
            std::uint64_t after = 0;
            const std::uint64_t left = run_in(mode, [&] {
                FloatEnvironment guard;
                guard.outside([&] { set_float_control(set.control); });
                after = float_control();
            });
            EXPECT_TRUE(is_default_float_control(after)) << mode.name << ", " << set.name;
            EXPECT_EQ(left, control_bits(set.control)) << mode.name << ", " << set.name;
        }
    }
}

// By definition: 1 / 3 raises the inexact flag, and flags change no result.
TEST(FloatEnvironment, IgnoresFlagsOfPastExceptions) {
    const FloatMode& mode = float_modes().front();
    volatile double one = 1;
    volatile double three = 3;
    std::uint64_t before = 0;
    (void)run_in(mode, [&] {
        volatile double third = one / three;
        (void)third;
        before = float_control();
    });
    EXPECT_TRUE(is_default_float_control(before));
}

}  // namespace
}  // namespace cdprep::format
