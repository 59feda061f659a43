// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "cdprep/pairs.h"

namespace cdprep::test {

/// Expects equal bounds, triangles and points, bit for bit.
inline void expect_same(const std::optional<Distance>& x, const std::optional<Distance>& y) {
    ASSERT_EQ(x.has_value(), y.has_value());
    if (!x) return;
    ASSERT_EQ(x->lower, y->lower);
    ASSERT_EQ(x->upper, y->upper);
    ASSERT_EQ(x->triangle_a, y->triangle_a);
    ASSERT_EQ(x->triangle_b, y->triangle_b);
    ASSERT_EQ(x->witness_a, y->witness_a);
    ASSERT_EQ(x->witness_b, y->witness_b);
}

}  // namespace cdprep::test
