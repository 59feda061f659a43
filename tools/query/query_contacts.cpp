// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>
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

struct ContactArguments {
    std::filesystem::path a;
    std::filesystem::path b;
    PlacementWords placement;
    StructureWords structure;
    std::string as = "surface";
    double tolerance = 0;
    bool manifold = false;
    std::uint32_t most = 0;
    std::uint64_t budget = 0;
    double cluster_deg = 0;
    bool skip_degenerate = false;
    std::string format = "text";
};

constexpr std::array kServing = {Structure::bvh, Structure::pieces};

ContactOptions options_of(const ContactArguments& arguments) {
    return {arguments.tolerance, arguments.manifold ? Manifold::four : Manifold::none,
            arguments.most, arguments.budget, arguments.cluster_deg * std::numbers::pi / 180};
}

/// Finds the contacts of a list with a limit, or all of them.
std::vector<Contact> find_contacts(const Pair& pair, const ContactOptions& options,
                                   Workspace& workspace, ContactsVerdict& verdict) {
    // The number of all is only known once they were found, and a budget may end that earlier.
    std::vector<Contact> found(options.most > 0 ? options.most
                                                : contacts(pair, workspace, {}, options).found);
    verdict = contacts(pair, workspace, found, options);
    found.resize(verdict.count);
    return found;
}

Exit run(const ContactArguments& arguments) {
    const Result<StructureOptions> options = parse_structure(arguments.structure);
    if (!options) return fail("query", options.error());
    const Structure through = options.value().structure;
    const Body body = parse_body(arguments.as);
    const Ask asks = body == Body::solid ? Ask::contacts | Ask::solid : Ask::contacts;
    const Result<Model> a = open_for(arguments.a, asks, through);
    if (!a) return fail("query", a.error());
    const Result<Model> b = open_for(arguments.b, asks, through);
    if (!b) return fail("query", b.error());
    if (const auto unlike = find_unlike_units(arguments.a, a.value(), arguments.b, b.value())) {
        return fail("query", *unlike);
    }
    const Result<std::vector<Placement>> placements = placements_of(arguments.placement);
    if (!placements) return fail("query", placements.error());

    const Degenerate degenerate = arguments.skip_degenerate ? Degenerate::skip : Degenerate::keep;
    Workspace workspace;
    report::Answers answers(std::cout, parse_answer_format(arguments.format));
    for (std::size_t i = 0; i < placements.value().size() && !is_interrupted(); ++i) {
        const Pair pair = {a.value(),
                           b.value(),
                           placements.value()[i],
                           {.body = body, .degenerate = degenerate, .through = through}};
        ContactsVerdict verdict{};
        const std::vector<Contact> found =
            find_contacts(pair, options_of(arguments), workspace, verdict);
        answers.add(report::ContactsAnswer{i, found, verdict});
    }
    answers.finish();
    return Exit::success;
}

constexpr const char* kNotes =
    "Each line of ndjson describes one pose. 'count' is the number of contacts listed. 'found' "
    "counts pairs of pieces within the tolerance, and enclosed components; 'computed' counts those "
    "whose contact was computed. 'work' is what --budget limits. 'searched' is false if --budget "
    "ended the search. 'complete' is false if --budget or --most left contacts out. Each of "
    "'contacts' has an 'id' of two numbers. The 'id' stays the same while its two pieces are in "
    "contact. 'piece_a' and 'piece_b' are these pieces. 'normal' has length 1 and points from A to "
    "B. 'lower' and 'upper' are bounds of the distance. If the pieces overlap, both are 0 or "
    "negative, and 'overlap' is true. Then moving B by -lower along 'normal' separates the pieces. "
    "'point_a' and 'point_b' are the nearest or deepest points. 'feature_a' and 'feature_b' are "
    "the vertices, edges or triangles there, numbered as in the imported files. 'internal_edge' is "
    "true if the shortest line or way out would catch on an edge inside a surface. The normal "
    "then has another direction. "
    "'from_behind' is true if the contact is on the back of a surface. 'members' counts the "
    "contacts that --cluster-deg joined into this one. With --manifold, 'points' lists the deepest "
    "point first. Each entry has a point on each model, a distance, and an 'id' in hexadecimal. "
    "With --as solid, a component inside the other model makes a contact with 'deep' true. Moving "
    "B by -lower along the normal frees the component. For this, the files must be baked with "
    "--effects contacts,collide. The translation can be shorter if the enclosing model is baked "
    "with parts: --structures hull --parts N.";

}  // namespace

void add_contacts(const Command& query, Exit& exit) {
    auto arguments = std::make_shared<ContactArguments>();
    const Command command =
        query.add_command("contacts", "Compute contact points, normals and depths of two models");
    command.set_notes(
        kNotes,
        {"cdprep query contacts arm.cdp.h5 part.cdp.h5 --poses poses.txt --tolerance 0.01",
         "cdprep query contacts a.cdp.h5 b.cdp.h5 --tolerance 0.01 --most 16 --cluster-deg 15"});
    command.add_option("a", arguments->a, "A file baked with --effects contacts").required();
    command.add_option("b", arguments->b, "A file baked with --effects contacts").required();
    add_placements(command, arguments->placement);
    add_body(command, arguments->as);
    command
        .add_option("--tolerance", arguments->tolerance,
                    "Largest distance between two pieces in contact, in model units")
        .type_name("DISTANCE")
        .check(zero_or_more())
        .required()
        .group("Query");
    command.add_flag("--manifold", arguments->manifold, "List up to four points per pair of pieces")
        .group("Query");
    const Option most =
        command
            .add_option("--most", arguments->most,
                        "List at most N contacts: the deepest, and others spread over the surface. "
                        "Default: all")
            .type_name("N")
            .check(whole_from(1, kMostListedContacts))
            .group("Query");
    command
        .add_option("--budget", arguments->budget,
                    "Stop after this much work. A pair of near triangles counts 1. A contact "
                    "counts 32, plus 1 for every 8 triangles of its pieces. With --most, a closer "
                    "bound of a depth counts 8. Default: no limit")
        .type_name("N")
        .check(whole_from(1))
        .group("Query");
    command
        .add_option(
            "--cluster-deg", arguments->cluster_deg,
            "Join contacts linked by common pieces, if their normals differ from that of the "
            "deepest by at most this angle. A joined contact has at most four points. Needs --most")
        .type_name("DEGREES")
        .check(zero_or_more("degrees"))
        .needs(most)
        .group("Query");
    command
        .add_flag("--skip-degenerate", arguments->skip_degenerate,
                  "Ignore triangles with collinear corners")
        .group("Query");
    add_structure(
        command, arguments->structure, names_of(kServing),
        "Structure that finds near pieces: bvh, which is faster, or pieces. Both give the "
        "same answers");
    add_answer_format(command, arguments->format);
    command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace cdprep::cli
