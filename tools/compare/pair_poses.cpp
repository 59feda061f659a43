// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/pair_poses.h"

#include <optional>
#include <string_view>
#include <system_error>

#include "cli/number_rows.h"
#include "cli/poses_file.h"
#include "cli/report_output.h"
#include "study/cells.h"
#include "text/printable.h"

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;

std::string line_of(const Pose& pose) {
    std::string line;
    for (const double number : pose.rotation()) line += study::formatted("%.17g ", number);
    const format::Double3& t = pose.translation();
    return line + study::formatted("%.17g ", t.x) + study::formatted("%.17g ", t.y) +
           study::formatted("%.17g\n", t.z);
}

std::string model_line(const char* role, const study::ComparedModel& model) {
    return std::string("# ") + role + " is " + report::printable(model.name) + ": " +
           std::to_string(model.built_triangles) + " triangles, hash as read " +
           study::hash_text(model.read_hash) + ", as built " + study::hash_text(model.built_hash) +
           '\n';
}

std::string file_of(const study::Comparison& comparison, const study::ComparedPair& pair) {
    std::string text =
        "# Poses by cdprep compare: R row by row, then T. A point b of B is at R b + T in A's\n"
        "# frame; both models are centred and fitted to a box of diagonal 1. ";
    text += pair.poses.source.empty() ? "Seed " + std::to_string(pair.poses.seed)
                                      : "Read from " + report::printable(pair.poses.source);
    text += ".\n";
    for (const study::ComparedModel& model : comparison.models) {
        if (model.name == pair.a) text += model_line("A", model);
        if (model.name == pair.b) text += model_line("B", model);
    }
    std::optional<study::Stratum> last;
    for (const study::StudyPose& pose : pair.poses.poses) {
        if (last != pose.stratum) {
            last = pose.stratum;
            text += std::string("# ") +
                    study::kStratumNames[static_cast<std::size_t>(pose.stratum)] + '\n';
        }
        text += line_of(pose.a_from_b);
    }
    return text;
}

Result<Done> write_text(const fs::path& path, const std::string& text) {
    Result<ReportOutput> output = ReportOutput::open(path);
    if (!output) return output.error();
    const Result<Done> written = output.value().append(text);
    return written ? output.value().finish() : written;
}

}  // namespace

fs::path pose_path(const fs::path& folder, const std::string& a, const std::string& b) {
    return folder / (a + "-" + b + ".pose");
}

Result<std::vector<study::GivenPose>> read_pair_poses(const fs::path& path) {
    std::vector<study::GivenPose> poses;
    std::optional<study::Stratum> stratum;
    const Result<Done> read = for_each_line(
        path,
        [&](const std::string& line, const std::string& place) -> Result<Done> {
            const Result<Pose> pose = parse_pose(line, place);
            if (!pose) return pose.error();
            poses.push_back({pose.value(), stratum});
            return Done{};
        },
        [&](std::string_view note) {
            if (const auto named = study::find_stratum(note)) stratum = named;
        });
    if (!read) return Error{ErrorCode::unreadable, read.error().message};
    if (poses.empty()) return Error{ErrorCode::unreadable, path.string() + ": contains no pose."};
    return poses;
}

Result<Done> write_pair_poses(const fs::path& folder, const study::Comparison& comparison,
                              UsedFiles& used) {
    for (const study::ComparedPair& pair : comparison.pairs) {
        if (Result<Done> added = used.add_output(pose_path(folder, pair.a, pair.b)); !added) {
            return added;
        }
    }
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) {
        return Error{ErrorCode::unwritable,
                     folder.string() + ": cannot be created: " + failed.message() + "."};
    }
    for (const study::ComparedPair& pair : comparison.pairs) {
        Result<Done> written =
            write_text(pose_path(folder, pair.a, pair.b), file_of(comparison, pair));
        if (!written) return written;
    }
    return Done{};
}

}  // namespace cdprep::cli
