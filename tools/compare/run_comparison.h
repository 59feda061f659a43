// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "cdprep/result.h"
#include "cli/program_threads.h"
#include "cli/progress.h"
#include "compare/comparison.h"
#include "import/import_file.h"

namespace cdprep::cli {

/// The pairs in Table 4.
enum class PairChoice : std::uint8_t {
    fitting,  ///< as `paper` if every model is one of the comparative study's, else as `all`
    paper,    ///< those of the comparative study
    all,      ///< every two of the models; a single model with itself
};

/// The tables to make.
struct TableChoice {
    bool features = true;     ///< Table 1
    bool spatial = true;      ///< Table 2
    bool preparation = true;  ///< Table 3
    bool pairs = true;        ///< Table 4
    bool talk = true;
};

struct ComparisonOptions {
    TableChoice tables;
    PairChoice pairs = PairChoice::fitting;
    bool quick = false;
    std::uint64_t seed = 1;
    std::size_t per_stratum = 0;  ///< poses; 0: the default number
    std::filesystem::path poses;  ///< a folder with pose files (pair_poses.h), or empty
    std::size_t rounds = 0;       ///< 0: the default number
    std::filesystem::path peers;  ///< a program, or empty
    std::size_t threads = 0;
    import::ImportOptions import;
};

/// Reads the models and measures everything in the chosen tables. Fails with the first model that
/// cannot be compared, or the first pair whose poses cannot be read, before any measurement. Fails
/// with `interrupted` if the user stops it.
[[nodiscard]] Result<study::Comparison> compare_models(
    const std::vector<std::filesystem::path>& files, const ComparisonOptions& options,
    const Threads& threads, ProgressStyle style);

/// Sets the default numbers of poses and rounds where none are given.
[[nodiscard]] ComparisonOptions settled(ComparisonOptions options);

}  // namespace cdprep::cli
