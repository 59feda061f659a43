// SPDX-License-Identifier: MIT
// A file may hold any text where bake writes JSON: other programs may have written it.
#include "info/info_report.h"

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"

namespace cdprep::report {
namespace {

using format::SectionId;

/// What info reports on a model with this text in a section.
struct Reports {
    std::string text;
    std::string json;
};

Reports reports_on(SectionId id, const std::string& content) {
    const test::TestMesh mesh = test::icosphere(0);
    format::Verdict verdict = {};
    verdict.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size());
    const std::array<format::Verdict, 2> verdicts = {verdict, verdict};  // whole and component
    const test::AlignedBytes file = test::with_sections(
        test::bake_tiny(mesh.positions, mesh.triangles),
        {test::as_section(SectionId::verdicts, std::span<const format::Verdict>(verdicts)),
         test::as_section(id, std::span(content))});
    const Result<Model> model = Model::open(file.span());
    EXPECT_TRUE(model.ok()) << model.error().message;
    return {info_text("x", *model, {}), info_json("x", *model, {})};
}

TEST(InfoReport, FindingsOfAnotherFormAreQuestionMarks) {
    for (const char* row : {R"({"rule":5,"name":"x","count":3})", R"({"rule":"\u001b[2J"})", "7",
                            R"([{}])", R"({"rule":"r","name":"n","count":"many"})", "null"}) {
        const Reports found =
            reports_on(SectionId::findings, R"({"findings":[)" + std::string(row) + "]}");
        EXPECT_EQ(found.text.find('\x1b'), std::string::npos) << row;
        EXPECT_TRUE(nlohmann::json::accept(found.json)) << row;
    }
    const std::string row = R"({"rule":"CDP0501","name":"crossing-triangles","count":12})";
    const Reports found = reports_on(SectionId::findings, R"({"findings":[)" + row + "]}");
    EXPECT_NE(found.text.find("  CDP0501 crossing-triangles: 12\n"), std::string::npos);
}

TEST(InfoReport, DeepProvenanceIsText) {
    const std::string deep = std::string(1'000'000, '[') + std::string(1'000'000, ']');
    const Reports found = reports_on(SectionId::provenance, deep);
    ASSERT_TRUE(nlohmann::json::accept(found.json));
    EXPECT_EQ(nlohmann::json::parse(found.json)["provenance"], deep);
}

}  // namespace
}  // namespace cdprep::report
