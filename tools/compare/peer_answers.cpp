// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/peer_answers.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace cdprep::study {
namespace {

/// The queries to peers, by the letters of their program.
constexpr std::array<std::pair<Asked, char>, 4> kLetters = {
    {{Asked::collide, 'c'}, {Asked::overlap, 'o'}, {Asked::distance, 'd'}, {Asked::within, 'w'}}};

void append_number(std::string& line, double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), " %.17g", value);
    line += text.data();
}

}  // namespace

std::string peer_questions(const PoseSet& poses) {
    std::string text;
    for (const StudyPose& pose : poses.poses) {
        std::string letters;
        for (const auto& [asked, letter] : kLetters) {
            if (std::ranges::find(strata_of(asked), pose.stratum) != strata_of(asked).end()) {
                letters += letter;
            }
        }
        text += letters;
        for (const double value : pose.a_from_b.rotation()) append_number(text, value);
        const format::Double3& t = pose.a_from_b.translation();
        for (const double value : {t.x, t.y, t.z}) append_number(text, value);
        text += '\n';
    }
    return text;
}

std::string add_peer(const PeerAnswers& answers, PairStudy& study) {
    Contender contender;
    contender.name = answers.name;
    contender.peer = answers.key;
    contender.is_peer = true;
    contender.reasons = answers.reasons;
    contender.reasons[static_cast<std::size_t>(Asked::contacts)] = "not measured for peers";
    for (const auto& [asked, letter] : kLetters) {
        const auto a = static_cast<std::size_t>(asked);
        if (!contender.reasons[a].empty()) continue;
        const std::vector<std::size_t> cases = cases_of(asked, study.poses);
        const PeerAnswered& answered = answers.asked[a];
        if (answered.seconds.size() != cases.size() || answered.answers.size() != cases.size()) {
            return answers.name + " gave " + std::to_string(answered.answers.size()) +
                   " answers to " + kAskedNames[a] + " for " + std::to_string(cases.size()) +
                   " poses.";
        }
        for (std::size_t i = 0; i < cases.size(); ++i) {
            contender.timings[a].seconds.push_back(answered.seconds[i]);
            contender.timings[a].times.push_back(1);
            const std::size_t answer = answered.answers[i];
            const std::size_t exact = study.exact.pairs[cases[i]];
            if (asked == Asked::collide) {
                ++contender.answers;
                if ((answer > 0) == study.exact.hits[cases[i]]) ++contender.agreeing;
            }
            if (asked == Asked::overlap) {
                ++contender.answers;
                if (answer == exact) ++contender.agreeing;
                contender.found += answer;
                contender.pairs += exact;
            }
        }
    }
    study.contenders.push_back(std::move(contender));
    return "";
}

}  // namespace cdprep::study
