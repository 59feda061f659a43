// SPDX-License-Identifier: GPL-3.0-or-later
#include <exception>
#include <iostream>
#include <new>

#include "cdprep/format/float_environment.h"
#include "cli/command.h"
#include "cli/quiet.h"
#include "cli/signals.h"
#include "cli/usage.h"
#include "manuals/help_text.h"
#include "manuals/write_manuals.h"

namespace cdprep::cli {
namespace {

/// What every command has, and the texts of help.
void add_general_options(CLI::App& app) {
    app.set_config("--config", "",
                   "Read options from a TOML file: bake.jobs=2 means --jobs=2 of bake")
        ->type_name("FILE");
    app.allow_config_extras(CLI::config_extras_mode::error);
    for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
        if (command->get_name() != "query") add_quiet(*command);
        command->allow_config_extras(CLI::config_extras_mode::error);
    }
    for (const char* const name : {"--version", "--config"}) app.get_option(name)->group("General");
    app.get_option("--version")->description("Print the version and exit");
    use_help_text(app);
    const auto describe = [](const auto& again, CLI::App& command) -> void {
        command.get_help_ptr()->description("Print this help and exit")->group("General");
        for (CLI::App* each : command.get_subcommands([](const CLI::App*) { return true; })) {
            again(again, *each);
        }
    };
    describe(describe, app);
    set_notes(app, "",
              {"cdprep bake arm.glb part.ply --output-dir baked",
               "cdprep query overlap baked/arm.cdp.h5 baked/part.cdp.h5 --poses poses.txt",
               "cdprep validate assets --format sarif -o meshes.sarif"});
}

Exit run(int argc, char** argv) {
    CLI::App app{"Bake triangle meshes, and query them exactly", "cdprep"};
    app.set_version_flag("--version", CDPREP_VERSION);
    app.require_subcommand(1);
    Exit exit = Exit::success;
    add_bake(app, exit);
    add_info(app, exit);
    add_query(app, exit);
    add_validate(app, exit);
    add_explain(app, exit);
    add_repair(app, exit);
    add_hull(app, exit);
    add_decompose(app, exit);
    add_accuracy(app, exit);
    add_compare(app, exit);
    add_reindex(app, exit);
    add_general_options(app);
    const auto write = [&](const std::string& folder) {
        const auto failed = write_manuals(folder, pages_of(app), CDPREP_VERSION);
        throw CLI::RuntimeError(
            static_cast<int>(failed ? fail("--write-manuals", *failed) : Exit::success));
    };
    app.add_option_function<std::string>("--write-manuals", write, "")
        ->group("")
        ->trigger_on_parse();
    watch_for_interrupts();
    watch_for_lost_pages();
    try {
        app.parse(argc, argv);
    } catch (const CLI::RuntimeError& ended) {
        return static_cast<Exit>(ended.get_exit_code());
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
        std::cerr << "cdprep: standard output cannot be written; the result is incomplete.\n";
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
        std::cerr << "cdprep: this needs more memory than the machine has.\n";
        return static_cast<int>(Exit::over_budget);
    } catch (const std::exception& error) {
        std::cerr << "cdprep: internal error: " << error.what() << ". Please report it.\n";
        return static_cast<int>(Exit::internal);
    }
}
