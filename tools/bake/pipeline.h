// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>

#include "bake/bake_options.h"
#include "bake/bake_report.h"
#include "cdprep/result.h"
#include "cli/program_threads.h"

namespace cdprep::cli {

/// Bakes one file: import, repair, weld, examine, arrange, build structures, write. Calls `begins`
/// with the name of each stage as it begins. Fails with the error code of the failed stage, or with
/// `interrupted` if the user stopped the program between two stages.
[[nodiscard]] Result<report::BakeReport> bake(const std::filesystem::path& input,
                                              const std::filesystem::path& output,
                                              const BakeOptions& options, const Threads& threads,
                                              const std::function<void(const char*)>& begins);

}  // namespace cdprep::cli
