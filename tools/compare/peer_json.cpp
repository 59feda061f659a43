// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/peers.h"

#include <nlohmann/json.hpp>
#include <string>

namespace cdprep::report {
namespace {

using json = nlohmann::ordered_json;

study::PeerAnswers answers_of(const json& peer) {
    study::PeerAnswers answers;
    answers.key = peer.at("key").get<std::string>();
    answers.name = peer.at("name").get<std::string>();
    answers.note = peer.at("note").get<std::string>();
    for (std::size_t a = 0; a < study::kAsked; ++a) {
        const char* const name = study::kAskedNames[a];
        answers.reasons[a] = peer.at("reasons").value(name, "");
        if (!peer.contains(name)) {
            if (answers.reasons[a].empty()) answers.reasons[a] = "it returned no answer";
            continue;
        }
        answers.asked[a].seconds =
            peer.at(name).at("seconds").get<std::vector<std::vector<double>>>();
        answers.asked[a].answers = peer.at(name).at("answers").get<std::vector<std::size_t>>();
    }
    return answers;
}

study::PeerBuild build_of(const json& build) {
    return {.key = build.at("key").get<std::string>(),
            .name = build.at("name").get<std::string>(),
            .note = build.at("note").get<std::string>(),
            .seconds = build.at("seconds").get<std::vector<double>>(),
            .vertices = build.at("vertices").get<std::size_t>(),
            .facets = build.at("facets").get<std::size_t>()};
}

}  // namespace

Result<study::PeerRun> read_peers(std::string_view text) {
    try {
        const json read = json::parse(text);
        study::PeerRun run;
        if (read.contains("builds")) {
            for (const json& build : read["builds"]) run.builds.push_back(build_of(build));
        } else {
            for (const json& peer : read.at("peers")) run.peers.push_back(answers_of(peer));
        }
        for (const json& peer : read.at("absent")) {
            run.absent.push_back({peer.at("key").get<std::string>(),
                                  peer.at("name").get<std::string>(),
                                  peer.at("reason").get<std::string>()});
        }
        return run;
    } catch (const json::exception& error) {
        return Error{ErrorCode::unreadable,
                     std::string("its output is not the expected JSON: ") + error.what()};
    }
}

}  // namespace cdprep::report
