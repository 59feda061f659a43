// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "cli/import_arguments.h"
#include "query/clash_search.h"

namespace cdprep::cli {

/// The command-line arguments of a query about all pairs of a scene's objects.
struct SceneArguments {
    std::filesystem::path scene;  ///< empty: the query is about two models
    std::filesystem::path cache;
    std::string progress = "auto";
    std::size_t threads = 0;
    ImportArguments import;
};

/// The query as the command line gives it. The scene gives the rest.
struct SceneQuestion {
    ClashQuestion question;
    std::optional<double> tolerance;
    std::optional<double> max_distance;
    std::optional<Body> body;
    std::optional<Overlap> overlap;
    report::AnswerFormat format = report::AnswerFormat::ndjson;
};

/// Without a limit, distances up to this share of the scene's size are listed.
inline constexpr double kDefaultReach = 0.01;

/// Adds --scene, --cache, --jobs, --progress and the options of imports. `arguments` must outlive
/// the command.
void add_scene(const Command& command, SceneArguments& arguments);

/// Returns an error if an option does not fit. With --scene, this is an option only for two
/// models. Without it, it is an option only for a scene.
[[nodiscard]] std::optional<Error> find_idle_for_scene(const Command& command, bool has_scene);

/// Asks all pairs of objects whose layers are paired, and writes the clashes and a summary.
Exit run_scene(const SceneArguments& arguments, const SceneQuestion& question);

}  // namespace cdprep::cli
