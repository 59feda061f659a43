// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/peer_tables.h"

#include <algorithm>
#include <array>
#include <utility>

#include "compare/pair_tables.h"
#include "study/cells.h"

namespace cdprep::study {
namespace {

/// A library, as columns name it.
struct Library {
    const char* key;
    const char* title;
};
constexpr std::array<Library, 8> kLibraries = {{{"fcl", "FCL"},
                                                {"ode", "ODE"},
                                                {"bullet", "Bullet"},
                                                {"cgal", "CGAL"},
                                                {"embree", "Embree"},
                                                {"pqp", "PQP"},
                                                {"swift", "SWIFT++"},
                                                {"qhull", "qhull"}}};

/// A structure that a library builds.
struct PeerStructure {
    const char* key;      ///< of PeerBuild
    const char* library;  ///< in kLibraries
    const char* title;
};
constexpr std::array<PeerStructure, 9> kPeerStructures = {{{"qhull", "qhull", "qhull, hull"},
                                                           {"fcl_swept", "fcl", "FCL, swept"},
                                                           {"fcl", "fcl", "FCL, oriented"},
                                                           {"ode", "ode", "ODE"},
                                                           {"bullet", "bullet", "Bullet"},
                                                           {"cgal", "cgal", "CGAL"},
                                                           {"embree", "embree", "Embree"},
                                                           {"pqp", "pqp", "PQP"},
                                                           {"swift", "swift", "SWIFT++"}}};

/// The queries about two meshes that a library answers.
struct Answering {
    const char* library;
    bool has_overlap;
};
constexpr std::array<Answering, 7> kAnswering = {{{"fcl", true},
                                                  {"ode", false},
                                                  {"bullet", true},
                                                  {"cgal", false},
                                                  {"embree", true},
                                                  {"pqp", true},
                                                  {"swift", false}}};

const char* title_of(const std::string& library) {
    return std::ranges::find(kLibraries, library,
                             [](const Library& l) { return std::string(l.key); })
        ->title;
}

std::string reason_of(const PeerReasons& reasons, const std::string& library) {
    const auto at = reasons.find(library);
    return at == reasons.end() ? "the peer program does not support it" : at->second;
}

const PeerBuild* find_build(const PeerRun* run, const std::string& key) {
    if (run == nullptr) return nullptr;
    const auto at = std::ranges::find(run->builds, key, &PeerBuild::key);
    return at == run->builds.end() ? nullptr : &*at;
}

Cell build_cell(const PeerBuild& build) {
    if (build.seconds.empty()) return without("it built no structure");
    return seconds_cell(timing_of({.seconds = {build.seconds}, .times = {1}}));
}

}  // namespace

PeerReasons all_absent(const std::string& reason) {
    PeerReasons reasons;
    for (const Library& library : kLibraries) reasons[library.key] = reason;
    return reasons;
}

Table peer_build_table(const std::vector<StudyMesh>& meshes, const std::vector<PeerRun>& runs,
                       const PeerReasons& reasons) {
    Table table = {"3.peers",
                   "Pre-processing time of other libraries",
                   "model",
                   {},
                   {},
                   {"One thread, in a separate program. FCL is derived from PQP, and uses its "
                    "swept rectangles.",
                    "qhull: a triangulated hull in floating point; ours is exact (Table 3)."}};
    for (const PeerStructure& structure : kPeerStructures) {
        table.columns.push_back(
            {std::string(structure.key) + "_s", structure.title, Unit::seconds});
    }
    table.columns.push_back({"qhull_vertices", "qhull, vertices", Unit::count});
    table.columns.push_back({"qhull_facets", "facets", Unit::count});
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const PeerRun* const run = runs.empty() ? nullptr : &runs[i];
        Row row{meshes[i].name, {}};
        for (const PeerStructure& structure : kPeerStructures) {
            const PeerBuild* const build = find_build(run, structure.key);
            row.cells.push_back(build != nullptr ? build_cell(*build)
                                                 : without(reason_of(reasons, structure.library)));
        }
        const PeerBuild* const hull = find_build(run, "qhull");
        for (const auto member : {&PeerBuild::vertices, &PeerBuild::facets}) {
            row.cells.push_back(hull != nullptr ? count_cell(hull->*member)
                                                : without(reason_of(reasons, "qhull")));
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

Table peer_pair_table(const std::vector<StudyMesh>& meshes, const std::vector<PairStudy>& studies,
                      const PeerReasons& reasons) {
    Table table = {"4.peers",
                   "Collision detection (CD) and overlapping triangles (OT) by other libraries, "
                   "median over the deep poses",
                   "pair",
                   {},
                   {},
                   {"The table of each pair has all strata, and the share of correct answers."}};
    const auto add_column = [&](const std::string& key, const std::string& title) {
        table.columns.push_back({key, title, Unit::seconds});
    };
    add_column("bvh_collide", "exact BVH CD");
    add_column("bvh_overlap", "exact BVH OT");
    for (const Answering& answering : kAnswering) {
        const std::string key = answering.library;
        add_column(key + "_collide", title_of(key) + std::string(" CD"));
        if (answering.has_overlap) add_column(key + "_overlap", title_of(key) + std::string(" OT"));
    }
    for (const PairStudy& study : studies) {
        Row row{meshes[study.a].name + " x " + meshes[study.b].name, {}};
        const auto add_cells = [&](const auto& is_it, const std::string& library, bool overlaps) {
            const auto at = std::ranges::find_if(study.contenders, is_it);
            for (const Asked asked : {Asked::collide, Asked::overlap}) {
                if (asked == Asked::overlap && !overlaps) continue;
                row.cells.push_back(at == study.contenders.end()
                                        ? without(reason_of(reasons, library))
                                        : deep_cell(study, *at, asked));
            }
        };
        add_cells([](const Contender& one) { return one.name == "exact BVH"; }, "", true);
        for (const Answering& answering : kAnswering) {
            add_cells(
                [&](const Contender& one) { return one.is_peer && one.peer == answering.library; },
                answering.library, answering.has_overlap);
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

}  // namespace cdprep::study
