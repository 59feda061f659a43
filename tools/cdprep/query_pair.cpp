// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

#include "cdprep/collide.h"
#include "effects.h"
#include "interrupt.h"
#include "open_for.h"
#include "poses_file.h"
#include "query.h"

namespace cdprep::cli {
namespace {

enum class Question : std::uint8_t { collide, overlap };

struct Arguments {
    Question question = Question::collide;
    std::filesystem::path a;
    std::filesystem::path b;
    std::filesystem::path poses;
    std::string pose;
    std::string pose_a;
    std::string pose_b;
    std::string placement = "relative";
    std::string structure = "bvh";
    std::string format = "text";
    std::string as = "surface";
    std::string contact = "closed";
    bool count = false;
    bool skip_degenerate = false;
};

/// A pose of the command line: whatever is wrong with it was asked wrongly.
Result<Pose> argument_pose(const std::string& text, const char* option) {
    if (text.empty()) return Pose();
    Result<Pose> pose = parse_pose(text, option);
    if (!pose) return Error{ErrorCode::bad_argument, pose.error().message};
    return pose;
}

/// All placements that are asked about: one pose of B a line, one pose, two
/// world poses, or none for B as it stands.
Result<std::vector<Placement>> placements_of(const Arguments& arguments) {
    if (!arguments.pose_a.empty() || !arguments.pose_b.empty()) {
        const Result<Pose> a = argument_pose(arguments.pose_a, "--pose-a");
        if (!a) return a.error();
        const Result<Pose> b = argument_pose(arguments.pose_b, "--pose-b");
        if (!b) return b.error();
        return std::vector{arguments.placement == "world"
                               ? Placement::world(a.value(), b.value())
                               : Placement::relative(a.value(), b.value())};
    }
    if (arguments.poses.empty()) {
        const Result<Pose> pose = argument_pose(arguments.pose, "--pose");
        if (!pose) return pose.error();
        return std::vector{Placement::b_moves(pose.value())};
    }
    const Result<std::vector<Pose>> poses = read_poses(arguments.poses);
    if (!poses) return poses.error();
    std::vector<Placement> placements;
    for (const Pose& pose : poses.value()) placements.push_back(Placement::b_moves(pose));
    return placements;
}

/// Answers one placement after the other with buffers that are kept.
class Asker {
public:
    Asker(const Arguments& arguments, const Model& a, const Model& b)
        : arguments_(arguments), a_(a), b_(b) {
        options_.as = arguments.as == "solid" ? As::solid : As::surface;
        options_.contact = arguments.contact == "proper" ? Contact::proper : Contact::closed;
        options_.degenerate = arguments.skip_degenerate ? Degenerate::skip : Degenerate::keep;
    }

    /// The answer's pairs stay valid until the next call.
    report::PairAnswer ask(std::size_t number, const Placement& placement) {
        report::PairAnswer answer;
        answer.pose = number;
        if (arguments_.question == Question::overlap) {
            const std::size_t count = find_pairs(placement);
            answer.hit = count > 0;
            answer.count = count;
            if (!arguments_.count) answer.pairs = std::span(pairs_).first(count);
            if (options_.as == As::surface) return answer;
        }
        const Collision collision = collide(a_, b_, placement, workspace_, options_);
        answer.hit = collision.hit;
        if (options_.as == As::solid) answer.containment = collision.containment;
        return answer;
    }

private:
    /// Asks again with more room when the pairs did not fit.
    std::size_t find_pairs(const Placement& placement) {
        const OverlapOptions options = {options_.contact, options_.degenerate};
        while (true) {
            const std::span<TrianglePair> room =
                arguments_.count ? std::span<TrianglePair>() : std::span(pairs_);
            const std::size_t count =
                overlapping_triangles(a_, b_, placement, workspace_, room, options);
            if (arguments_.count || count <= pairs_.size()) return count;
            pairs_.resize(count);
        }
    }

    const Arguments& arguments_;
    const Model& a_;
    const Model& b_;
    CollideOptions options_;
    Workspace workspace_;
    std::vector<TrianglePair> pairs_ = std::vector<TrianglePair>(4096);
};

Exit run(const Arguments& arguments) {
    if (arguments.structure != "bvh") {
        return fail("query", {ErrorCode::bad_argument, "--structure is '" + arguments.structure +
                                                           "', but this version has bvh only."});
    }
    format::SectionSet needed = sections_for("collide");
    if (arguments.question == Question::overlap) needed.insert(sections_for("overlap"));
    if (arguments.as == "surface") needed.erase(format::SectionId::components);
    const Result<Model> a = open_for(arguments.a, needed);
    if (!a) return fail("query", a.error());
    const Result<Model> b = open_for(arguments.b, needed);
    if (!b) return fail("query", b.error());
    const Result<std::vector<Placement>> placements = placements_of(arguments);
    if (!placements) return fail("query", placements.error());

    Asker asker(arguments, a.value(), b.value());
    report::Answers answers(std::cout, parse_answer_format(arguments.format));
    for (std::size_t i = 0; i < placements.value().size() && !is_interrupted(); ++i) {
        answers.add(asker.ask(i, placements.value()[i]));
    }
    answers.finish();
    return Exit::success;
}

void add_question(CLI::App& query, Question question, const char* name, const char* description,
                  Exit& exit) {
    auto arguments = std::make_shared<Arguments>();
    arguments->question = question;
    CLI::App* command = query.add_subcommand(name, description);
    command->add_option("a", arguments->a, "A baked file")->required();
    command->add_option("b", arguments->b, "A baked file")->required();
    CLI::Option* poses = command->add_option("--poses", arguments->poses,
                                             "File of poses of B in A's frame, 12 numbers a line");
    CLI::Option* pose =
        command->add_option("--pose", arguments->pose, "One pose: R row by row, then T");
    poses->excludes(pose);
    for (CLI::Option* world :
         {command->add_option("--pose-a", arguments->pose_a, "World pose of A"),
          command->add_option("--pose-b", arguments->pose_b, "World pose of B")}) {
        world->excludes(poses);
        world->excludes(pose);
    }
    command
        ->add_option("--placement", arguments->placement,
                     "With two world poses: relative moves B, world moves both")
        ->check(CLI::IsMember({"relative", "world"}))
        ->capture_default_str();
    command->add_option("--structure", arguments->structure, "bvh")->capture_default_str();
    command->add_option("--as", arguments->as, "surface or solid")
        ->check(CLI::IsMember({"surface", "solid"}))
        ->capture_default_str();
    command->add_option("--contact", arguments->contact, "closed: touching counts; or proper")
        ->check(CLI::IsMember({"closed", "proper"}))
        ->capture_default_str();
    add_answer_format(*command, arguments->format);
    command->add_flag("--skip-degenerate", arguments->skip_degenerate,
                      "Leave triangles with collinear corners out of answers");
    if (question == Question::overlap) {
        command->add_flag("--count", arguments->count, "Count the pairs, do not list them");
    }
    command->callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace

void add_pair_questions(CLI::App& query, Exit& exit) {
    add_question(query, Question::collide, "collide", "Do A and B touch?", exit);
    add_question(query, Question::overlap, "overlap", "Which triangles of A and B overlap?", exit);
}

}  // namespace cdprep::cli
