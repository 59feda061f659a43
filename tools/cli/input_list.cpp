// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/input_list.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iostream>
#include <set>
#include <system_error>

#include "cli/glob.h"
#include "cli/output_path.h"
#include "import/mesh_endings.h"

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;

Input missing(const fs::path& path, const std::string& why) {
    return {path, Error{ErrorCode::unreadable, path.string() + ": " + why}};
}

/// Adds every mesh file below a folder, and an error for every folder that cannot be read.
/// Links to folders are not followed, so the search ends.
void search(const fs::path& folder, std::vector<Input>& found) {
    std::error_code error;
    fs::directory_iterator at(folder, error);
    for (; !error && at != fs::directory_iterator(); at.increment(error)) {
        std::error_code unknown;
        if (at->is_directory(unknown) && !at->is_symlink(unknown)) {
            search(at->path(), found);
        } else if (import::has_mesh_ending(at->path()) && !at->is_directory(unknown)) {
            found.push_back({at->path(), std::nullopt});
        }
    }
    if (error) found.push_back(missing(folder, "cannot be searched: " + error.message() + "."));
}

void add_path(std::vector<Input>& inputs, const fs::path& path) {
    std::error_code unknown;
    if (!fs::is_directory(path, unknown)) {
        inputs.push_back({path, std::nullopt});
        return;
    }
    std::vector<Input> found;
    search(path, found);
    if (found.empty()) {
        found.push_back(missing(path, "this folder has no file with the extension of a mesh."));
    }
    std::sort(found.begin(), found.end(),
              [](const Input& a, const Input& b) { return a.path < b.path; });
    inputs.insert(inputs.end(), found.begin(), found.end());
}

void add_argument(std::vector<Input>& inputs, const std::string& argument) {
    std::error_code unknown;
    if (!is_pattern(argument) || fs::exists(fs::symlink_status(argument, unknown))) {
        add_path(inputs, argument);
        return;
    }
    const std::vector<fs::path> matches = expand_pattern(argument);
    if (matches.empty()) inputs.push_back(missing(argument, "this pattern matches no file."));
    for (const fs::path& match : matches) add_path(inputs, match);
}

/// Returns one spelling for the paths to a name in a folder. Links to the folder are followed.
fs::path place_of(const fs::path& path) {
    const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
    return without_links(folder) / path.filename();
}

/// Keeps the first of several inputs that name one file.
void keep_each_once(std::vector<Input>& inputs) {
    std::set<fs::path> seen;
    std::erase_if(inputs,
                  [&](const Input& input) { return !seen.insert(place_of(input.path)).second; });
}

std::vector<std::string> paths_of(std::istream& in, ListEnd end) {
    std::vector<std::string> paths;
    for (std::string path; std::getline(in, path, end == ListEnd::nul ? '\0' : '\n');) {
        if (end == ListEnd::line && path.ends_with('\r')) path.pop_back();
        if (!path.empty()) paths.push_back(path);
    }
    return paths;
}

}  // namespace

std::vector<Input> list_inputs(const std::vector<std::string>& arguments) {
    std::vector<Input> inputs;
    for (const std::string& argument : arguments) add_argument(inputs, argument);
    keep_each_once(inputs);
    return inputs;
}

Result<std::vector<std::string>> read_file_list(const std::string& name, ListEnd end) {
    if (name == "-") return paths_of(std::cin, end);
    std::ifstream file(name);
    if (!file) {
        return Error{ErrorCode::unreadable, name + ": the list of files cannot be read: " +
                                                std::generic_category().message(errno) + "."};
    }
    std::vector<std::string> paths = paths_of(file, end);
    if (file.bad()) {
        return Error{ErrorCode::unreadable,
                     name + ": the list of files cannot be read completely."};
    }
    return paths;
}

void add_inputs(std::vector<Input>& inputs, const std::vector<std::string>& paths) {
    for (const std::string& path : paths) add_path(inputs, path);
    keep_each_once(inputs);
}

}  // namespace cdprep::cli
