// SPDX-License-Identifier: MIT
#include "repair/repair_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace cdprep::report {
namespace {

using mesh::kNone;
using mesh::RepairStep;

TEST(RepairJson, SaysWhereEveryTriangleAndVertexIsFrom) {
    RepairFileReport report;
    report.triangle_origin = {{4, {}}, {kNone, RepairStep::fill_holes}};
    report.vertex_origin = {{7, {}}, {2, RepairStep::weld}, {kNone, RepairStep::fill_holes}};
    const auto json = nlohmann::json::parse(repair_json(report));
    const auto text_of = [&](const char* key) {
        return json.contains(key) ? json[key].dump() : std::string("missing");
    };
    EXPECT_EQ(text_of("triangle_source"), "[4,-1]");
    EXPECT_EQ(text_of("triangle_step"), R"([null,"fill-holes"])");
    EXPECT_EQ(text_of("vertex_source"), "[7,2,-1]");
    EXPECT_EQ(text_of("vertex_step"), R"([null,"weld","fill-holes"])");
}

}  // namespace
}  // namespace cdprep::report
