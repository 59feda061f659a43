// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/poses_file.h"

#include <array>

#include "cli/number_rows.h"

namespace cdprep::cli {

Result<Pose> parse_pose(const std::string& text, const std::string& place) {
    std::array<double, 12> rows{};
    if (Result<Done> parsed = parse_row(text, place, rows); !parsed) {
        return Error{
            parsed.error().code,
            parsed.error().message + " A pose is a rotation, row by row, then a translation."};
    }
    Result<Pose> pose = Pose::from_rows(rows);
    if (!pose) return Error{pose.error().code, place + ": " + pose.error().message};
    return pose;
}

Result<std::vector<Pose>> read_poses(const std::filesystem::path& path) {
    std::vector<Pose> poses;
    const Result<Done> read =
        for_each_line(path, [&](const std::string& line, const std::string& place) -> Result<Done> {
            const Result<Pose> pose = parse_pose(line, place);
            if (!pose) return Error{ErrorCode::unreadable, pose.error().message};
            poses.push_back(pose.value());
            return Done{};
        });
    if (!read) return read.error();
    return poses;
}

}  // namespace cdprep::cli
