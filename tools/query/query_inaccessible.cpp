// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/open_for.h"
#include "cli/output_path.h"
#include "cli/program_threads.h"
#include "command_line/command_page.h"
#include "query/answer_report.h"
#include "query/command.h"
#include "query/inaccessible/inaccessible.h"
#include "write/coloured_file.h"

namespace cdprep::cli {
namespace {

struct InaccessibleArguments {
    std::filesystem::path model;
    std::filesystem::path coloured;  ///< empty: none
    std::string format = "text";
    std::size_t threads = 0;
    bool count = false;
};

std::vector<Double3> positions_of(const Model& model) {
    std::vector<Double3> positions(model.mesh().positions_f64.begin(),
                                   model.mesh().positions_f64.end());
    for (const Float3& p : model.mesh().positions_f32) positions.push_back({p.x, p.y, p.z});
    return positions;
}

/// Writes the model in tree order, with the inaccessible triangles in their own colour.
Result<Done> write_coloured(const std::filesystem::path& path, const Model& model,
                            const std::vector<Double3>& positions,
                            const std::vector<std::uint32_t>& inaccessible) {
    const std::vector<write::Shade> shades = {{"accessible", {200, 200, 200}},
                                              {"inaccessible", {220, 50, 47}}};
    std::vector<std::uint8_t> shade_of(model.triangle_count());
    for (const std::uint32_t triangle : inaccessible) shade_of[triangle] = 1;
    return write::write_coloured_mesh(
        path, {positions, model.mesh().triangles, model.mesh().positions_f64.empty()}, shades,
        shade_of);
}

/// The inaccessible triangles of one model.
struct InaccessibleAnswer {
    std::uint64_t count = 0;
    std::uint64_t edge_on = 0;                              ///< the criterion does not apply
    std::uint64_t triangles = 0;                            ///< of the model
    std::optional<std::span<const std::uint32_t>> numbers;  ///< source numbers, ascending
};

std::string list(std::span<const std::uint32_t> numbers, const char* comma) {
    std::string text;
    for (const std::uint32_t number : numbers) {
        if (!text.empty()) text += comma;
        text += std::to_string(number);
    }
    return text;
}

std::string sentence(const InaccessibleAnswer& answer) {
    std::string text = std::to_string(answer.count) + " of " + std::to_string(answer.triangles) +
                       " triangles are occluded along every ray to the tetra-tree's centre";
    if (answer.edge_on > 0) {
        text += "; " + std::to_string(answer.edge_on) + " are edge-on to it and not counted";
    }
    return text + ".\n";
}

/// Returns the answer in a format. Text is a sentence, then the numbers, one per line. JSON and
/// NDJSON are one object, {"count": 2, "edge_on": 0, "triangles": 12, "inaccessible": [3, 7]}.
std::string inaccessible_text(const InaccessibleAnswer& answer, report::AnswerFormat format) {
    if (format == report::AnswerFormat::text) {
        std::string text = sentence(answer);
        if (answer.numbers && !answer.numbers->empty()) text += list(*answer.numbers, "\n") + "\n";
        return text;
    }
    std::string text = "{\"count\": " + std::to_string(answer.count) +
                       ", \"edge_on\": " + std::to_string(answer.edge_on) +
                       ", \"triangles\": " + std::to_string(answer.triangles);
    if (answer.numbers) text += ", \"inaccessible\": [" + list(*answer.numbers, ", ") + "]";
    return text + "}\n";
}

Exit run(const InaccessibleArguments& arguments) {
    if (const auto error = find_replaced_input(arguments.model, arguments.coloured)) {
        return fail("query", *error);
    }
    const Result<Model> opened = open_for(arguments.model, Ask::inaccessible);
    if (!opened) return fail("query", opened.error());
    const Model& model = opened.value();
    const std::vector<Double3> positions = positions_of(model);
    mesh::Inaccessible found;
    // A model without triangles has no cones.
    if (model.tetra_tree().tree != nullptr) {
        const Threads threads(arguments.threads);
        found = mesh::find_inaccessible(model.tetra_tree().tree->centre, positions,
                                        model.mesh().triangles, threads.parallel_for());
    }
    if (!arguments.coloured.empty()) {
        const Result<Done> written =
            write_coloured(arguments.coloured, model, positions, found.triangles);
        if (!written) return fail("query", written.error());
    }
    for (std::uint32_t& triangle : found.triangles) triangle = model.source().triangle[triangle];
    std::sort(found.triangles.begin(), found.triangles.end());
    InaccessibleAnswer answer{found.triangles.size(), found.edge_on, model.triangle_count(), {}};
    if (!arguments.count) answer.numbers = found.triangles;
    std::cout << inaccessible_text(answer, parse_answer_format(arguments.format));
    std::cout.flush();
    return Exit::success;
}

}  // namespace

void add_inaccessible(const Command& query, Exit& exit) {
    auto arguments = std::make_shared<InaccessibleArguments>();
    const Command command = query.add_command(
        "inaccessible",
        "List triangles occluded along every ray from outside to the tetra-tree's centre");
    command.set_notes("", {"cdprep query inaccessible arm.cdp.h5 --export occluded.ply"});
    command.add_option("model", arguments->model, "A file baked with --effects inaccessible")
        .required();
    command
        .add_option("--export", arguments->coloured,
                    "Also write the model with these triangles in colour: .ply or .obj")
        .type_name("FILE")
        .group("Report");
    command.add_flag("--count", arguments->count, "Count the triangles without listing them")
        .group("Query");
    add_jobs(command, arguments->threads);
    add_answer_format(command, arguments->format);
    command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace cdprep::cli
