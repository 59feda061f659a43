// SPDX-License-Identifier: MIT
#include "text/space_name.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace cdprep::report {
namespace {

TEST(UnitName, NamesEveryUnit) {
    EXPECT_EQ(unit_name(0.001), "mm");
    EXPECT_EQ(unit_name(0.01), "cm");
    EXPECT_EQ(unit_name(1), "m");
    EXPECT_EQ(unit_name(0.0254), "in");
    EXPECT_EQ(unit_name(0.3048), "ft");
}

TEST(UnitName, GivesAnotherLengthInMetres) {
    EXPECT_EQ(unit_name(0.25), "0.25 m");
    EXPECT_EQ(unit_name(3), "3 m");
}

TEST(UnitName, KnowsNoUnitWithoutAPositiveLength) {
    for (const double length : {0.0, -0.01, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_EQ(unit_name(length), "unknown") << length;
    }
}

TEST(AxisName, NamesEveryAxis) {
    EXPECT_EQ(axis_name(format::UpAxis::x), std::string("x"));
    EXPECT_EQ(axis_name(format::UpAxis::y), std::string("y"));
    EXPECT_EQ(axis_name(format::UpAxis::z), std::string("z"));
    EXPECT_EQ(axis_name(format::UpAxis::unknown), std::string("unknown"));
}

}  // namespace
}  // namespace cdprep::report
