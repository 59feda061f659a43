// SPDX-License-Identifier: MIT
#include "validate/validation_writer.h"

#include <gtest/gtest.h>

#include "validate/baseline.h"

namespace cdprep::report {
namespace {

using mesh::Rule;

ValidationRun run_of(const std::vector<std::string>& fail_on = {"warning"}) {
    ValidationRun run;
    run.tool_version = "1.2.3";
    run.rules = RuleSettings::parse({}, fail_on).value();
    run.folder = "/work";
    run.max_places = 2;
    return run;
}

/// One hole and three edges around it, of which two are kept; in two nodes.
ValidationReport with_a_hole() {
    ValidationReport report;
    report.input = "in <put> & \"co\".obj";
    report.triangles = 12;
    report.vertices = 8;
    report.exit = 1;
    report.node_of_triangle_run = {"root/arm", "root/hand"};
    report.first_triangle = {0, 10};
    report.defects.counts.boundary_edges = 3;
    report.defects.counts.boundary_loops = 1;
    report.defects.findings = {
        {Rule::boundary_edge, 3, {{{4}, {0, 1}, {0, 0.5, 0}, 1}, {{11}, {1, 2}, {0.5, 1, 0}, 1}}},
        {Rule::boundary_loop, 1, {{{4, 5, 11}, {0, 1, 2}, {0, 0, 0}, 1.5}}}};
    report.judgements = {{mesh::Severity::warning, 3, {1, 2}}, {mesh::Severity::note, 1, {3}}};
    format::Verdict verdict{};
    verdict.genus = -1;
    verdict.facts = format::verdict_two_manifold | format::verdict_crossings_examined;
    verdict.promises = format::promise_surface;
    report.defects.verdicts = {verdict, verdict};
    return report;
}

ValidationReport unreadable() {
    ValidationReport report;
    report.input = "none.obj";
    report.exit = 3;
    report.error = "none.obj: cannot be opened.";
    return report;
}

std::string written(ValidationFormat format, const ValidationRun& run,
                    const std::vector<ValidationReport>& reports) {
    ValidationWriter writer(format, run);
    std::string text = writer.head();
    for (const ValidationReport& report : reports) text += writer.add(report);
    return text + writer.tail();
}

bool holds(const std::string& text, const std::string& words) {
    return text.find(words) != std::string::npos;
}

TEST(ValidationText, NamesPlacesAndWhatIsLeftOut) {
    const std::string text =
        written(ValidationFormat::text, run_of(), {with_a_hole(), unreadable()});
    EXPECT_TRUE(holds(text, "FAILED, 0 errors, 3 warnings, 1 note; 12 triangles, 8 vertices\n"));
    EXPECT_TRUE(holds(text,
                      "warning CDP0301 Edge has one triangle: 3 (boundary-edge)\n"
                      "    triangle 4, vertices 0, 1 of root/arm at (0, 0.5, 0); its length"));
    EXPECT_TRUE(holds(text, "triangle 11, vertices 1, 2 of root/hand at"));
    EXPECT_TRUE(holds(text, "    and 1 more\n"));
    EXPECT_TRUE(holds(text, "verdict: open, 2-manifold, not orientable, not self-crossing"));
    EXPECT_TRUE(holds(text, "inside is unknown"));
    EXPECT_TRUE(holds(text, "2 files: 1 failed, 1 unreadable; 0 errors, 3 warnings, 1 note\n"));
}

// Neither "closed" nor "open" may be said of nothing.
TEST(ValidationText, HasNoWordForTheShapeOfNothing) {
    ValidationReport nothing;
    nothing.input = "nothing.obj";
    nothing.defects = mesh::find_defects({});
    nothing.judgements = {{mesh::Severity::warning, 1, {1}}};
    const std::string text = written(ValidationFormat::text, run_of(), {nothing});
    EXPECT_TRUE(holds(text,
                      "warning CDP0107 Mesh has no triangles: 1 (empty-mesh)\n"
                      "    the whole mesh\n"));
    EXPECT_TRUE(holds(text, "verdict: no triangles to judge\n"));
    EXPECT_FALSE(holds(text, "closed"));
    EXPECT_FALSE(holds(text, "open"));
}

TEST(ValidationText, ListsErrorsFirst) {
    ValidationReport report = with_a_hole();
    report.judgements[0].severity = mesh::Severity::note;
    report.judgements[1].severity = mesh::Severity::error;
    const std::string text = written(ValidationFormat::text, run_of(), {report});
    EXPECT_LT(text.find("error   CDP0302"), text.find("note    CDP0301"));
}

TEST(ValidationText, CountsOneAsOne) {
    ValidationReport report = with_a_hole();
    format::Verdict& verdict = report.defects.verdicts[0];
    report.triangles = 1;
    verdict.boundary_loops = 1;
    report.defects.verdicts.assign(4, verdict);
    const std::string text = written(ValidationFormat::text, run_of(), {report});
    EXPECT_TRUE(holds(text, "; 1 triangle, 8 vertices\n"));
    EXPECT_TRUE(holds(text, ", 1 boundary loop, area"));
    EXPECT_TRUE(holds(text, "and 1 more component\n"));
}

// Of what is known, only the sum is told.
/// The same with a search for the edges that was ended early.
ValidationReport with_a_limit() {
    ValidationReport report = with_a_hole();
    report.defects.findings[0].is_lower_bound = true;
    report.defects.crossings_complete = false;
    report.defects.counts.self_intersecting_pairs = 1040;
    mesh::DefectOptions options;
    options.max_pairs = 1000;
    remark_on_limits(report, options);
    return report;
}

TEST(ValidationWriter, EveryFormatSaysThatACountIsALowerBound) {
    const std::string text =
        written(ValidationFormat::text, run_of(), {with_a_limit(), unreadable()});
    EXPECT_TRUE(holds(text, "warning CDP0301 Edge has one triangle: at least 3 (boundary-edge)\n"));
    EXPECT_TRUE(holds(text, "    and at least 1 more\n"));
    EXPECT_TRUE(holds(text, "CDP0302 Surface has a hole: 1 ("));
    EXPECT_TRUE(holds(text, "ended after 1040 pairs of triangles that meet; a larger --max-pairs"));
    const std::string json = written(ValidationFormat::json, run_of(), {with_a_limit()});
    EXPECT_TRUE(holds(json, "\"crossings_complete\":false"));
    EXPECT_TRUE(holds(json, "\"lower_bound\":true"));
    EXPECT_TRUE(holds(json, "a larger --max-pairs finds more"));
    EXPECT_TRUE(holds(written(ValidationFormat::junit, run_of(), {with_a_limit()}),
                      "Edge has one triangle: at least 3"));
    EXPECT_TRUE(holds(written(ValidationFormat::sarif, run_of(), {with_a_limit()}),
                      "a larger --max-pairs finds more"));
    for (const ValidationFormat format :
         {ValidationFormat::text, ValidationFormat::json, ValidationFormat::junit}) {
        const std::string all = written(format, run_of(), {with_a_hole()});
        EXPECT_FALSE(holds(all, "at least") || holds(all, "lower_bound") || holds(all, "ended"));
    }
}

TEST(RemarkOnLimits, SaysWhichLimitEndedTheSearch) {
    mesh::DefectOptions options;
    options.max_pairs = 1000;
    const auto remarks = [&](bool complete, std::uint64_t pairs) {
        ValidationReport report;
        report.defects.crossings_complete = complete;
        report.defects.counts.self_intersecting_pairs = pairs;
        remark_on_limits(report, options);
        return report.remarks;
    };
    EXPECT_TRUE(remarks(true, 5000).empty());
    ASSERT_EQ(remarks(false, 1000).size(), 1U);
    EXPECT_TRUE(holds(remarks(false, 1000)[0], "after 1000 pairs"));
    EXPECT_TRUE(holds(remarks(false, 999)[0], "at the limit of its work, after 999 pairs"));
    options.crossings = false;  // nobody asked for them
    EXPECT_TRUE(remarks(false, 0).empty());
}

TEST(ValidationText, WithABaselineListsOnlyNews) {
    ValidationRun run = run_of();
    run.baseline = "old.json";
    ValidationReport known = unreadable();
    known.known_error = true;
    known.exit = 0;
    ValidationReport old = with_a_hole();
    old.defects.findings.clear();
    old.judgements.clear();
    old.known = 4;
    old.exit = 0;
    old.remarks = {"CDP0301 was compared by its count."};
    EXPECT_EQ(written(ValidationFormat::text, run, {known, old}),
              "2 files: 0 failed, 1 unreadable; 0 errors, 0 warnings, 0 notes, besides 5 known\n");
    ValidationReport fresh = with_a_hole();
    fresh.input = "fresh.obj";
    fresh.remarks = old.remarks;
    const std::string text =
        written(ValidationFormat::text, run, {known, old, fresh, unreadable()});
    EXPECT_EQ(text.find("fresh.obj: FAILED"), 0U);
    EXPECT_TRUE(holds(text, "  CDP0301 was compared by its count.\n"));
    EXPECT_TRUE(holds(text, "none.obj: UNREADABLE\n"));
}

TEST(ValidationText, EscapesControlCharacters) {
    ValidationReport report = unreadable();
    report.input = "a\x1b[2J\n\t\x7f\xc2\x9b\xc3\xbc.obj";
    report.error = report.input + ": cannot be opened.";
    const std::string text = written(ValidationFormat::text, run_of(), {report});
    EXPECT_TRUE(holds(text, "a\\x1b[2J\\n\\t\\x7f\\xc2\\x9b\xc3\xbc.obj: UNREADABLE\n  a\\x1b["));
}

TEST(ValidationJson, IsABaselineOfItself) {
    const std::string text =
        written(ValidationFormat::json, run_of(), {with_a_hole(), unreadable()});
    const Result<Baseline> baseline = Baseline::parse(text, "old.json");
    ASSERT_TRUE(baseline) << baseline.error().message;
    const KnownMesh* mesh = baseline.value().find("in%20%3Cput%3E%20%26%20%22co%22.obj");
    ASSERT_NE(mesh, nullptr);
    EXPECT_EQ(mesh->findings.at(Rule::boundary_edge).count, 3U);
    EXPECT_FALSE(mesh->findings.at(Rule::boundary_edge).is_complete());
    EXPECT_TRUE(mesh->findings.at(Rule::boundary_loop).is_complete());
    EXPECT_EQ(mesh->largest_count(), 3U);
    ASSERT_NE(baseline.value().find("none.obj"), nullptr);
    EXPECT_TRUE(baseline.value().find("none.obj")->is_unreadable);
    EXPECT_EQ(baseline.value().find("other.obj"), nullptr);
}

TEST(ValidationJson, MadeAgainstABaselineIsNone) {
    ValidationRun run = run_of();
    run.baseline = "older.json";
    const std::string text = written(ValidationFormat::json, run, {with_a_hole()});
    const Result<Baseline> baseline = Baseline::parse(text, "old.json");
    ASSERT_FALSE(baseline);
    EXPECT_EQ(baseline.error().code, ErrorCode::unreadable);
    EXPECT_TRUE(holds(baseline.error().message, "old.json"));
}

// A hole of 150 vertices names the first 100, and how many there are.
TEST(ValidationJson, BoundsTheNumbersOfAPlace) {
    ValidationReport report = with_a_hole();
    report.defects.findings[1].places[0].vertices.assign(150, 7);
    const std::string text = written(ValidationFormat::ndjson, run_of(), {report});
    EXPECT_TRUE(holds(text, "\"vertex_count\":150"));
    EXPECT_FALSE(holds(text, "\"triangle_count\""));
    EXPECT_TRUE(holds(text, "\"nodes\":[\"root/arm\",\"root/hand\"]"));
}

// A rule of a newer program is as if it were not there; the others are known.
TEST(Baseline, PassesOverARuleThatItDoesNotKnow) {
    std::string text = written(ValidationFormat::json, run_of(), {with_a_hole()});
    const std::string rule = mesh::id_of(Rule::boundary_edge);
    const std::size_t at = text.find(rule);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, rule.size(), "CDP9999");
    const Result<Baseline> baseline = Baseline::parse(text, "newer.json");
    ASSERT_TRUE(baseline) << baseline.error().message;
    const KnownMesh* mesh = baseline.value().find("in%20%3Cput%3E%20%26%20%22co%22.obj");
    ASSERT_NE(mesh, nullptr);
    EXPECT_EQ(mesh->findings.size(), 1U);
    EXPECT_EQ(mesh->findings.count(Rule::boundary_loop), 1U);
}

TEST(Baseline, RefusesWhatIsNoReport) {
    for (const char* text :
         {"", "{", "7", "[]", "null", "{}", R"({"report": 1})", R"({"report": "cdprep-validate"})",
          R"({"report": "cdprep-validate", "version": "1"})",
          R"({"report": "cdprep-validate", "version": 1, "baseline": null, "meshes": 5})",
          R"({"report": "cdprep-validate", "version": 1, "baseline": null, "meshes": [{}]})"}) {
        const Result<Baseline> baseline = Baseline::parse(text, "old.json");
        ASSERT_FALSE(baseline) << text;
        EXPECT_TRUE(holds(baseline.error().message, "old.json: ")) << text;
    }
}

TEST(Sarif, TellsOfPlacesThatAreNotListed) {
    const std::string text =
        written(ValidationFormat::sarif, run_of(), {unreadable(), with_a_hole()});
    EXPECT_TRUE(holds(text, "\"occurrenceCount\":1"));
    EXPECT_TRUE(holds(text, "1 more place is not listed"));
    EXPECT_TRUE(holds(text, "\"fullyQualifiedName\":\"root/hand/triangle 11\""));
    EXPECT_TRUE(holds(text, "\"executionSuccessful\":false,\"exitCode\":3"));
    EXPECT_TRUE(holds(text, "none.obj: cannot be opened."));
}

TEST(Junit, FailsWhatFailsTheRunAndSkipsWhatIsOff) {
    ValidationRun run = run_of();
    run.rules = RuleSettings::parse({"sliver=off"}, {"CDP0301"}).value();
    const std::string text = written(ValidationFormat::junit, run, {with_a_hole(), unreadable()});
    EXPECT_TRUE(holds(text, "name=\"in &lt;put> &amp; &quot;co&quot;.obj\""));
    EXPECT_TRUE(holds(text, "failures=\"1\" errors=\"0\" skipped=\"1\""));
    EXPECT_TRUE(holds(text, "<failure message=\"Edge has one triangle: 3\" type=\"warning\">"));
    EXPECT_TRUE(holds(text, "<system-out>note: Surface has a hole: 1\n"));
    EXPECT_TRUE(holds(text, "<error message=\"none.obj: cannot be opened.\""));
}

TEST(Junit, HoldsNoCharacterThatXmlCannot) {
    ValidationReport report = unreadable();
    report.input = "\x01\xff\xef\xbf\xbf\n.obj";
    const std::string text = written(ValidationFormat::junit, run_of(), {report});
    EXPECT_TRUE(holds(text, "name=\"\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd .obj\""));
}

TEST(ValidationWriter, SaysThatItWasStopped) {
    ValidationWriter writer(ValidationFormat::json, run_of());
    writer.set_interrupted(130);
    const std::string text = writer.head() + writer.tail();
    EXPECT_TRUE(holds(text, "\"interrupted\":true"));
    EXPECT_TRUE(holds(text, "\"exit\":130}"));
}

// Findings that the baseline knows are counted, not listed.
TEST(ValidationText, SaysHowManyFindingsAreKnown) {
    ValidationReport report = with_a_hole();
    const auto text = [&] { return written(ValidationFormat::text, run_of(), {report}); };
    EXPECT_EQ(text().find("besides"), std::string::npos);
    for (const std::uint64_t known : {1U, 2U}) {
        report.known = known;
        EXPECT_NE(text().find(", besides " + std::to_string(known) + " known; 12 triangles"),
                  std::string::npos)
            << text();
    }
}

}  // namespace
}  // namespace cdprep::report
