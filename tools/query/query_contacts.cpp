// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

#include "cdprep/cells/overlap_through.h"
#include "cdprep/contacts.h"
#include "cli/open_for.h"
#include "cli/signals.h"
#include "command_line/command_line.h"
#include "command_line/command_page.h"
#include "query/command.h"
#include "query/query_placements.h"
#include "query/query_structure.h"

namespace cdprep::cli {
namespace {

struct Arguments {
    std::filesystem::path a;
    std::filesystem::path b;
    PlacementWords placement;
    StructureWords structure;
    double tolerance = 0;
    bool manifold = false;
    bool skip_degenerate = false;
    std::string format = "text";
};

constexpr std::array kServing = {Structure::bvh, Structure::pieces};

std::vector<Contact> find_contacts(const Model& a, const Model& b, const Placement& placement,
                                   const Arguments& arguments, Structure through,
                                   Workspace& workspace) {
    std::vector<Contact> found;
    const auto keep = [&](const Contact& contact) {
        found.push_back(contact);
        return true;
    };
    const Degenerate degenerate = arguments.skip_degenerate ? Degenerate::skip : Degenerate::keep;
    visit_contacts({a, b, placement, {.degenerate = degenerate, .through = through}}, workspace,
                   keep,
                   {arguments.tolerance, arguments.manifold ? Manifold::four : Manifold::none});
    return found;
}

Exit run(const Arguments& arguments) {
    const Result<StructureOptions> options =
        parse_structure(arguments.structure, "contacts", kServing);
    if (!options) return fail("query", options.error());
    const Structure through = options.value().structure;
    const Result<Model> a = open_for(arguments.a, Ask::contacts, through);
    if (!a) return fail("query", a.error());
    const Result<Model> b = open_for(arguments.b, Ask::contacts, through);
    if (!b) return fail("query", b.error());
    const Result<std::vector<Placement>> placements = placements_of(arguments.placement);
    if (!placements) return fail("query", placements.error());

    Workspace workspace;
    report::Answers answers(std::cout, parse_answer_format(arguments.format));
    for (std::size_t i = 0; i < placements.value().size() && !is_interrupted(); ++i) {
        const std::vector<Contact> found = find_contacts(
            a.value(), b.value(), placements.value()[i], arguments, through, workspace);
        answers.add(report::ContactsAnswer{i, found});
    }
    answers.finish();
    return Exit::success;
}

}  // namespace

void add_contacts(const Command& query, Exit& exit) {
    auto arguments = std::make_shared<Arguments>();
    const Command command =
        query.add_command("contacts", "Compute contact points, normals and depths of two models");
    command.set_notes(
        "", {"cdprep query contacts arm.cdp.h5 part.cdp.h5 --poses poses.txt --tolerance 0.01"});
    command.add_option("a", arguments->a, "A file baked with --effects contacts").required();
    command.add_option("b", arguments->b, "A file baked with --effects contacts").required();
    add_placements(command, arguments->placement);
    command
        .add_option("--tolerance", arguments->tolerance,
                    "Largest distance of two pieces that counts, in model units")
        .type_name("DISTANCE")
        .check(zero_or_more())
        .required()
        .group("Query");
    command.add_flag("--manifold", arguments->manifold, "List up to four points per pair of pieces")
        .group("Query");
    command
        .add_flag("--skip-degenerate", arguments->skip_degenerate,
                  "Ignore triangles with collinear corners")
        .group("Query");
    add_structure(
        command, arguments->structure,
        "Structure that finds near pieces: bvh, which is faster, or pieces. Both give the "
        "same answers");
    add_answer_format(command, arguments->format);
    command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace cdprep::cli
