// SPDX-License-Identifier: MIT
#include "repair/repair_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

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

// By hand: the nearest numbers of six digits are smaller than these bounds.
TEST(RepairText, RoundsUpperBoundsUpwards) {
    RepairFileReport report;
    report.repair.input_to_output.upper = 0.12345611;
    report.repair.output_to_input.upper = 1.2345611;
    report.repair.steps.emplace_back(RepairStep::weld);
    report.repair.steps.back().moved = 1 / 3.0;
    const std::string text = repair_text(report, 0);
    EXPECT_NE(text.find("at most 0.123457, from output to input at most 1.23457"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("Moved by at most 0.333334."), std::string::npos) << text;
}

}  // namespace
}  // namespace cdprep::report
