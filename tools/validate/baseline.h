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

/// An older report's finding of one rule on one mesh.
struct KnownFinding {
    std::uint64_t count = 0;
    std::vector<std::uint64_t> fingerprints;  ///< ascending; fewer than count if the list was cut

    [[nodiscard]] bool is_complete() const noexcept {
        return fingerprints.size() == count;
    }
};

/// An older report's findings on one mesh.
struct KnownMesh {
    bool is_unreadable = false;
    std::map<mesh::Rule, KnownFinding> findings;

    /// Returns the largest count of a finding.
    [[nodiscard]] std::uint64_t largest_count() const noexcept;
};

/// An older JSON report to compare with.
class Baseline {
public:
    /// Parses a report; `name` is its name in error messages. Fails with `unreadable` if the
    /// text is not a report of this program. Fails likewise if the report was itself made
    /// against a baseline: it then lacks the findings known at that time.
    [[nodiscard]] static Result<Baseline> parse(std::string_view text, const std::string& name);

    /// Returns the entry for the mesh with this file_uri(); null if there is none.
    [[nodiscard]] const KnownMesh* find(const std::string& uri) const;

private:
    std::map<std::string, KnownMesh> meshes_;
};

}  // namespace cdprep::report
