// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "cdprep/result.h"
#include "validate/defects/rule.h"

namespace cdprep::report {

/// Returns the message for a word that is not a rule, with the nearest rule.
[[nodiscard]] std::string unknown_rule(std::string_view word);

/// The severity of each rule in a run, and the rules that make the run fail.
class RuleSettings {
public:
    /// Every rule has its default severity; errors make the run fail.
    RuleSettings() = default;

    /// Parses the settings. `rules` are "RULE=off|note|warn|error"; the last setting of a rule
    /// wins. `fail_on` holds rules, or "error", "warning" or "note", of which the lowest wins. A
    /// rule is an id or a name. Fails with bad_argument on other words, and if a rule is off but
    /// is to make the run fail.
    [[nodiscard]] static Result<RuleSettings> parse(const std::vector<std::string>& rules,
                                                    const std::vector<std::string>& fail_on);

    [[nodiscard]] mesh::Severity severity(mesh::Rule rule) const;

    /// Returns whether a finding of the rule makes the run fail.
    [[nodiscard]] bool fails(mesh::Rule rule) const;

private:
    [[nodiscard]] Result<Done> override_severity(const std::string& words);
    [[nodiscard]] Result<Done> add_fail_on(const std::string& word);

    std::map<mesh::Rule, mesh::Severity> severity_;
    mesh::Severity fail_on_ = mesh::Severity::error;  ///< off: no severity makes the run fail
    std::set<mesh::Rule> fail_on_rules_;
};

}  // namespace cdprep::report
