// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/pair_tables.h"

#include <algorithm>
#include <string>
#include <utility>

#include "study/cells.h"

namespace cdprep::study {
namespace {

std::string name_of(const std::vector<StudyMesh>& meshes, const PairStudy& study) {
    return meshes[study.a].name + " x " + meshes[study.b].name;
}

const char* name_of(Stratum stratum) {
    return kStratumNames[static_cast<std::size_t>(stratum)];
}

/// Returns the time of a query in one stratum; nothing if it was not measured there.
std::optional<Timing> timing_in(const PairStudy& study, const Contender& contender, Asked asked,
                                Stratum stratum) {
    const Timings& timings = contender.timings[static_cast<std::size_t>(asked)];
    const std::vector<std::size_t> cases = cases_of(asked, study.poses);
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < cases.size() && i < timings.seconds.size(); ++i) {
        if (study.poses.poses[cases[i]].stratum == stratum && !timings.seconds[i].empty()) {
            chosen.push_back(i);
        }
    }
    if (chosen.empty()) return std::nullopt;
    return timing_of(timings, chosen);
}

Cell time_cell(const PairStudy& study, const Contender& contender, Asked asked, Stratum stratum) {
    const std::string& reason = contender.reasons[static_cast<std::size_t>(asked)];
    if (!reason.empty()) return without(reason);
    const auto timing = timing_in(study, contender, asked, stratum);
    if (!timing) return without(std::string("no pose is ") + name_of(stratum));
    return seconds_cell(*timing);
}

/// Returns the same with cold caches, over the deep poses.
Cell cold_cell(const Contender& contender, Asked asked) {
    const std::string& reason = contender.reasons[static_cast<std::size_t>(asked)];
    if (!reason.empty()) return without(reason);
    if (contender.is_peer) return without("peers are measured with warm caches only");
    const Timing timing = timing_of(contender.cold[static_cast<std::size_t>(asked)]);
    return timing.cases > 0 ? seconds_cell(timing) : without("no pose is deep");
}

const Contender* find_contender(const PairStudy& study, const std::string& title) {
    const auto at = std::ranges::find_if(
        study.contenders, [&](const Contender& contender) { return title_of(contender) == title; });
    return at == study.contenders.end() ? nullptr : &*at;
}

/// The row of Table 4 that matches a pair, and how closely.
struct PublishedRow {
    const PublishedPair* pair = nullptr;
    Likeness likeness;  ///< of the model that matches less
};

PublishedRow published_row(const std::vector<StudyMesh>& meshes, const PairStudy& study) {
    const Likeness& a = meshes[study.a].likeness;
    const Likeness& b = meshes[study.b].likeness;
    if (!a.version_of || !b.version_of) return {};
    const bool is_a_less = !a.model || (b.model && a.mark >= b.mark);
    return {find_published_pair(*a.version_of, *b.version_of), is_a_less ? a : b};
}

/// The published times of a strategy.
struct PublishedTimes {
    std::optional<Published> collide;
    std::optional<Published> overlap;
};

PublishedTimes published_times(const PublishedRow& row, const std::string& title) {
    if (row.pair == nullptr) return {};
    const PublishedPair& pair = *row.pair;
    if (title == "octree, paper") {
        return {beside(row.likeness, pair.octree_collide, pair.octree_erratum),
                beside(row.likeness, pair.octree_overlap, pair.octree_erratum)};
    }
    if (title == "tetra-tree, paper") {
        return {beside(row.likeness, pair.tetra_collide), beside(row.likeness, pair.tetra_overlap)};
    }
    if (title == "PQP-style BVH") {
        return {beside(row.likeness, pair.pqp_collide),
                beside(row.likeness, pair.pqp_overlap, pair.pqp_erratum)};
    }
    if (title == "SWIFT++-style pieces") {
        if (!row.likeness.model) return {beside(row.likeness, 0), std::nullopt};
        Published published;
        published.text = pair.has_swift ? "about 0" : "Not-2-Manifold";
        published.mark = row.likeness.mark;
        if (row.likeness.mark != Mark::none) published.remark = row.likeness.sentence;
        return {published, std::nullopt};
    }
    return {};
}

/// Returns why a pair has no published figures; empty if it has some.
std::string no_figures(const std::vector<StudyMesh>& meshes, const PairStudy& study) {
    if (published_row(meshes, study).pair != nullptr) return "";
    for (const std::size_t i : {study.a, study.b}) {
        if (!meshes[i].likeness.version_of) {
            return meshes[i].name + ": " + meshes[i].likeness.sentence;
        }
    }
    return "the comparative study does not have this pair";
}

void add_column(Table& table, const char* key, std::string title, Unit unit) {
    table.columns.push_back({key, std::move(title), unit});
}

/// Returns the mean number of overlapping pairs over the poses of a stratum.
double mean_pairs(const PairStudy& study, Stratum stratum) {
    double sum = 0;
    const std::vector<std::size_t> cases = study.poses.of(stratum);
    for (const std::size_t pose : cases) sum += static_cast<double>(study.exact.pairs[pose]);
    return cases.empty() ? 0 : sum / static_cast<double>(cases.size());
}

Cell agreement_cell(const Contender& contender) {
    if (contender.answers == 0) return without("no answers to compare");
    Cell cell =
        number(static_cast<double>(contender.agreeing) / static_cast<double>(contender.answers));
    cell.details = {{"equal", static_cast<double>(contender.agreeing)},
                    {"answers", static_cast<double>(contender.answers)}};
    return cell;
}

Cell found_cell(const Contender& contender) {
    const std::string& reason = contender.reasons[static_cast<std::size_t>(Asked::overlap)];
    if (!reason.empty()) return without(reason);
    if (contender.pairs == 0) return without("no pose has overlapping pairs");
    return number(static_cast<double>(contender.found) / static_cast<double>(contender.pairs));
}

Cell counted_cell(const Contender& contender, std::uint64_t QueryCounts::*member, Stratum stratum) {
    if (contender.is_peer) return without("peers report no counts");
    const std::string& reason = contender.reasons[static_cast<std::size_t>(Asked::collide)];
    if (!reason.empty()) return without(reason);
    return count_cell(contender.counts[0][static_cast<std::size_t>(stratum)].*member);
}

std::string kind_of_counts(const QueryCounts& counts) {
    return std::to_string(counts.box_pairs) + " pairs of boxes, " +
           std::to_string(counts.cell_pairs) + " of leaf cells, " +
           std::to_string(counts.leaf_pairs) + " of leaves and " +
           std::to_string(counts.triangle_pairs) + " of triangles";
}

/// Returns the work of both strategies where the published order does not hold, and an explanation.
/// `ratio` is the slower one's time divided by the faster one's.
std::string why_slower(const Contender& quick, const Contender& late, Asked asked, Stratum stratum,
                       double ratio) {
    const auto a = static_cast<std::size_t>(asked);
    const auto s = static_cast<std::size_t>(stratum);
    const QueryCounts& of_quick = quick.counts[a][s];
    const QueryCounts& of_late = late.counts[a][s];
    std::string text = ". Mean tests of a query: " + title_of(quick) + ", " +
                       kind_of_counts(of_quick) + "; " + title_of(late) + ", " +
                       kind_of_counts(of_late);
    if (quick.name != "tetra-tree" || late.name != "octree") {
        return text +
               ". Both use the same exact test of triangles here; the comparative study used "
               "Feito's test in cells";
    }
    if (of_quick.box_pairs == 0 || of_late.box_pairs == 0) return text;
    const double more =
        static_cast<double>(of_quick.box_pairs) / static_cast<double>(of_late.box_pairs);
    if (more > 2) {
        text +=
            ". Long truncated cones are loose bounds, so more of them are tested before the first "
            "hit";
    }
    constexpr double kDearer = 1.2;
    const double dearer = 1 / (ratio * more);
    if (dearer > kDearer) {
        text +=
            formatted(". A pair of cones takes %.1f times as long as a pair of boxes, ", dearer) +
            "including the tests that follow";
    }
    return text;
}

/// Checks that `fast` takes less time than `slow`, by at least the factor `times`.
Check order_of(const std::vector<StudyMesh>& meshes, const PairStudy& study, Asked asked,
               Stratum stratum, const char* fast, const char* slow, double times) {
    Check check;
    check.claim = name_of(meshes, study) + ", " + name_of(stratum) +
                  " poses: " + kAskedNames[static_cast<std::size_t>(asked)] + " by " + fast +
                  " is " + (times > 1 ? formatted("%.0f times ", times) : std::string()) +
                  "faster than by " + slow;
    const Contender* const quick = find_contender(study, fast);
    const Contender* const late = find_contender(study, slow);
    if (quick == nullptr || late == nullptr) return check;
    const auto quick_s = timing_in(study, *quick, asked, stratum);
    const auto late_s = timing_in(study, *late, asked, stratum);
    if (!quick_s || !late_s) {
        check.evidence = std::string("not measured: no pose is ") + name_of(stratum);
        return check;
    }
    const double ratio = late_s->median_s / quick_s->median_s;
    check.verdict = verdict_of(ratio > times);
    check.evidence = seconds_text(quick_s->median_s) + " against " +
                     seconds_text(late_s->median_s) + ", " + formatted("%.2f times", ratio);
    const auto theirs = [&](const char* title) {
        const PublishedTimes published = published_times(published_row(meshes, study), title);
        const auto& found = asked == Asked::collide ? published.collide : published.overlap;
        return found ? found->value : std::nullopt;
    };
    if (theirs(fast) && theirs(slow)) {
        check.evidence += formatted(" (published: %.2f)", *theirs(slow) / *theirs(fast));
    }
    if (check.verdict == Verdict::fails) {
        check.evidence += why_slower(*quick, *late, asked, stratum, ratio);
    }
    return check;
}

/// Checks that overlap takes at least as long as collide, whose work is a prefix of its work.
Check overlap_takes_longer(const std::vector<StudyMesh>& meshes, const PairStudy& study) {
    Check check;
    check.claim = name_of(meshes, study) + ": overlap takes at least as long as collide";
    check.verdict = Verdict::holds;
    for (const Contender& contender : study.contenders) {
        if (contender.is_peer) continue;
        for (const Stratum stratum : {Stratum::deep, Stratum::shallow}) {
            const auto collide = timing_in(study, contender, Asked::collide, stratum);
            const auto overlap = timing_in(study, contender, Asked::overlap, stratum);
            if (!collide || !overlap || overlap->median_s >= collide->median_s) continue;
            const double apart = collide->median_s - overlap->median_s;
            const bool is_noise = apart <= collide->spread_s + overlap->spread_s;
            if (!is_noise) check.verdict = Verdict::fails;
            check.evidence += (check.evidence.empty() ? "" : "; ") + title_of(contender) + ", " +
                              name_of(stratum) + ": " + seconds_text(collide->median_s) + " and " +
                              seconds_text(overlap->median_s) +
                              (is_noise ? ", within the spread" : "");
        }
    }
    if (check.evidence.empty()) check.evidence = "for every strategy, at deep and shallow poses";
    return check;
}

Check exact_agree(const std::vector<StudyMesh>& meshes, const PairStudy& study) {
    Check check;
    check.claim = name_of(meshes, study) + ": every exact strategy gives the exact answers";
    check.verdict = Verdict::holds;
    check.is_promise = true;
    std::size_t answers = 0;
    for (const Contender& contender : study.contenders) {
        if (contender.is_approximate || contender.is_peer) continue;
        answers += contender.answers;
        if (contender.agreeing == contender.answers) continue;
        check.verdict = Verdict::fails;
        check.evidence += title_of(contender) + ": " + std::to_string(contender.agreeing) + " of " +
                          std::to_string(contender.answers) + " answers; ";
    }
    check.evidence += std::to_string(answers) + " answers compared";
    return check;
}

/// Checks that the machine was quiet enough for the other results to be meaningful.
Check one_by_itself(const std::vector<StudyMesh>& meshes, const PairStudy& study) {
    const TimeRatio& itself = study.itself;
    return {
        name_of(meshes, study) + ": the exact BVH measured against itself takes 1 times as long",
        formatted("%.3f times", itself.ratio) + formatted(" (%.3f", itself.low) +
            formatted(" to %.3f)", itself.high) +
            (itself.holds_one() ? "" : ": the machine was too busy"),
        verdict_of(itself.holds_one())};
}

void add_detail_columns(Table& table) {
    for (std::size_t a = 0; a < kAsked; ++a) {
        for (const Stratum stratum : strata_of(static_cast<Asked>(a))) {
            const std::string key = std::string(kAskedNames[a]) + "_" + name_of(stratum);
            add_column(table, key.c_str(), std::string(kAskedNames[a]) + ", " + name_of(stratum),
                       Unit::seconds);
        }
    }
    add_column(table, "collide_deep_cold", "collide, deep, cold", Unit::seconds);
    add_column(table, "overlap_deep_cold", "overlap, deep, cold", Unit::seconds);
    add_column(table, "agreement", "correct answers", Unit::share);
    add_column(table, "found", "pairs found", Unit::share);
    add_column(table, "boxes_deep", "boxes tested, deep", Unit::count);
    add_column(table, "cells_deep", "cells met, deep", Unit::count);
    add_column(table, "leaves_deep", "leaves tested, deep", Unit::count);
}

Row detail_row(const PairStudy& study, const Contender& contender, const PublishedTimes& times) {
    Row row{title_of(contender) + (contender.is_approximate ? " (approximate)" : ""), {}};
    for (std::size_t a = 0; a < kAsked; ++a) {
        const auto asked = static_cast<Asked>(a);
        for (const Stratum stratum : strata_of(asked)) {
            Cell cell = time_cell(study, contender, asked, stratum);
            if (stratum == Stratum::deep && asked == Asked::collide) cell.published = times.collide;
            if (stratum == Stratum::deep && asked == Asked::overlap) cell.published = times.overlap;
            row.cells.push_back(std::move(cell));
        }
    }
    row.cells.push_back(cold_cell(contender, Asked::collide));
    row.cells.push_back(cold_cell(contender, Asked::overlap));
    row.cells.push_back(agreement_cell(contender));
    row.cells.push_back(found_cell(contender));
    row.cells.push_back(counted_cell(contender, &QueryCounts::box_pairs, Stratum::deep));
    row.cells.push_back(counted_cell(contender, &QueryCounts::cell_pairs, Stratum::deep));
    row.cells.push_back(counted_cell(contender, &QueryCounts::leaf_pairs, Stratum::deep));
    return row;
}

std::string poses_note(const PairStudy& study) {
    std::string poses = study.poses.source.empty()
                            ? "Poses, seed " + std::to_string(study.poses.seed) + ":"
                            : "Poses of " + study.poses.source + ":";
    for (std::size_t s = 0; s < kStrata; ++s) {
        const auto stratum = static_cast<Stratum>(s);
        poses += std::string(s == 0 ? " " : ", ") + std::to_string(study.poses.of(stratum).size()) +
                 " " + name_of(stratum);
        if (study.poses.missing[s] > 0) {
            poses += " (" + std::to_string(study.poses.missing[s]) + " not found)";
        }
        if (stratum == Stratum::deep || stratum == Stratum::shallow) {
            poses += formatted(" (%.0f overlapping pairs on average)", mean_pairs(study, stratum));
        }
    }
    return poses + ".";
}

}  // namespace

Cell deep_cell(const PairStudy& study, const Contender& contender, Asked asked) {
    return time_cell(study, contender, asked, Stratum::deep);
}

Table pair_table(const std::vector<StudyMesh>& meshes, const std::vector<PairStudy>& studies) {
    struct Printed {
        const char* key;
        const char* title;
        const char* contender;
        Asked asked;
    };
    constexpr std::array<Printed, 9> kPrinted = {{
        {"octree_collide", "octree CD", "octree, paper", Asked::collide},
        {"octree_overlap", "octree OT", "octree, paper", Asked::overlap},
        {"tetra_tree_collide", "tetra-tree CD", "tetra-tree, paper", Asked::collide},
        {"tetra_tree_overlap", "tetra-tree OT", "tetra-tree, paper", Asked::overlap},
        {"pqp_style_collide", "PQP-style CD", "PQP-style BVH", Asked::collide},
        {"pqp_style_overlap", "PQP-style OT", "PQP-style BVH", Asked::overlap},
        {"pieces_collide", "pieces CD", "SWIFT++-style pieces", Asked::collide},
        {"bvh_collide", "exact BVH CD", "exact BVH", Asked::collide},
        {"bvh_overlap", "exact BVH OT", "exact BVH", Asked::overlap},
    }};
    Table table = {"4",
                   "Collision detection (CD) and overlapping triangles (OT), median over the deep "
                   "poses, 512 leaf cells",
                   "pair",
                   {},
                   {},
                   {"The comparative study does not state its poses. So compare the order of its "
                    "figures with the order of ours, not the values.",
                    "PQP-style: this library's hierarchy of eight children with PQP's volumes, "
                    "not PQP's binary tree."}};
    for (const Printed& printed : kPrinted) {
        add_column(table, printed.key, printed.title, Unit::seconds);
    }
    for (const PairStudy& study : studies) {
        const PublishedRow published = published_row(meshes, study);
        Row row{name_of(meshes, study), {}};
        for (const Printed& printed : kPrinted) {
            const Contender& contender = *find_contender(study, printed.contender);
            Cell cell = deep_cell(study, contender, printed.asked);
            const PublishedTimes times = published_times(published, printed.contender);
            cell.published = printed.asked == Asked::collide ? times.collide : times.overlap;
            row.cells.push_back(std::move(cell));
        }
        table.rows.push_back(std::move(row));
        const std::string reason = no_figures(meshes, study);
        if (!reason.empty()) {
            table.notes.push_back(name_of(meshes, study) + " has no published figures: " + reason +
                                  ".");
        }
    }
    return table;
}

Table pair_details(const std::vector<StudyMesh>& meshes, const PairStudy& study) {
    Table table = {"4." + meshes[study.a].name + "-" + meshes[study.b].name,
                   name_of(meshes, study) + ": time of each strategy, median over the poses",
                   "strategy",
                   {},
                   {},
                   {}};
    add_detail_columns(table);
    const PublishedRow published = published_row(meshes, study);
    for (const Contender& contender : study.contenders) {
        table.rows.push_back(
            detail_row(study, contender, published_times(published, title_of(contender))));
    }
    table.notes.push_back(poses_note(study));
    table.notes.emplace_back(
        "Cold: all structures that the query reads, of both models, were dropped from the caches "
        "before each query.");
    const std::string reason = no_figures(meshes, study);
    if (!reason.empty()) table.notes.push_back("No published figures: " + reason + ".");
    return table;
}

std::vector<Check> pair_checks(const std::vector<StudyMesh>& meshes,
                               const std::vector<PairStudy>& studies) {
    std::vector<Check> checks;
    for (const PairStudy& study : studies) {
        checks.push_back(exact_agree(meshes, study));
        checks.push_back(one_by_itself(meshes, study));
        checks.push_back(overlap_takes_longer(meshes, study));
        for (const Stratum stratum : {Stratum::shallow, Stratum::deep}) {
            for (const char* setting : {"paper", "tuned"}) {
                const std::string tetra = std::string("tetra-tree, ") + setting;
                const std::string octree = std::string("octree, ") + setting;
                checks.push_back(order_of(meshes, study, Asked::collide, stratum, tetra.c_str(),
                                          octree.c_str(), 1));
            }
        }
        constexpr double kTimes = 10;
        for (const char* fast : {"PQP-style BVH", "exact BVH"}) {
            for (const char* slow : {"octree, paper", "tetra-tree, paper"}) {
                for (const Asked asked : {Asked::collide, Asked::overlap}) {
                    checks.push_back(
                        order_of(meshes, study, asked, Stratum::deep, fast, slow, kTimes));
                }
            }
        }
    }
    return checks;
}

}  // namespace cdprep::study
