// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cdprep/result.h"

namespace cdprep::cli {

/// A file to read, or why there is none.
struct Input {
    std::filesystem::path path;
    std::optional<Error> error;
};

/// The files that arguments name, in their order, each once.
///
/// A folder gives its mesh files, and those of the folders in it, sorted. A pattern gives
/// what it matches, unless there is a file of that very name. A folder without a mesh
/// file, and a pattern without a match, is an Input with an error: nothing asked for is
/// passed over.
[[nodiscard]] std::vector<Input> list_inputs(const std::vector<std::string>& arguments);

/// What ends each path in a list.
enum class ListEnd {
    line,  ///< with or without a carriage return
    nul,   ///< as `git -z` and `find -print0` write; any name can be listed
};

/// The paths that a file lists, or that standard input does for "-". Empty ones are
/// skipped; none is a pattern. Fails with `unreadable`.
[[nodiscard]] Result<std::vector<std::string>> read_file_list(const std::string& name, ListEnd end);

/// Adds the files of such paths to `inputs`, as list_inputs() does.
void add_inputs(std::vector<Input>& inputs, const std::vector<std::string>& paths);

}  // namespace cdprep::cli
