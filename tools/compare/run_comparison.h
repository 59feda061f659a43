// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cdprep/result.h"
#include "import/import_file.h"
#include "cli/program_threads.h"
#include "cli/progress.h"
#include "compare/comparison.h"

namespace cdprep::cli {

/// Which pairs Table 4 asks.
enum class PairChoice : std::uint8_t {
    fitting,  ///< those of the paper when every model is one of its own, else all
    paper,    ///< those of the paper
    all,      ///< every two of the models; of a single one, itself
};

/// The tables that can be made.
struct TableChoice {
    bool features = true;     ///< 1
    bool spatial = true;      ///< 2
    bool preparation = true;  ///< 3
    bool pairs = true;        ///< 4
    bool talk = true;
};

struct ComparisonOptions {
    TableChoice tables;
    PairChoice pairs = PairChoice::fitting;
    bool quick = false;
    std::uint64_t seed = 1;
    std::size_t per_stratum = 0;  ///< poses; 0: as many as suit
    std::filesystem::path poses;  ///< a folder that holds them, as pair_poses.h says, or empty
    std::size_t rounds = 0;       ///< 0: as many as suit
    std::filesystem::path peers;  ///< a program, or empty
    std::size_t threads = 0;
    import::ImportOptions import;
};

/// Reads the models and measures all that the tables say. Fails with the first model that
/// cannot be compared, or the first pair whose poses cannot be read, before anything is measured;
/// with `interrupted` when the person stops it.
[[nodiscard]] Result<study::Comparison> compare_models(
    const std::vector<std::filesystem::path>& files, const ComparisonOptions& options,
    const Threads& threads, ProgressStyle style);

/// How many poses and rounds are measured when none are asked for.
[[nodiscard]] ComparisonOptions settled(ComparisonOptions options);

}  // namespace cdprep::cli
