// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "cdprep/result.h"
#include "validate/defects/rule.h"

namespace cdprep::report {

/// What an older report says of one rule on one mesh.
struct KnownFinding {
    std::uint64_t count = 0;
    std::vector<std::uint64_t> fingerprints;  ///< ascending; fewer than count when cut short

    [[nodiscard]] bool is_complete() const noexcept {
        return fingerprints.size() == count;
    }
};

/// What an older report says of one mesh.
struct KnownMesh {
    bool is_unreadable = false;
    std::map<mesh::Rule, KnownFinding> findings;

    /// Most findings of one rule.
    [[nodiscard]] std::uint64_t largest_count() const noexcept;
};

/// An older JSON report, to compare with.
class Baseline {
public:
    /// `name` stands in sentences. Fails with `unreadable` when the text is not a report
    /// of ours, and when it was itself made against a baseline and so lacks what was
    /// known then.
    [[nodiscard]] static Result<Baseline> parse(std::string_view text, const std::string& name);

    /// What it says of the mesh with this file_uri(); null when nothing.
    [[nodiscard]] const KnownMesh* find(const std::string& uri) const;

private:
    std::map<std::string, KnownMesh> meshes_;
};

}  // namespace cdprep::report
