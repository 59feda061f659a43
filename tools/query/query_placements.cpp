// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/query_placements.h"

#include "cli/poses_file.h"
#include "command_line/command_line.h"

namespace cdprep::cli {
namespace {

/// Parses a pose from the command line. Every error in it is an invalid argument.
Result<Pose> argument_pose(const std::string& text, const char* option) {
    if (text.empty()) return Pose();
    Result<Pose> pose = parse_pose(text, option);
    if (!pose) return Error{ErrorCode::bad_argument, pose.error().message};
    return pose;
}

}  // namespace

Result<std::vector<Placement>> placements_of(const PlacementWords& words) {
    if (!words.pose_a.empty() || !words.pose_b.empty()) {
        const Result<Pose> a = argument_pose(words.pose_a, "--pose-a");
        if (!a) return a.error();
        const Result<Pose> b = argument_pose(words.pose_b, "--pose-b");
        if (!b) return b.error();
        return std::vector{words.placement == "world" ? Placement::world(a.value(), b.value())
                                                      : Placement::relative(a.value(), b.value())};
    }
    if (words.poses.empty()) {
        const Result<Pose> pose = argument_pose(words.pose, "--pose");
        if (!pose) return pose.error();
        return std::vector{Placement::b_moves(pose.value())};
    }
    const Result<std::vector<Pose>> poses = read_poses(words.poses);
    if (!poses) return poses.error();
    std::vector<Placement> placements;
    for (const Pose& pose : poses.value()) placements.push_back(Placement::b_moves(pose));
    return placements;
}

void add_placements(const Command& command, PlacementWords& words) {
    const char* const group = "Placement";
    const Option poses = command
                             .add_option("--poses", words.poses,
                                         "Poses of B in A's frame. Each line has 12 numbers: the "
                                         "rotation matrix by rows, then the translation")
                             .type_name("FILE")
                             .group(group);
    const Option pose =
        command
            .add_option("--pose", words.pose, "One pose of B in A's frame, in the form of --poses")
            .type_name("POSE")
            .group(group);
    poses.excludes(pose);
    for (const Option world :
         {command.add_option("--pose-a", words.pose_a, "Pose of A in the world"),
          command.add_option("--pose-b", words.pose_b, "Pose of B in the world")}) {
        world.type_name("POSE").group(group);
        world.excludes(poses);
        world.excludes(pose);
    }
    command
        .add_option("--placement", words.placement,
                    "For --pose-a and --pose-b. relative: move B by the relative pose; world: "
                    "move both")
        .type_name("KIND")
        .check(one_of({"relative", "world"}))
        .show_default()
        .group(group);
}

}  // namespace cdprep::cli
