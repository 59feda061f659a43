// SPDX-License-Identifier: MIT
#include "study/machine.h"

#include <gtest/gtest.h>

#include "kernels/kernels.h"

namespace cdprep::study {
namespace {

TEST(Machine, SaysWhatNumbersWereMeasuredOn) {
    const Machine machine = describe_machine();
    EXPECT_FALSE(machine.processor.empty());
    EXPECT_GE(machine.processors, 1U);
    EXPECT_GT(machine.memory, 1U << 20U);
    EXPECT_EQ(machine.kernels, kernels::active().name);
    EXPECT_TRUE(machine.compiler.starts_with("gcc ") || machine.compiler.starts_with("clang "));
    EXPECT_NE(machine.system, "unknown");
    EXPECT_FALSE(machine.build.empty());
}

}  // namespace
}  // namespace cdprep::study
