// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/rule_settings.h"

#include <algorithm>
#include <string_view>

#include "text/nearest_word.h"
#include "validate/severity_name.h"

namespace cdprep::report {
namespace {

Error bad_argument(std::string message) {
    return {ErrorCode::bad_argument, std::move(message)};
}

std::string no_rule(const std::string& option, std::string_view word) {
    return option + " " + unknown_rule(word);
}

}  // namespace

std::string unknown_rule(std::string_view word) {
    std::vector<std::string> names;
    for (const mesh::RuleText& rule : mesh::all_rules()) {
        names.emplace_back(rule.name);
        names.push_back(mesh::id_of(rule.rule));
    }
    std::string text = "'";
    text += word;
    text += "' is not a rule. 'cdprep explain' lists all, by id and by name.";
    return text + suggestion(word, names);
}

Result<Done> RuleSettings::override_severity(const std::string& words) {
    const std::string_view text = words;
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) {
        return bad_argument("--rule '" + words +
                            "' has no '='. Write RULE=off, RULE=note, RULE=warn or RULE=error.");
    }
    const auto rule = mesh::find_rule(text.substr(0, equals));
    if (!rule) return bad_argument(no_rule("--rule:", text.substr(0, equals)));
    const auto severity = find_severity(text.substr(equals + 1));
    if (!severity) {
        return bad_argument("--rule '" + words + "': unknown severity '" +
                            std::string(text.substr(equals + 1)) +
                            "'. Choose from off, note, warn and error.");
    }
    severity_[*rule] = *severity;
    return Done{};
}

Result<Done> RuleSettings::add_fail_on(const std::string& word) {
    if (const auto severity = find_severity(word); severity && *severity != mesh::Severity::off) {
        const bool is_first = fail_on_ == mesh::Severity::off;
        fail_on_ = is_first ? *severity : std::min(fail_on_, *severity);
        return Done{};
    }
    const auto rule = mesh::find_rule(word);
    if (!rule) {
        return bad_argument("--fail-on '" + word +
                            "' is neither error, warning, note nor a rule. 'cdprep explain' "
                            "lists all rules, by id and by name.");
    }
    fail_on_rules_.insert(*rule);
    return Done{};
}

Result<RuleSettings> RuleSettings::parse(const std::vector<std::string>& rules,
                                         const std::vector<std::string>& fail_on) {
    RuleSettings settings;
    for (const std::string& words : rules) {
        if (const Result<Done> done = settings.override_severity(words); !done) return done.error();
    }
    if (!fail_on.empty()) settings.fail_on_ = mesh::Severity::off;
    for (const std::string& word : fail_on) {
        if (const Result<Done> done = settings.add_fail_on(word); !done) return done.error();
    }
    for (const mesh::Rule rule : settings.fail_on_rules_) {
        if (settings.severity(rule) != mesh::Severity::off) continue;
        return bad_argument("--fail-on " + mesh::id_of(rule) + " names a rule that --rule " +
                            mesh::id_of(rule) + "=off turns off. Remove one of the two options.");
    }
    return settings;
}

mesh::Severity RuleSettings::severity(mesh::Rule rule) const {
    const auto at = severity_.find(rule);
    return at == severity_.end() ? mesh::text_of(rule).severity : at->second;
}

bool RuleSettings::fails(mesh::Rule rule) const {
    const mesh::Severity found = severity(rule);
    if (found == mesh::Severity::off) return false;
    const bool is_severe = fail_on_ != mesh::Severity::off && found >= fail_on_;
    return is_severe || fail_on_rules_.contains(rule);
}

}  // namespace cdprep::report
