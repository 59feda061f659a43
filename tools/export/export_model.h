// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "cli/program_threads.h"
#include "export/engine.h"
#include "export/export_report.h"

namespace cdprep::cli {

struct ExportOptions {
    std::filesystem::path output;  ///< of output_for()
    double density = 1000;         ///< kilograms per cubic metre; the default is that of water
    bool has_visual = true;        ///< writes the mesh that is shown
    bool is_floating = false;      ///< MJCF: a free joint
    std::string package;           ///< URDF: HullsFileOptions::package
    bool keeps_points = false;     ///< writes every point of the parts
    bool strict = false;           ///< refuses to take an unknown unit as the metre
};

/// Writes what an engine reads of a baked file: its parts, or else the hull of the whole, and the
/// mesh itself where the engine shows one. Fails with `bad_argument` if the file was baked without
/// them. Parts of fewer than three dimensions are left out. Points that engines ignore are dropped
/// as drop_points() does, by less than the largest error that the file states.
///
/// For "-" the JSON goes to standard output. All files appear when they are complete, or none does.
[[nodiscard]] Result<report::ExportReport> export_model(const std::filesystem::path& input,
                                                        const EngineForm& form,
                                                        const ExportOptions& options,
                                                        const Threads& threads);

}  // namespace cdprep::cli
