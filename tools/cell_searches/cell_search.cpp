// SPDX-License-Identifier: GPL-3.0-or-later
#include "cell_searches/cell_search.h"

#include <algorithm>
#include <array>
#include <string>

#include "cell_searches/cell_searches.h"
#include "study/cells.h"

namespace cdprep::study {
namespace {

constexpr std::uint32_t kThreshold = 8;
constexpr double kClaim = 0.8;
constexpr double kNanosecond = 1e-9;
constexpr std::array<const char*, 9> kKeys = {"H0", "H1", "H2", "H3", "K0", "K1", "K2", "L1", "L2"};

/// Returns the time of each contender for the set, in seconds per search.
Row timed_row(const std::string& label, const std::vector<search::Contender>& contenders,
              const search::QuerySet& set, search::State state, std::size_t rounds) {
    Row row{label, {}};
    const search::Found found = search::compare_leaves(contenders, set.points);
    const auto ns = search::time_all(contenders, set.points, state, rounds);
    for (const std::vector<double>& taken : ns) {
        Cell cell = found.other.empty() ? number(quantile(taken, 0.5) * kNanosecond)
                                        : without(found.other + " finds different leaves");
        if (cell.is_filled()) {
            const double spread = quantile(taken, 0.75) - quantile(taken, 0.25);
            cell.details = {{"spread", spread * kNanosecond},
                            {"tenth", quantile(taken, 0.1) * kNanosecond},
                            {"rounds", static_cast<double>(rounds)},
                            {"cases", static_cast<double>(taken.size())}};
        }
        row.cells.push_back(std::move(cell));
    }
    return row;
}

/// The largest share of a baseline's time that a hashed search saves, and where.
struct Saving {
    double most = -1;
    std::string where;
    std::size_t reached = 0;
    std::size_t cases = 0;
    std::size_t slower = 0;
};

Saving saving_against(const Table& table, std::size_t baseline) {
    Saving saving;
    for (const Row& row : table.rows) {
        for (const std::size_t hashed : {4U, 5U, 6U}) {  // K0, K1, K2
            const auto& theirs = row.cells[baseline].value;
            const auto& ours = row.cells[hashed].value;
            if (!theirs || !ours) continue;
            const double saved = 1 - *ours / *theirs;
            ++saving.cases;
            if (saved >= kClaim) ++saving.reached;
            if (saved < 0) ++saving.slower;
            if (saved <= saving.most) continue;
            saving.most = saved;
            saving.where = std::string(kKeys[hashed]) + ", " + row.label;
        }
    }
    return saving;
}

}  // namespace

Table cell_search_table(std::span<const StudyMesh> meshes, const CellSearchOptions& options) {
    Table table = {
        "talk.search",
        "Time to find the leaf cell of a point, starting from its coordinates",
        "model, depth, points, caches",
        {},
        {},
        {"H0 descends recursively and tests the boxes of the children. H1 compares with centres. "
         "H2 follows the bits of the point's key with pointers, H3 without pointers. K0 looks up "
         "the key in Ponce Atencio's chained table by its last bits, from the deepest level up. K1 "
         "uses mixed keys. K2 bisects the levels. L1 bisects the sorted leaves; L2 does so too, "
         "starting from a table of the top levels.",
         "All searches use the same leaves: cells of fewer than 8 triangles are not divided. The "
         "points are uniform in the root cell, on the surface, or along a walk on the surface."}};
    for (const char* key : kKeys) table.columns.push_back({key, key, Unit::seconds});
    for (const StudyMesh& mesh : meshes) {
        for (const std::uint32_t depth : options.depths) {
            if (options.stop && options.stop()) return table;
            const search::Forms forms(
                build::build_octree(mesh.mesh.positions, mesh.mesh.triangles,
                                    {.level = depth, .threshold = kThreshold}));
            const std::vector<search::Contender> contenders = search::search_contenders(forms);
            search::Random random(7);
            for (const search::QuerySet& set :
                 {search::uniform_set(forms.octree.grid, options.points, random),
                  search::surface_set(mesh.mesh, options.points, random),
                  search::walk_set(mesh.mesh, options.points, random)}) {
                for (const search::State state : {search::warm, search::cold}) {
                    table.rows.push_back(timed_row(mesh.name + ", " + std::to_string(depth) + ", " +
                                                       set.name + ", " + search::kStates[state],
                                                   contenders, set, state, options.rounds));
                }
            }
        }
    }
    return table;
}

std::vector<Check> cell_search_checks(const Table& table) {
    constexpr std::array<const char*, 4> kMeanings = {
        "recursion that tests boxes (H0)", "descent by comparing with centres (H1)",
        "descent by the bits of one key (H2)", "descent by the bits without pointers (H3)"};
    std::vector<Check> checks;
    for (std::size_t baseline = 0; baseline < kMeanings.size(); ++baseline) {
        const Saving saving = saving_against(table, baseline);
        Check check;
        check.claim = std::string(
                          "Ponce Atencio's hashed octree reduces the time of a query by up to 80 "
                          "%: against ") +
                      kMeanings[baseline];
        if (saving.cases > 0) {
            check.verdict = verdict_of(saving.reached > 0);
            check.evidence = "reached in " + std::to_string(saving.reached) + " of " +
                             std::to_string(saving.cases) + " cases; hashing saves " +
                             (saving.most > 0 ? formatted("at most %.0f %%", 100 * saving.most)
                                              : std::string("nothing")) +
                             " (" + saving.where + "), and is slower in " +
                             std::to_string(saving.slower) + " cases";
        }
        checks.push_back(std::move(check));
    }
    return checks;
}

}  // namespace cdprep::study
