// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <nlohmann/json.hpp>

#include "accuracy/accuracy_report.h"
#include "page/page_parts.h"
#include "text/json_layout.h"

namespace cdprep::report {
namespace {

using Json = nlohmann::ordered_json;
using study::Ladder;
using study::Rung;
using study::StudyPose;

const char* answer_name(Answer answer) {
    if (answer == Answer::unknown) return "unknown";
    return answer == Answer::yes ? "yes" : "no";
}

Json share_json(const study::ShareInterval& share) {
    return {{"count", share.count}, {"of", share.of}, {"low", share.low}, {"high", share.high}};
}

Json band_json(const study::ShareBand& band) {
    return {{"value", band.share}, {"low", band.low}, {"high", band.high}};
}

Json timing_json(const study::Timing& timing) {
    return {{"median_s", timing.median_s}, {"p95_s", timing.p95_s},   {"p999_s", timing.p999_s},
            {"spread_s", timing.spread_s}, {"low_s", timing.low_s},   {"high_s", timing.high_s},
            {"cases", timing.cases},       {"rounds", timing.rounds}, {"asked", timing.asked}};
}

Json strata_json(const Rung& rung) {
    Json strata = Json::object();
    for (std::size_t s = 0; s < study::kStrata; ++s) {
        const study::StratumErrors& stratum = rung.strata[s];
        Json json = {{"median_s", stratum.median_s}};
        if (!rung.answers.empty()) {
            json["misses"] = share_json(stratum.misses);
            json["false_hits"] = share_json(stratum.false_hits);
            json["unknown"] = stratum.unknown;
        }
        strata[study::kStratumNames[s]] = std::move(json);
    }
    return strata;
}

void add_errors(const Rung& rung, Json& json) {
    if (rung.pairs) {
        json["pairs"] = {{"wanted", rung.pairs->all.wanted},
                         {"found", rung.pairs->all.found},
                         {"both", rung.pairs->all.both},
                         {"recall", band_json(rung.pairs->recall)},
                         {"precision", band_json(rung.pairs->precision)},
                         {"wrong", band_json(rung.pairs->wrong)}};
    }
    if (rung.distance) {
        json["distance"] = {{"median_error", rung.distance->median},
                            {"worst_error", rung.distance->worst},
                            {"worst_error_of_diagonal", rung.distance->worst_of_diagonal},
                            {"interval_holds", share_json(rung.distance->holds)}};
    }
    if (rung.rigid) {
        json["rigid"] = {{"misses", share_json(rung.rigid->misses)},
                         {"false_hits", share_json(rung.rigid->false_hits)},
                         {"undecided", rung.rigid->undecided}};
    }
    if (rung.outer) json["outer"] = *rung.outer;
    if (rung.inner) json["inner"] = *rung.inner;
    if (rung.displacement) json["displacement"] = *rung.displacement;
    if (rung.degenerate) json["degenerate"] = *rung.degenerate;
    if (rung.worst_pose) json["worst"] = {{"pose", *rung.worst_pose}, {"what", rung.worst}};
}

Json rung_json(const Rung& rung, bool is_dominated, bool has_strata) {
    Json json = {{"name", rung.name},
                 {"how", rung.how},
                 {"promise", promise_name(rung.promise)},
                 {"time", timing_json(rung.time)}};
    if (rung.error) {
        json["error"] = band_json({*rung.error, rung.error_low, rung.error_high});
    }
    json["dominated"] = is_dominated;
    if (rung.build_s) json["build_s"] = *rung.build_s;
    if (rung.bytes) json["bytes"] = *rung.bytes;
    if (rung.touched) json["touched_bytes"] = *rung.touched;
    add_errors(rung, json);
    if (has_strata) json["strata"] = strata_json(rung);
    json["seconds"] = rung.seconds;
    if (!rung.answers.empty()) {
        Json answers = Json::array();
        for (const Answer answer : rung.answers) answers.push_back(answer_name(answer));
        json["answers"] = std::move(answers);
    }
    if (!rung.pair_counts.empty()) {
        Json counts = Json::array();
        for (const study::PairCounts& pose : rung.pair_counts) {
            counts.push_back({pose.wanted, pose.found, pose.both});
        }
        json["pairs_by_pose"] = std::move(counts);
    }
    return json;
}

Json ladder_json(const Ladder& ladder) {
    Json rungs = Json::array();
    const std::vector<bool> beaten = study::dominated(ladder.rungs);
    const bool has_strata = ladder.cases.starts_with("pose");
    for (std::size_t i = 0; i < ladder.rungs.size(); ++i) {
        rungs.push_back(rung_json(ladder.rungs[i], beaten[i], has_strata));
    }
    Json steps = Json::array();
    for (const NextDigit& step : next_digits(ladder)) {
        Json json = {{"from", ladder.rungs[step.from].name},
                     {"to", ladder.rungs[step.to].name},
                     {"time", step.time}};
        if (std::isfinite(step.error)) json["error"] = step.error;
        if (!std::isnan(step.time_a_digit)) json["time_a_digit"] = step.time_a_digit;
        steps.push_back(std::move(json));
    }
    return {{"name", ladder.name},        {"question", ladder.question},
            {"error", ladder.error},      {"cases", ladder.cases},
            {"rungs", std::move(rungs)},  {"next_digit", std::move(steps)},
            {"left_out", ladder.left_out}};
}

Json pose_json(const StudyPose& pose) {
    const auto& r = pose.a_from_b.rotation();
    const auto& t = pose.a_from_b.translation();
    Json rows = Json::array();
    for (const double value : r) rows.push_back(value);
    for (const double value : {t.x, t.y, t.z}) rows.push_back(value);
    return {{"stratum", study::kStratumNames[static_cast<std::size_t>(pose.stratum)]},
            {"hit", pose.hit},
            {"solid", answer_name(pose.solid)},
            {"gap", {pose.gap_lower, pose.gap_upper}},
            {"depth", pose.depth},
            {"rigid", pose.is_rigid},
            {"quaternion", pose.quaternion},
            {"pose", std::move(rows)}};
}

Json model_json(const std::string& input, const study::StudiedModel& model) {
    return {{"input", input},
            {"triangles", model.triangles},
            {"vertices", model.vertices},
            {"diagonal", model.diagonal},
            {"balanced", model.is_balanced},
            {"single_precision", model.single_precision}};
}

Json study_json(const AccuracyReport& report) {
    const study::AccuracyStudy& study = report.study;
    Json json = {{"study", "accuracy"}, {"version", report.version}, {"exit", report.exit}};
    if (report.error) {
        json["a"] = {{"input", report.input}};
        json["b"] = {{"input", report.input_b}};
        json["error"] = *report.error;
        return json;
    }
    json["quick"] = study.is_quick;
    json["seconds"] = study.seconds;
    json["machine"] = study::machine_json<Json>(study.machine);
    json["timing"] = {{"threads", 1},
                      {"clock", "processor time of the thread"},
                      {"rounds", study.timing.rounds},
                      {"least_sample_s", study.timing.least_sample_s}};
    json["self_check"] = {{"ratio", study.self.ratio},
                          {"low", study.self.low},
                          {"high", study.self.high},
                          {"holds", study.self.holds_one()}};
    json["a"] = model_json(report.input, study.a);
    json["b"] = model_json(report.input_b, study.b);
    json["seed"] = study.set.seed;
    json["diagonal"] = study.set.diagonal;
    json["rigid"] = study.rigid;
    Json missing = Json::object();
    for (std::size_t s = 0; s < study::kStrata; ++s) {
        missing[study::kStratumNames[s]] = study.set.missing[s];
    }
    json["missing_poses"] = std::move(missing);
    json["broken"] = study.broken;
    json["ladders"] = Json::array();
    for (const Ladder& ladder : study.ladders) json["ladders"].push_back(ladder_json(ladder));
    json["poses"] = Json::array();
    for (const StudyPose& pose : study.set.poses) json["poses"].push_back(pose_json(pose));
    return json;
}

}  // namespace

std::string accuracy_json(const AccuracyReport& report) {
    return laid_out(study_json(report), 0) + "\n";
}

std::string accuracy_page_data(const AccuracyReport& report) {
    Json json = study_json(report);
    for (Json& ladder : json["ladders"]) {
        for (Json& rung : ladder["rungs"]) {
            rung.erase("seconds");
            rung.erase("answers");
            rung.erase("pairs_by_pose");
        }
    }
    return script_json(compact(json));
}

}  // namespace cdprep::report
