// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/validation.h"

#include <chrono>
#include <exception>
#include <new>
#include <utility>

#include "cli/colliders.h"
#include "cli/command.h"
#include "cli/signals.h"
#include "text/file_uri.h"
#include "validate/judge.h"

namespace cdprep::cli {
namespace {

using Clock = std::chrono::steady_clock;
using report::ValidationReport;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Runs one stage and records its time.
template <class Work>
auto timed(ValidationReport& report, const char* stage,
           const std::function<void(const char*)>& begins, Work work) {
    begins(stage);
    const Clock::time_point begin = Clock::now();
    auto result = work();
    report.stages.push_back({stage, seconds_since(begin)});
    return result;
}

Validation named(const std::string& input) {
    Validation result;
    result.report.input = input;
    return result;
}

void fail(ValidationReport& report, const Error& error, const report::KnownMesh* known) {
    const bool is_about_file =
        error.code == ErrorCode::unreadable || error.code == ErrorCode::over_budget;
    report.error = error.message;
    report.known_error = is_about_file && known != nullptr && known->is_unreadable;
    report.exit = report.known_error ? 0 : static_cast<int>(exit_for(error.code));
}

/// Adds the nodes: imports list triangles per node, reports list nodes per triangle.
void add_nodes(ValidationReport& report, const mesh::TriangleSoup& soup) {
    for (const format::Instance& instance : soup.instances) {
        report.first_triangle.push_back(instance.first_triangle);
        report.node_of_triangle_run.push_back(
            instance.name < soup.instance_names.size() ? soup.instance_names[instance.name] : "");
    }
}

void examine(Validation& result, const Input& input, const ValidationOptions& options,
             const report::KnownMesh* known, const Threads& threads,
             const std::function<void(const char*)>& begins) {
    ValidationReport& report = result.report;
    if (input.error) return fail(report, *input.error, known);
    import::ImportOptions limits = options.import;
    limits.parallel_for = threads.parallel_for();
    auto imported =
        timed(report, "import", begins, [&] { return import::import_file(input.path, limits); });
    if (!imported) {
        result.has_conflict = imported.error().code == ErrorCode::bad_argument;
        return fail(report, imported.error(), known);
    }
    if (is_interrupted()) return;
    result.soup = std::move(imported).value();
    report.remarks = result.soup.remarks;
    if (options.leaves_out_colliders) {
        const std::vector<std::string> colliders = leave_out_colliders(result.soup);
        if (!colliders.empty()) report.remarks.push_back(left_out_text(colliders));
    }
    const mesh::TriangleSoup& soup = result.soup;
    report.triangles = soup.triangles.size();
    report.vertices = soup.positions.size();
    add_nodes(report, soup);
    mesh::DefectOptions defects = options.defects;
    defects.max_places = options.kept_places + (known != nullptr ? known->largest_count() : 0);
    defects.stop = is_interrupted;
    defects.parallel_for = threads.parallel_for();
    report.defects =
        timed(report, "find", begins, [&] { return mesh::find_defects(soup, defects); });
    if (is_interrupted()) return;
    report::remark_on_limits(report, defects);
    const bool fails = timed(report, "judge", begins, [&] {
        return report::judge(report, soup, {options.run.rules, known, options.kept_places});
    });
    const bool is_unknown = defects.crossings && !report.defects.crossings_complete &&
                            report::fails_on_pairs(options.run.rules);
    report.exit = static_cast<int>(fails || is_unknown ? Exit::findings : Exit::success);
}

}  // namespace

Validation validate(const Input& input, const ValidationOptions& options, const Threads& threads,
                    const std::function<void(const char*)>& begins) {
    const Clock::time_point begin = Clock::now();
    const report::KnownMesh* known =
        options.baseline == nullptr
            ? nullptr
            : options.baseline->find(report::file_uri(input.path, options.run.folder));
    const std::string name = input.path.string();
    Validation result = named(name);
    try {
        examine(result, input, options, known, threads, begins);
    } catch (const std::bad_alloc&) {
        result = named(name);
        fail(result.report,
             {ErrorCode::over_budget, name + ": needs more memory than the machine has."}, known);
    } catch (const std::exception& error) {
        result = named(name);
        fail(result.report,
             {ErrorCode::internal,
              name + ": internal error: " + error.what() + ". Please report it."},
             known);
    }
    result.report.seconds = seconds_since(begin);
    return result;
}

}  // namespace cdprep::cli
