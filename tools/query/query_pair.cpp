// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <vector>

#include "bake/structures.h"
#include "cdprep/advanced/pair_front.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/cells.h"
#include "cdprep/cells/level_of_detail.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/pairs.h"
#include "cell_searches/literal_octree.h"
#include "cli/open_for.h"
#include "cli/signals.h"
#include "command_line/command_line.h"
#include "command_line/command_page.h"
#include "query/command.h"
#include "query/pair_arguments.h"
#include "query/stopwatch.h"
#include "query/triangle_lists.h"
#include "text/structure_name.h"

namespace cdprep::cli {
namespace {

/// Returns whether a structure has cells; the BVH and the pieces have none.
bool has_cells(Structure structure) {
    return structure != Structure::bvh && structure != Structure::pieces;
}

constexpr const char* kLiteral = "hashed-octree-literal";

/// Returns whether the search of Ponce Atencio's talk ("Some techniques to speed up collision
/// detection") answers. It misses pairs.
bool asks_literally(const PairArguments& arguments) {
    return arguments.structure.structure == kLiteral;
}

/// Answers one placement after the other and reuses its buffers.
class Asker {
public:
    Asker(const PairArguments& arguments, const StructureOptions& through, const Model& a,
          const Model& b)
        : arguments_(arguments),
          through_(through),
          is_literal_(asks_literally(arguments)),
          a_(a),
          b_(b),
          errors_(arguments.errors) {
        options_.body = parse_body(arguments.as);
        options_.overlap = arguments.contact == "proper" ? Overlap::proper : Overlap::closed;
        options_.degenerate = arguments.skip_degenerate ? Degenerate::skip : Degenerate::keep;
        options_.through = through.structure;
        if (arguments.counts) workspace_.count_into(&counts_);
    }

    /// Runs the query for one placement `--repeat` times, and writes the answer once. Each run
    /// starts with the cache that the previous placement left.
    void answer(std::size_t number, const Placement& placement, report::Answers& answers) {
        const PieceCache before = cache_;
        switch (arguments_.question) {
            case PairQuestion::distance:
                return answers.add(timed([&] {
                    cache_ = before;
                    return report::DistanceAnswer{number,
                                                  distance(pair(placement), workspace_, errors_)};
                }));
            case PairQuestion::within:
                return answers.add(timed([&] {
                    cache_ = before;
                    return ask_within(number, placement);
                }));
            default:
                break;
        }
        if (arguments_.level_of_detail) {
            return answers.add(timed([&] {
                return report::CoarseAnswer{
                    number,
                    collide_at_level(pair(placement), *arguments_.level_of_detail, workspace_)};
            }));
        }
        answers.add(timed([&] {
            cache_ = before;
            return ask(number, placement);
        }));
    }

    /// Returns the times of the queries as one line of text.
    [[nodiscard]] std::string timings() {
        return stopwatch_.line();
    }

    /// Returns the counters of the queries as one line of text.
    [[nodiscard]] std::string counts() const {
        std::ostringstream line;
        line << counts_.box_pairs << " box pairs, ";
        if (has_cells(through_.structure)) line << counts_.cell_pairs << " cell pairs, ";
        line << counts_.leaf_pairs << " leaf pairs, " << counts_.triangle_pairs
             << " triangle pairs; decided " << counts_.by_kernel << " in float, "
             << counts_.by_corner << " by a common corner, " << counts_.by_filter << " in double, "
             << counts_.by_exact << " exactly; " << counts_.measured << " distances measured, "
             << counts_.measured_again << " again\n";
        return line.str();
    }

private:
    [[nodiscard]] Pair pair(const Placement& placement) {
        return {a_, b_, placement, options_, &cache_.pair, &cache_.front};
    }

    template <class Ask>
    std::invoke_result_t<Ask> timed(Ask ask) {
        return stopwatch_.timed(arguments_.repeat, arguments_.timings, ask);
    }

    /// Returns an answer whose pairs are valid until the next call.
    report::PairAnswer ask(std::size_t number, const Placement& placement) {
        report::PairAnswer answer;
        answer.pose = number;
        answer.is_approximate = is_literal_;
        if (arguments_.question == PairQuestion::overlap) {
            if (arguments_.segments) {
                answer.crossings = lists_.crossings(pair(placement), workspace_);
                answer.count = answer.crossings->size();
            } else if (is_literal_) {
                find_pairs_literally(placement, answer);
            } else if (arguments_.count) {
                answer.count = find_pairs(placement, {});
            } else {
                answer.pairs = lists_.pairs(
                    [&](std::span<TrianglePair> room) { return find_pairs(placement, room); });
                answer.count = answer.pairs->size();
            }
            answer.hit = *answer.count > 0;
            if (options_.body == Body::surface) return answer;
        }
        const Collision collision = find_collision(placement);
        answer.hit = collision.hit == Answer::yes;
        if (options_.body == Body::solid) answer.containment = collision.containment;
        return answer;
    }

    /// Returns the answer of collide(). The BVH always decides whether one solid is inside the
    /// other.
    Collision find_collision(const Placement& placement) {
        const Pair asked = pair(placement);
        if (through_.structure == Structure::bvh) return collide(asked, workspace_);
        if (any_overlap_through(asked, through_, workspace_)) return {Answer::yes, {}};
        if (options_.body == Body::surface) return {};
        const Containment inside = containment(asked, workspace_);
        return {inside.answer, inside};
    }

    /// Returns an answer whose pairs are valid until the next call.
    report::WithinAnswer ask_within(std::size_t number, const Placement& placement) {
        const double tolerance = *arguments_.tolerance;
        report::WithinAnswer answer;
        answer.pose = number;
        if (arguments_.pairs) {
            answer.pairs = lists_.pairs([&](std::span<TrianglePair> room) {
                return pairs_within(pair(placement), tolerance, workspace_, room);
            });
            answer.count = answer.pairs->size();
        } else if (arguments_.count) {
            answer.count = pairs_within(pair(placement), tolerance, workspace_, {});
        }
        answer.within =
            answer.count ? *answer.count > 0 : within(pair(placement), tolerance, workspace_);
        return answer;
    }

    std::size_t find_pairs(const Placement& placement, std::span<TrianglePair> room) {
        return overlaps_through({a_, b_, placement, options_}, through_, workspace_, room);
    }

    void find_pairs_literally(const Placement& placement, report::PairAnswer& answer) {
        std::size_t count = 0;
        literal_.clear();
        const auto keep = [&](const TrianglePair& pair) {
            if (!arguments_.count) literal_.push_back(pair);
            ++count;
            return true;
        };
        study::visit_literal_overlaps(a_, b_, placement,
                                      {.search = through_.search,
                                       .overlap = options_.overlap,
                                       .degenerate = options_.degenerate,
                                       .counts = arguments_.counts ? &counts_ : nullptr},
                                      keep);
        std::sort(literal_.begin(), literal_.end());
        answer.count = count;
        if (!arguments_.count) answer.pairs = literal_;
    }

    const PairArguments& arguments_;
    const StructureOptions through_;
    const bool is_literal_;
    const Model& a_;
    const Model& b_;
    PairOptions options_;
    DistanceOptions errors_;
    Workspace workspace_{cells()};
    TriangleLists lists_;
    std::vector<TrianglePair> literal_;
    QueryCounts counts_;
    PieceCache cache_;
    Stopwatch stopwatch_;
};

/// Returns the queries that both models must serve.
Ask asks_of(const PairArguments& arguments) {
    const bool is_solid = arguments.as == "solid";
    const Ask solid = is_solid ? Ask::solid : Ask::nothing;
    switch (arguments.question) {
        case PairQuestion::collide:
            return Ask::collide | solid;
        case PairQuestion::overlap:  // collide() decides whether solids overlap
            return is_solid ? Ask::overlap | Ask::collide | Ask::solid : Ask::overlap;
        case PairQuestion::distance:
            return Ask::distance | solid;
        default:
            return Ask::within;
    }
}

const char* name_of(PairQuestion question) {
    switch (question) {
        case PairQuestion::collide:
            return "collide";
        case PairQuestion::overlap:
            return "overlap";
        case PairQuestion::distance:
            return "distance";
        default:
            return "within";
    }
}

/// Returns the structures that serve a query.
std::span<const Structure> structures_serving(PairQuestion question) {
    static constexpr std::array<Structure, 6> kAll = {
        Structure::bvh,           Structure::pieces,
        Structure::octree,        Structure::adaptive_octree,
        Structure::hashed_octree, Structure::tetra_tree};
    const std::span<const Structure> all = kAll;
    const bool finds_pairs = question == PairQuestion::overlap || question == PairQuestion::collide;
    return finds_pairs ? all : all.first(2);
}

/// Returns an error if an option is given that the search of Ponce Atencio's talk does not support.
std::optional<Error> find_idle_for_literal(const PairArguments& arguments) {
    if (arguments.as == "solid") {
        return Error{ErrorCode::bad_argument,
                     "--as solid must find all triangles that touch, but hashed-octree-literal "
                     "misses some: use hashed-octree."};
    }
    if (arguments.structure.leaf_test.empty()) return std::nullopt;
    return Error{ErrorCode::bad_argument,
                 "--leaf-test does not apply to --structure hashed-octree-literal."};
}

/// Returns the structure and its options. Fails if another option is for a different structure.
Result<StructureOptions> structure_of(const PairArguments& arguments) {
    StructureWords words = arguments.structure;
    if (asks_literally(arguments)) {
        if (const auto error = find_idle_for_literal(arguments)) return *error;
        words.structure = report::structure_name(Structure::hashed_octree);  // reads that file
    }
    Result<StructureOptions> through = parse_structure(words);
    if (!through) return through;
    if (arguments.segments && through.value().structure != Structure::bvh) {
        return Error{ErrorCode::bad_argument,
                     "--segments requires --structure bvh: leave out --structure or --segments."};
    }
    if (arguments.level_of_detail && through.value().structure != Structure::tetra_tree) {
        return Error{ErrorCode::bad_argument,
                     "--level-of-detail is for --structure tetra-tree, but --structure is " +
                         arguments.structure.structure + "."};
    }
    return through;
}

/// Runs a query about two models.
Exit run_pair(const PairArguments& arguments) {
    if (arguments.structure.structure == report::kHullName) return run_hulls(arguments);
    const Result<StructureOptions> through = structure_of(arguments);
    if (!through) return fail("query", through.error());
    const Ask asks = asks_of(arguments);
    const Result<Model> a = open_for(arguments.a, asks, through.value().structure);
    if (!a) return fail("query", a.error());
    const Result<Model> b = open_for(arguments.b, asks, through.value().structure);
    if (!b) return fail("query", b.error());
    if (const auto unlike = find_unlike_units(arguments.a, a.value(), arguments.b, b.value())) {
        return fail("query", *unlike);
    }
    const Result<std::vector<Placement>> placements = placements_of(arguments.placement);
    if (!placements) return fail("query", placements.error());

    Asker asker(arguments, through.value(), a.value(), b.value());
    report::Answers answers(std::cout, parse_answer_format(arguments.format));
    for (std::size_t i = 0; i < placements.value().size() && !is_interrupted(); ++i) {
        asker.answer(i, placements.value()[i], answers);
    }
    answers.finish();
    if (arguments.timings) std::cerr << asker.timings();
    if (arguments.counts) std::cerr << asker.counts();
    return Exit::success;
}

/// Returns the effect that a query computes for the objects of a scene.
Ask effect_of(PairQuestion question) {
    switch (question) {
        case PairQuestion::distance:
            return Ask::distance;
        case PairQuestion::within:
            return Ask::within;
        default:
            return Ask::overlap;
    }
}

/// Returns what the arguments say about a scene. Options that were not given are left to it.
SceneQuestion scene_question(const Command& command, const PairArguments& arguments) {
    SceneQuestion scene;
    scene.question.effect = effect_of(arguments.question);
    scene.question.counts_pairs = arguments.count;
    scene.question.lists_pairs = arguments.question == PairQuestion::overlap
                                     ? !arguments.count && !arguments.segments
                                     : arguments.pairs;
    scene.question.lists_segments = arguments.segments;
    scene.question.degenerate = arguments.skip_degenerate ? Degenerate::skip : Degenerate::keep;
    scene.question.relative_error = arguments.errors.relative_error;
    scene.question.absolute_error = arguments.errors.absolute_error;
    scene.tolerance = arguments.tolerance;
    if (command.count("--max-distance") > 0) scene.max_distance = arguments.errors.max_distance;
    if (command.count("--as") > 0) scene.body = parse_body(arguments.as);
    if (command.count("--contact") > 0) {
        scene.overlap = arguments.contact == "proper" ? Overlap::proper : Overlap::closed;
    }
    if (!arguments.format.empty()) scene.format = parse_answer_format(arguments.format);
    return scene;
}

/// Returns an error if an argument is missing that a query about two models requires.
std::optional<Error> find_missing(const PairArguments& arguments) {
    if (arguments.b.empty()) {
        return Error{ErrorCode::bad_argument,
                     std::string(arguments.a.empty() ? "a is required: The first baked model"
                                                     : "b is required: The second baked model") +
                         ". Give two models, or --scene."};
    }
    if (arguments.question == PairQuestion::within && !arguments.tolerance) {
        return Error{ErrorCode::bad_argument,
                     "--tolerance is required: Largest distance that counts as within."};
    }
    return std::nullopt;
}

Exit run(const Command& command, const PairArguments& arguments) {
    const bool has_scene = !arguments.scene.scene.empty();
    if (const auto error = find_idle_for_scene(command, has_scene)) return fail("query", *error);
    if (has_scene) return run_scene(arguments.scene, scene_question(command, arguments));
    if (const auto error = find_missing(arguments)) return fail("query", *error);
    return run_pair(arguments);
}

void add_contact_options(const Command& command, PairArguments& arguments) {
    add_body(command, arguments.as);
    command
        .add_option("--contact", arguments.contact,
                    "Meaning of overlap. closed: touching counts; proper: crossing or shared area")
        .type_name("CONTACT")
        .check(one_of({"closed", "proper"}))
        .show_default()
        .group("Query");
    command
        .add_flag("--skip-degenerate", arguments.skip_degenerate,
                  "Ignore triangles with collinear corners")
        .group("Query");
}

void add_distance_options(const Command& command, PairArguments& arguments) {
    if (arguments.question == PairQuestion::within) {
        command
            .add_option("--tolerance", arguments.tolerance,
                        "Largest distance that counts as within, in model units. Required, unless "
                        "a scene file states tolerances; then only pairs of layers with a "
                        "tolerance are queried")
            .type_name("DISTANCE")
            .check(zero_or_more())
            .group("Query");
        const Option pairs = command
                                 .add_flag("--pairs", arguments.pairs,
                                           "List all triangle pairs within the tolerance")
                                 .group("Query");
        command
            .add_flag("--count", arguments.count,
                      "Count the triangle pairs within the tolerance without listing them")
            .excludes(pairs)
            .group("Query");
        return;
    }
    command
        .add_option("--relative-error", arguments.errors.relative_error,
                    "Permitted width of the distance interval, as a share of its lower bound")
        .type_name("SHARE")
        .check(zero_or_more())
        .show_default()
        .group("Query");
    command
        .add_option("--absolute-error", arguments.errors.absolute_error,
                    "Permitted width of the distance interval, in model units")
        .type_name("DISTANCE")
        .check(zero_or_more())
        .show_default()
        .group("Query");
    add_body(command, arguments.as);
    command
        .add_option("--max-distance", arguments.errors.max_distance,
                    "Do not search beyond this distance, in model units; larger distances are not "
                    "reported. Default: no limit. In a scene: the limit of the pair of layers, "
                    "else 1 % of the diagonal of the box around all objects")
        .type_name("DISTANCE")
        .check(zero_or_more())
        .group("Query");
}

/// Returns the help text on the structures that serve a query.
const char* structure_text(PairQuestion question) {
    switch (question) {
        case PairQuestion::collide:
            return "Structure of both files to search. pieces must be baked with --effects pieces, "
                   "all others but bvh with --structures. hull tests the convex hulls instead of "
                   "the meshes; all others give the same answers";
        case PairQuestion::overlap:
            return "Structure of both files to search. pieces must be baked with --effects pieces, "
                   "all others but bvh with --structures. hashed-octree-literal is a published "
                   "search of the hashed-octree that misses pairs; all others give the same "
                   "answers";
        case PairQuestion::distance:
            return "Structure of both files to search. pieces must be baked with --effects pieces, "
                   "hull with --structures hull. hull measures the distance of the convex hulls; "
                   "the others give the same answers";
        default:
            return "Structure of both files to search. pieces must be baked with --effects pieces. "
                   "Both give the same answers";
    }
}

/// Returns the values of --structure for a query.
std::vector<std::string> structure_names(PairQuestion question) {
    std::vector<std::string> names = names_of(structures_serving(question));
    if (serves_hulls(question)) names.emplace_back(report::kHullName);
    if (question == PairQuestion::overlap) names.emplace_back(kLiteral);
    return names;
}

/// Returns what a query of a scene reads of the file's pairs of layers.
std::string read_of_pairs(PairQuestion question) {
    switch (question) {
        case PairQuestion::within:
            return "tolerance. --tolerance replaces it. Touching objects clash. ";
        case PairQuestion::distance:
            return "max_distance and body. --max-distance and --as replace both. Touching objects "
                   "clash. ";
        default:
            return "overlap and body. --contact and --as replace both. Touching objects clash, "
                   "unless the overlap is proper. A pair of solids is also printed if an "
                   "unbalanced mesh hides whether one contains the other. ";
    }
}

std::string scene_notes(PairQuestion question) {
    return "Two objects are queried if the scene file pairs their layers, with that pair's " +
           read_of_pairs(question) +
           "If the file has no pairs, every object is queried against every other. In a glTF file, "
           "each node with triangles is an object, named by its path. Later nodes of the same path "
           "get #2, #3 and so on. Nodes that use one mesh share its model. A transform that "
           "deviates from a rigid one by at most 1e-5 is rounded to a rigid one. The summary "
           "states the largest deviation as 'rounding'. Other transforms that are not rigid are "
           "applied to the vertices. The answers are exact for the resulting objects. The lines do "
           "not depend on the number of threads.";
}

void add_pair_format(const Command& command, std::string& word, bool serves_scenes) {
    if (!serves_scenes) {
        word = "text";
        return add_answer_format(command, word);
    }
    command
        .add_option("--format", word, "Format of the answers. Default: text; with --scene ndjson")
        .type_name("FORMAT")
        .check(one_of({"text", "json", "ndjson"}))
        .group("Report");
}

/// Sets what follows the options in the help of a query.
void set_pair_notes(const Command& command, PairQuestion question) {
    const std::string call = "cdprep query " + std::string(name_of(question));
    const std::string tolerance = question == PairQuestion::within ? " --tolerance 0.5" : "";
    std::vector<std::string> examples = {
        call + " arm.cdp.h5 part.cdp.h5 --pose '1 0 0 0 1 0 0 0 1 0.1 0 0'" + tolerance};
    if (question == PairQuestion::collide) return command.set_notes("", examples);
    examples.push_back(call + " --scene samples/scenes/assembly.json" + tolerance);
    examples.push_back(call + " --scene robot.glb" + tolerance);
    command.set_notes(scene_notes(question), examples);
}

void add_question(const Command& query, PairQuestion question, const char* name,
                  const char* description, Exit& exit) {
    auto arguments = std::make_shared<PairArguments>();
    arguments->question = question;
    const Command command = query.add_command(name, description);
    const bool serves_scenes = question != PairQuestion::collide;
    set_pair_notes(command, question);
    const Option a = command.add_option("a", arguments->a, "The first baked model");
    const Option b = command.add_option("b", arguments->b, "The second baked model");
    if (!serves_scenes) {
        a.required();
        b.required();
    }
    add_placements(command, arguments->placement);
    add_structure(command, arguments->structure, structure_names(question),
                  structure_text(question));
    if (question == PairQuestion::collide || question == PairQuestion::overlap) {
        add_structure_steps(command, arguments->structure);
    }
    add_pair_format(command, arguments->format, serves_scenes);
    command.add_option("--repeat", arguments->repeat, "Repeat each query N times, for --timings")
        .check(whole_from(1, 1'000'000'000))
        .show_default()
        .group("Report");
    command.add_flag("--timings", arguments->timings, "Print times of the queries to stderr")
        .group("Report");
    command
        .add_flag(
            "--counts", arguments->counts,
            "Print counts to stderr: tested pairs of boxes, leaves and triangles; decisions in "
            "float, in double and exact")
        .group("Report");
    if (question == PairQuestion::collide || question == PairQuestion::overlap) {
        add_contact_options(command, *arguments);
    } else {
        add_distance_options(command, *arguments);
    }
    if (question == PairQuestion::collide) {
        command
            .add_option(
                "--level-of-detail", arguments->level_of_detail,
                "Test two solids by the cones of their tetra-trees at this level. Each cone has "
                "one facet outside its triangles and one inside. The answer is yes, no or unknown, "
                "with the level's error for each model. Needs --structure tetra-tree")
            .type_name("LEVEL")
            .check(whole_from(0U, format::kMaxTetraLevel))
            .group("Structure");
    }
    if (question == PairQuestion::overlap) {
        const Option count =
            command.add_flag("--count", arguments->count, "Count the pairs without listing them")
                .group("Query");
        command
            .add_flag("--segments", arguments->segments,
                      "Also list the segment in which each pair of triangles meets")
            .excludes(count)
            .group("Query");
    }
    if (serves_scenes) add_scene(command, arguments->scene);
    command.callback([arguments, command, &exit] { exit = run(command, *arguments); });
}

}  // namespace

void add_pair_questions(const Command& query, Exit& exit) {
    add_question(query, PairQuestion::collide, "collide", "Test whether two models collide", exit);
    add_question(query, PairQuestion::overlap, "overlap",
                 "List the pairs of overlapping triangles of two models", exit);
    add_question(query, PairQuestion::distance, "distance", "Compute the distance of two models",
                 exit);
    add_question(query, PairQuestion::within, "within",
                 "Test whether two models are within a distance", exit);
}

}  // namespace cdprep::cli
