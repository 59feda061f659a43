// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstddef>

#include "kernels/kernels.h"

namespace cdprep::kernels {

/// Runs `check(table)` for each instruction set of this machine.
template <class Check>
void for_each_table(Check check) {
    const Available tables = available();
    for (std::size_t i = 0; i < tables.count; ++i) {
        SCOPED_TRACE(tables.table[i]->name);
        check(*tables.table[i]);
        if (::testing::Test::HasFatalFailure()) return;
    }
}

}  // namespace cdprep::kernels
