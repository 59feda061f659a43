// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cdprep/cells.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/points.h"
#include "cli/open_for.h"
#include "cli/output_path.h"
#include "cli/signals.h"
#include "command_line/command_page.h"
#include "query/command.h"
#include "query/points_file.h"
#include "query/query_structure.h"
#include "write/coloured_file.h"

namespace cdprep::cli {
namespace {

struct PointArguments {
    std::filesystem::path model;
    std::filesystem::path places;  ///< file of points or rays
    std::string format = "text";
    StructureWords structure;
    std::filesystem::path coloured;  ///< file for the points, coloured by answer; empty: none
};

/// The answers about a point, by number. `unknown` occurs for unbalanced models.
const std::vector<write::Shade> kShades = {{"outside", {150, 150, 150}},
                                           {"inside", {220, 50, 47}},
                                           {"on_surface", {240, 190, 40}},
                                           {"unknown", {90, 90, 220}}};

std::uint8_t shade_of(const Inclusion& inclusion) {
    if (inclusion.on_surface) return 2;
    if (inclusion.answer == Answer::unknown) return 3;
    return inclusion.answer == Answer::yes ? 1 : 0;
}

/// One query about one model, for many points or rays.
template <class Place>
struct PointQuestion {
    const char* name;
    Ask ask_of_model;
    const char* description;
    const char* option;  ///< --points or --rays
    const char* option_description;
    Result<std::vector<Place>> (*read)(const std::filesystem::path&);
    std::span<const Structure> serving;  ///< the structures that serve it
    const char* structure_description;
    const char* example;
    bool can_export;  ///< the points can be exported, coloured by answer
    /// Returns the number of the shade in which the place is exported.
    std::uint8_t (*ask)(const Model&, const Place&, Structure, Workspace&, std::size_t number,
                        report::Answers&);
};

std::uint8_t ask_inside(const Model& model, const Double3& point, Structure through,
                        Workspace& workspace, std::size_t number, report::Answers& answers) {
    const Inclusion inclusion = points_inside(model, point, workspace, through);
    answers.add(report::InsideAnswer{number, inclusion});
    return shade_of(inclusion);
}

std::uint8_t ask_closest(const Model& model, const Double3& point, Structure /*through*/,
                         Workspace& workspace, std::size_t number, report::Answers& answers) {
    answers.add(report::ClosestAnswer{number, closest_point(model, point, workspace)});
    return 0;
}

std::uint8_t ask_ray(const Model& model, const Ray& ray, Structure /*through*/,
                     Workspace& workspace, std::size_t number, report::Answers& answers) {
    answers.add(report::RayAnswer{number, cast_ray(model, ray, workspace)});
    return 0;
}

constexpr std::array<Structure, 5> kServingInside = {
    Structure::bvh, Structure::octree, Structure::adaptive_octree, Structure::hashed_octree,
    Structure::tetra_tree};
constexpr std::span<const Structure> kBvhAlone = std::span(kServingInside).first(1);

constexpr const char* kThroughInside =
    "Structure to search. All but bvh must be baked with --structures. All give the same answers";
constexpr const char* kThroughBvh = "Structure to search";

constexpr PointQuestion<Double3> kInside = {"inside",
                                            Ask::inside,
                                            "Test whether points are inside a model",
                                            "--points",
                                            "A file with points: 3 numbers per line",
                                            read_points,
                                            kServingInside,
                                            kThroughInside,
                                            "cdprep query inside arm.cdp.h5 --points points.txt",
                                            true,
                                            ask_inside};
constexpr PointQuestion<Double3> kClosest = {"closest",
                                             Ask::closest,
                                             "Find the closest point of a model to each point",
                                             "--points",
                                             "A file with points: 3 numbers per line",
                                             read_points,
                                             kBvhAlone,
                                             kThroughBvh,
                                             "cdprep query closest arm.cdp.h5 --points points.txt",
                                             false,
                                             ask_closest};
constexpr PointQuestion<Ray> kRay = {"ray",
                                     Ask::ray,
                                     "Find the first triangle that each ray hits",
                                     "--rays",
                                     "A file with rays: 6 numbers per line, origin and direction",
                                     read_rays,
                                     kBvhAlone,
                                     kThroughBvh,
                                     "cdprep query ray arm.cdp.h5 --rays rays.txt",
                                     false,
                                     ask_ray};

/// Does nothing: rays are not exported.
Exit export_places(const std::filesystem::path& /*path*/, const std::vector<Ray>& /*rays*/,
                   const std::vector<std::uint8_t>& /*shades*/) {
    return Exit::success;
}

/// Exports the answered points: the first ones if the user interrupted the query.
Exit export_places(const std::filesystem::path& path, const std::vector<Double3>& points,
                   const std::vector<std::uint8_t>& shades) {
    if (path.empty()) return Exit::success;
    const Result<Done> written =
        write::write_coloured_points(path, std::span(points).first(shades.size()), kShades, shades);
    return written ? Exit::success : fail("query", written.error());
}

/// Returns an error if the export would replace a file that is read.
std::optional<Error> find_bad_export(const PointArguments& arguments) {
    UsedFiles used;
    used.add_input(arguments.model);
    used.add_input(arguments.places);
    const Result<Done> added = used.add_output(arguments.coloured);
    return added ? std::nullopt : std::optional(added.error());
}

template <class Place>
Exit run(const PointArguments& arguments, const PointQuestion<Place>& question) {
    if (const auto error = find_bad_export(arguments)) return fail("query", *error);
    const Result<StructureOptions> through = parse_structure(arguments.structure);
    if (!through) return fail("query", through.error());
    const Structure structure = through.value().structure;
    const Result<Model> model = open_for(arguments.model, question.ask_of_model, structure);
    if (!model) return fail("query", model.error());
    const Result<std::vector<Place>> places = question.read(arguments.places);
    if (!places) return fail("query", places.error());
    Workspace workspace(cells());
    report::Answers answers(std::cout, parse_answer_format(arguments.format));
    std::vector<std::uint8_t> shades;
    for (std::size_t i = 0; i < places.value().size() && !is_interrupted(); ++i) {
        shades.push_back(
            question.ask(model.value(), places.value()[i], structure, workspace, i, answers));
    }
    answers.finish();
    return export_places(arguments.coloured, places.value(), shades);
}

template <class Place>
void add_question(const Command& query, const PointQuestion<Place>& question, Exit& exit) {
    auto arguments = std::make_shared<PointArguments>();
    const Command command = query.add_command(question.name, question.description);
    command.add_option("model", arguments->model, "A baked model").required();
    command.set_notes("", {question.example});
    command.add_option(question.option, arguments->places, question.option_description)
        .type_name("FILE")
        .required()
        .group("Query");
    if (question.can_export) {
        command
            .add_option("--export", arguments->coloured,
                        "Also write the points in colours: .ply or .obj. Inside: red; outside: "
                        "grey; on the surface: yellow; unknown: blue")
            .type_name("FILE")
            .group("Report");
    }
    add_structure(command, arguments->structure, names_of(question.serving),
                  question.structure_description);
    add_answer_format(command, arguments->format);
    command.callback([arguments, &question, &exit] { exit = run(*arguments, question); });
}

}  // namespace

void add_point_questions(const Command& query, Exit& exit) {
    add_question(query, kInside, exit);
    add_question(query, kClosest, exit);
    add_question(query, kRay, exit);
}

}  // namespace cdprep::cli
