// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/glob.h"

#include <fnmatch.h>

#include <algorithm>
#include <system_error>

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> names_in(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> names;
    const fs::path read = folder.empty() ? fs::path(".") : folder;
    for (auto at = fs::directory_iterator(read, error); !error && at != fs::directory_iterator();
         at.increment(error)) {
        names.push_back(at->path().filename());
    }
    return names;
}

/// The search for the paths that match a pattern, part by part. ** does not follow links to
/// folders, so the search ends.
class Expansion {
public:
    explicit Expansion(const fs::path& pattern) : parts_(pattern.begin(), pattern.end()) {}

    std::vector<fs::path> run() {
        descend({}, 0);
        std::sort(found_.begin(), found_.end());
        found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
        return std::move(found_);
    }

private:
    void descend(const fs::path& base, std::size_t part) {
        std::error_code error;
        if (part == parts_.size()) {
            found_.push_back(base);
        } else if (parts_[part] == "**") {
            descend_any(base, part);
        } else if (!is_pattern(parts_[part].string())) {
            const fs::path next = base / parts_[part];
            if (fs::exists(fs::symlink_status(next, error))) descend(next, part + 1);
        } else {
            for (const fs::path& name : names_in(base)) {
                if (matches(parts_[part], name)) descend(base / name, part + 1);
            }
        }
    }

    void descend_any(const fs::path& base, std::size_t part) {
        std::error_code error;
        descend(base, part + 1);
        for (const fs::path& name : names_in(base)) {
            const bool is_hidden = name.native().starts_with('.');
            const fs::path next = base / name;
            const bool is_folder = fs::is_directory(fs::symlink_status(next, error));
            if (!is_hidden && is_folder) descend_any(next, part);
        }
    }

    static bool matches(const fs::path& part, const fs::path& name) {
        return ::fnmatch(part.c_str(), name.c_str(), FNM_PERIOD) == 0;
    }

    std::vector<fs::path> parts_;
    std::vector<fs::path> found_;
};

}  // namespace

bool is_pattern(const std::string& text) {
    return text.find_first_of("*?[") != std::string::npos;
}

std::vector<fs::path> expand_pattern(const std::string& pattern) {
    return Expansion(pattern).run();
}

}  // namespace cdprep::cli
