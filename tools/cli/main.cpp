// SPDX-License-Identifier: GPL-3.0-or-later
#include <exception>
#include <iostream>
#include <new>

#include "cdprep/format/float_environment.h"
#include "cli/command.h"
#include "cli/signals.h"
#include "cli/quiet.h"
#include "cli/usage.h"

namespace cdprep::cli {
namespace {

Exit run(int argc, char** argv) {
    CLI::App app{"Bake meshes to mappable files and ask them exact questions", "cdprep"};
    app.set_version_flag("--version", CDPREP_VERSION);
    app.require_subcommand(1);
    Exit exit = Exit::success;
    add_bake(app, exit);
    add_validate(app, exit);
    add_compare(app, exit);
    add_decompose(app, exit);
    add_explain(app, exit);
    add_hull(app, exit);
    add_info(app, exit);
    add_query(app, exit);
    add_reindex(app, exit);
    add_repair(app, exit);
    add_accuracy(app, exit);
    for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
        if (command->get_name() != "query") add_quiet(*command);
        command->allow_config_extras(CLI::config_extras_mode::error);
    }
    app.set_config("--config", "",
                   "Read options from a TOML file: --jobs=2 of bake as bake.jobs=2");
    app.allow_config_extras(CLI::config_extras_mode::error);
    watch_for_interrupts();
    watch_for_lost_pages();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const bool asked = error.get_exit_code() == 0;  // --help, --version
        if (!asked) {
            std::cerr << usage_sentence(app, error) << '\n';
            return Exit::usage;
        }
        app.exit(error, std::cout, std::cerr);
        return Exit::success;
    }
    end_by_itself();
    if (is_interrupted()) exit = Exit::interrupted;
    const bool is_written = static_cast<bool>(std::cout.flush());
    if (is_output_closed()) return Exit::interrupted;
    if (exit == Exit::success && !is_written) {
        std::cerr << "cdprep: standard output takes no more; the result is not complete.\n";
        exit = Exit::unwritable;
    }
    return exit;
}

}  // namespace
}  // namespace cdprep::cli

int main(int argc, char** argv) {
    using cdprep::cli::Exit;
    // A preloaded library, or one linked with -ffast-math, may have changed it.
    const cdprep::format::FloatEnvironment environment;
    try {
        return static_cast<int>(cdprep::cli::run(argc, argv));
    } catch (const std::bad_alloc&) {
        std::cerr << "cdprep: this needs more memory than the machine gives.\n";
        return static_cast<int>(Exit::over_budget);
    } catch (const std::exception& error) {
        std::cerr << "cdprep: internal error: " << error.what() << ". Please report it.\n";
        return static_cast<int>(Exit::internal);
    }
}
