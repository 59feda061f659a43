// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cdprep/result.h"

namespace cdprep::cli {

/// A file to read, or the error that explains its absence.
struct Input {
    std::filesystem::path path;
    std::optional<Error> error;
};

/// Returns the files that the arguments name, in the order of the arguments, each once.
///
/// A folder yields its mesh files and those of its subfolders, sorted. A pattern yields its
/// matches, unless a file of exactly that name exists. A folder without a mesh file and a
/// pattern without a match each yield an Input with an error: no argument is skipped silently.
[[nodiscard]] std::vector<Input> list_inputs(const std::vector<std::string>& arguments);

/// The character that ends each path in a list.
enum class ListEnd {
    line,  ///< a line feed, with or without a carriage return before it
    nul,   ///< as `git -z` and `find -print0` write; any name can be listed
};

/// Reads a list of paths from a file, or from standard input for "-". Empty paths are
/// skipped, and no path is taken as a pattern. Fails with `unreadable`.
[[nodiscard]] Result<std::vector<std::string>> read_file_list(const std::string& name, ListEnd end);

/// Adds the files of such paths to `inputs`, as list_inputs() does, but without patterns.
void add_inputs(std::vector<Input>& inputs, const std::vector<std::string>& paths);

}  // namespace cdprep::cli
