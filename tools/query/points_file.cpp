// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/points_file.h"

#include <array>

#include "cli/number_rows.h"

namespace cdprep::cli {

Result<std::vector<Double3>> read_points(const std::filesystem::path& path) {
    std::vector<Double3> points;
    const Result<Done> read =
        for_each_line(path, [&](const std::string& line, const std::string& place) {
            std::array<double, 3> row{};
            Result<Done> parsed = parse_row(line, place, row);
            if (parsed) points.push_back({row[0], row[1], row[2]});
            return parsed;
        });
    if (!read) return read.error();
    return points;
}

Result<std::vector<Ray>> read_rays(const std::filesystem::path& path) {
    std::vector<Ray> rays;
    const Result<Done> read =
        for_each_line(path, [&](const std::string& line, const std::string& place) {
            std::array<double, 6> row{};
            Result<Done> parsed = parse_row(line, place, row);
            if (!parsed) return parsed;
            if (row[3] == 0 && row[4] == 0 && row[5] == 0) {
                return Result<Done>(Error{ErrorCode::unreadable,
                                          place + ": the ray's direction, numbers 4 to 6, is 0 0 "
                                                  "0; at least one of the three must not be 0."});
            }
            rays.push_back({{row[0], row[1], row[2]}, {row[3], row[4], row[5]}});
            return parsed;
        });
    if (!read) return read.error();
    return rays;
}

}  // namespace cdprep::cli
