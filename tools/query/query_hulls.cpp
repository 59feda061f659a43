// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <iostream>
#include <string>
#include <utility>

#include "cdprep/advanced/convex_distance.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/hulls.h"
#include "cli/open_for.h"
#include "cli/signals.h"
#include "query/command.h"
#include "query/pair_arguments.h"
#include "query/stopwatch.h"

namespace cdprep::cli {
namespace {

/// Returns an error if an option is given that queries on convex hulls do not support.
std::optional<Error> find_idle_for_hulls(const PairArguments& arguments) {
    const std::array<std::pair<const char*, bool>, 6> options = {
        {{"--leaf-test", !arguments.structure.leaf_test.empty()},
         {"--descent", !arguments.structure.descent.empty()},
         {"--search", !arguments.structure.search.empty()},
         {"--level-of-detail", arguments.level_of_detail.has_value()},
         {"--contact proper", arguments.contact == "proper"},
         {"--skip-degenerate", arguments.skip_degenerate}}};
    for (const auto& [option, is_given] : options) {
        if (!is_given) continue;
        return Error{
            ErrorCode::bad_argument,
            std::string(option) +
                " does not apply to convex hulls: leave it out, or use another --structure."};
    }
    return std::nullopt;
}

Result<Model> open_hulls(const std::filesystem::path& path) {
    Result<Model> opened = open_for(path, Ask::hulls);
    if (!opened || find_hull(opened.value(), format::HullScope::whole)) return opened;
    return Error{ErrorCode::bad_argument,
                 path.string() +
                     ": has no convex hull of the whole model. Bake the mesh again with "
                     "--structures hull."};
}

std::string hull_counts(const QueryCounts& counts) {
    std::ostringstream line;
    line << counts.hull_pairs << " hull pairs, " << counts.hull_steps
         << " steps (each finds a farthest point of both hulls); decided " << counts.hulls_by_exact
         << " exactly, in " << counts.exact_steps << " steps\n";
    return line.str();
}

}  // namespace

bool serves_hulls(PairQuestion question) {
    return question == PairQuestion::collide || question == PairQuestion::distance;
}

Exit run_hulls(const PairArguments& arguments) {
    if (const auto error = find_idle_for_hulls(arguments)) return fail("query", *error);
    const Result<Model> a = open_hulls(arguments.a);
    if (!a) return fail("query", a.error());
    const Result<Model> b = open_hulls(arguments.b);
    if (!b) return fail("query", b.error());
    if (const auto unlike = find_unlike_units(arguments.a, a.value(), arguments.b, b.value())) {
        return fail("query", *unlike);
    }
    const Result<std::vector<Placement>> placements = placements_of(arguments.placement);
    if (!placements) return fail("query", placements.error());

    const ConvexPoints of_a = convex_points(a.value(), 0), of_b = convex_points(b.value(), 0);
    const DistanceOptions options = {arguments.errors.relative_error,
                                     arguments.errors.absolute_error,
                                     arguments.errors.max_distance};
    ConvexCache cache;
    QueryCounts counts;
    QueryCounts* const counted = arguments.counts ? &counts : nullptr;
    Stopwatch stopwatch;
    report::Answers answers(std::cout, parse_answer_format(arguments.format));
    for (std::size_t i = 0; i < placements.value().size() && !is_interrupted(); ++i) {
        const Placement& placement = placements.value()[i];
        const ConvexCache before = cache;
        const auto timed = [&](auto ask) {
            return stopwatch.timed(arguments.repeat, arguments.timings, [&] {
                cache = before;
                return ask();
            });
        };
        if (arguments.question == PairQuestion::collide) {
            answers.add(report::HullCollideAnswer{
                i, timed([&] { return convex_collide(of_a, of_b, placement, &cache, counted); })});
        } else {
            answers.add(report::HullDistanceAnswer{
                i, timed([&] {
                    return convex_distance(of_a, of_b, placement, options, &cache, counted);
                })});
        }
    }
    answers.finish();
    if (arguments.timings) std::cerr << stopwatch.line();
    if (arguments.counts) std::cerr << hull_counts(counts);
    return Exit::success;
}

}  // namespace cdprep::cli
