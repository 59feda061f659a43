// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include "cdprep/contacts.h"

namespace cdprep::test {

inline void expect_same(const ContactFeature& x, const ContactFeature& y) {
    EXPECT_EQ(x.kind, y.kind);
    EXPECT_EQ(x.edge, y.edge);
    EXPECT_EQ(x.triangle, y.triangle);
    EXPECT_EQ(x.vertex, y.vertex);
}

/// Expects equal contacts, bit for bit.
inline void expect_same(const Contact& x, const Contact& y) {
    EXPECT_EQ(x.piece_a, y.piece_a);
    EXPECT_EQ(x.piece_b, y.piece_b);
    expect_same(x.feature_a, y.feature_a);
    expect_same(x.feature_b, y.feature_b);
    EXPECT_EQ(x.point_a, y.point_a);
    EXPECT_EQ(x.point_b, y.point_b);
    EXPECT_EQ(x.normal, y.normal);
    EXPECT_EQ(x.lower, y.lower);
    EXPECT_EQ(x.upper, y.upper);
    EXPECT_EQ(x.flags, y.flags);
    ASSERT_EQ(x.point_count, y.point_count);
    for (std::uint32_t i = 0; i < x.point_count; ++i) {
        EXPECT_EQ(x.points[i].on_a, y.points[i].on_a);
        EXPECT_EQ(x.points[i].on_b, y.points[i].on_b);
        EXPECT_EQ(x.points[i].distance, y.points[i].distance);
    }
}

}  // namespace cdprep::test
