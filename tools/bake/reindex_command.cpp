// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <memory>

#include "cli/command.h"
#include "write/write_file.h"

namespace cdprep::cli {

void add_reindex(const Command& app, Exit& exit) {
    auto file = std::make_shared<std::filesystem::path>();
    const Command command = app.add_command(
        "reindex", "Rebuild the section table of a file that another HDF5 tool rewrote");
    command.set_notes(
        "The runtime maps a file and finds its sections by this table. Tools that rewrite HDF5 "
        "files, such as h5repack, move the sections. The content of the sections stays as it is.",
        {"h5repack arm.cdp.h5 smaller.cdp.h5", "cdprep reindex smaller.cdp.h5"});
    command.add_option("file", *file, "A baked file (.cdp.h5)").required();
    command.callback([file, &exit] {
        const Result<Done> done = write::reindex_file(*file);
        exit = done ? Exit::success : fail("reindex", done.error());
    });
}

}  // namespace cdprep::cli
