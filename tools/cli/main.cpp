// SPDX-License-Identifier: GPL-3.0-or-later
#include <exception>
#include <iostream>
#include <new>

#include "cdprep/format/float_environment.h"
#include "cli/command.h"
#include "cli/quiet.h"
#include "cli/signals.h"
#include "command_line/command_line.h"
#include "command_line/write_manuals.h"

namespace cdprep::cli {
namespace {

Exit run(int argc, char** argv) {
    const Program program("cdprep", CDPREP_VERSION, "Bake triangle meshes, and query them exactly");
    const Command root = program.root();
    Exit exit = Exit::success;
    add_bake(root, exit);
    add_info(root, exit);
    add_query(root, exit);
    add_validate(root, exit);
    add_explain(root, exit);
    add_repair(root, exit);
    add_hull(root, exit);
    add_decompose(root, exit);
    add_export(root, exit);
    add_accuracy(root, exit);
    add_compare(root, exit);
    add_simulate(root, exit);
    add_reindex(root, exit);
    for (const Command& command : root.commands()) {
        if (command.name() != "query") add_quiet(command);
    }
    root.set_notes("", {"cdprep bake arm.glb part.ply --output-dir baked",
                        "cdprep query overlap baked/arm.cdp.h5 baked/part.cdp.h5 --poses poses.txt",
                        "cdprep validate assets --format sarif -o meshes.sarif"});
    program.add_hidden("--write-manuals", [&](const std::string& folder) {
        const auto failed = write_manuals(folder, pages_of(root), CDPREP_VERSION);
        return failed ? fail("--write-manuals", *failed) : Exit::success;
    });
    watch_for_interrupts();
    watch_for_lost_pages();
    // --help and --version print too, and end the parse.
    if (const std::optional<Exit> ended = program.parse(argc, argv)) exit = *ended;
    end_by_itself();
    if (is_interrupted()) exit = Exit::interrupted;
    const bool is_written = static_cast<bool>(std::cout.flush());
    if (is_output_closed()) return Exit::interrupted;
    if (exit == Exit::success && !is_written) {
        std::cerr << "cdprep: standard output cannot be written; the result is incomplete.\n";
        exit = Exit::unwritable;
    }
    return exit;
}

}  // namespace
}  // namespace cdprep::cli

int main(int argc, char** argv) {
    using cdprep::cli::Exit;
    // A preloaded library, or one linked with -ffast-math, may have changed the settings.
    const cdprep::format::FloatEnvironment environment;
    try {
        return static_cast<int>(cdprep::cli::run(argc, argv));
    } catch (const std::bad_alloc&) {
        std::cerr << "cdprep: this needs more memory than the machine has.\n";
        return static_cast<int>(Exit::over_budget);
    } catch (const std::exception& error) {
        std::cerr << "cdprep: internal error: " << error.what() << ". Please report it.\n";
        return static_cast<int>(Exit::internal);
    }
}
