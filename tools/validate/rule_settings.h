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

/// The sentence for a word that is no rule, with the nearest.
[[nodiscard]] std::string unknown_rule(std::string_view word);

/// How severe each rule is in a run, and which make it fail.
class RuleSettings {
public:
    /// Every rule as severe as its text says; errors make the run fail.
    RuleSettings() = default;

    /// `rules` are "RULE=off|note|warn|error", the last word on a rule wins; `fail_on`
    /// are "error", "warning" or "note", the lowest wins, or rules. A rule is an id or a
    /// name. Fails with bad_argument on other words, and when a rule is off and is to
    /// make the run fail.
    [[nodiscard]] static Result<RuleSettings> parse(const std::vector<std::string>& rules,
                                                    const std::vector<std::string>& fail_on);

    [[nodiscard]] mesh::Severity severity(mesh::Rule rule) const;

    /// Whether a finding of the rule makes the run fail.
    [[nodiscard]] bool fails(mesh::Rule rule) const;

private:
    [[nodiscard]] Result<Done> override_severity(const std::string& words);
    [[nodiscard]] Result<Done> add_fail_on(const std::string& word);

    std::map<mesh::Rule, mesh::Severity> severity_;
    mesh::Severity fail_on_ = mesh::Severity::error;  ///< off: no severity makes it fail
    std::set<mesh::Rule> fail_on_rules_;
};

}  // namespace cdprep::report
