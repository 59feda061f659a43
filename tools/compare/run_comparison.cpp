// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/run_comparison.h"

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "cell_searches/cell_search.h"
#include "cell_searches/spatial_tables.h"
#include "cli/load_mesh.h"
#include "cli/signals.h"
#include "compare/feature_probes.h"
#include "compare/pair_poses.h"
#include "compare/pair_tables.h"
#include "compare/peer_tables.h"
#include "compare/peers.h"
#include "compare/preparation.h"
#include "compare/pruning.h"
#include "study/cells.h"
#include "study/published.h"

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPoses = 20;
constexpr std::size_t kQuickPoses = 3;
constexpr std::size_t kRounds = 5;
constexpr std::size_t kQuickRounds = 1;
/// Seconds for each query to a pair. Rounds after the first that would start later are left out.
constexpr double kBudget = 10;
constexpr double kQuickBudget = 0.2;

/// The indices of two models, and the poses that a file has for them.
struct Pair {
    std::size_t a;
    std::size_t b;
    fs::path pose_file{};
    std::vector<study::GivenPose> given{};
};

class Comparing {
public:
    Comparing(const ComparisonOptions& options, const Threads& threads, ProgressStyle style,
              std::size_t models)
        : options_(options), threads_(threads), style_(style) {
        progress_.emplace(style, models);
        if (options_.peers.empty()) {
            not_asked_ =
                study::all_absent("peers were not measured: give a peer program with --peers");
        }
    }

    Result<study::Comparison> run(const std::vector<fs::path>& files) {
        if (const auto error = read(files)) return *error;
        const TableChoice& tables = options_.tables;
        if (tables.pairs || tables.talk) pairs_ = choose_pairs();
        if (options_.quick && options_.pairs == PairChoice::fitting) leave_out_pairs();
        if (const auto error = read_poses()) return *error;
        describe();
        done_ = 0;
        progress_.emplace(style_, count_steps());
        if (tables.features) {
            if (const auto error = probe_features()) return *error;
        }
        if (tables.spatial) compare_builds();
        if (tables.preparation || tables.pairs || tables.talk) {
            if (const auto error = make_forms()) return *error;
        }
        if (tables.preparation) {
            if (const auto error = compare_preparation()) return *error;
        }
        if (tables.pairs || tables.talk) {
            if (const auto error = compare_pairs()) return *error;
        }
        if (options_.peers.empty()) {
            comparison_.peers.emplace_back(
                "Peers (FCL, ODE, Bullet, CGAL, Embree, qhull; PQP and SWIFT++ have no package) "
                "were not measured: give a peer program with --peers.");
        }
        if (is_interrupted()) return interrupted(files.front());
        for (const char* erratum : study::published_errata()) {
            comparison_.errata.emplace_back(erratum);
        }
        return std::move(comparison_);
    }

private:
    std::optional<Error> read(const std::vector<fs::path>& files) {
        std::map<std::string, std::size_t> taken;
        for (const fs::path& file : files) {
            step(file.filename().string() + ": read");
            LoadOptions load;
            load.import = options_.import;
            load.import.parallel_for = threads_.parallel_for();
            Result<mesh::TriangleSoup> soup = load_soup(file, load);
            if (!soup) return soup.error();
            if (is_interrupted()) return interrupted(file);
            if (soup.value().triangles.empty()) {
                return Error{ErrorCode::unreadable,
                             file.string() + ": has no triangles; there is nothing to compare."};
            }
            std::string name = file.stem().string();
            if (const std::size_t before = taken[name]++; before > 0) {
                name += " (" + std::to_string(before + 1) + ")";
            }
            meshes_.push_back(
                study::make_study_mesh(std::move(name), file, std::move(soup).value()));
        }
        return std::nullopt;
    }

    /// Reads the poses of each pair that the folder has.
    std::optional<Error> read_poses() {
        if (options_.poses.empty()) return std::nullopt;
        for (Pair& pair : pairs_) {
            pair.pose_file = pose_path(options_.poses, meshes_[pair.a].name, meshes_[pair.b].name);
            Result<std::vector<study::GivenPose>> given = read_pair_poses(pair.pose_file);
            if (!given) return given.error();
            pair.given = std::move(given).value();
        }
        return std::nullopt;
    }

    void describe() {
        comparison_.machine = study::describe_machine();
        const std::size_t threads =
            options_.threads == 0 ? comparison_.machine.processors : options_.threads;
        comparison_.settings = {.version = CDPREP_VERSION,
                                .quick = options_.quick,
                                .seed = options_.seed,
                                .per_stratum = options_.per_stratum,
                                .poses = options_.poses.string(),
                                .pairs_left_out = pairs_left_out_,
                                .rounds = options_.rounds,
                                .threads = threads};
        for (const study::StudyMesh& mesh : meshes_) {
            comparison_.models.push_back({mesh.name, mesh.file.string(), mesh.read_vertices,
                                          mesh.read_triangles, mesh.read_hash,
                                          mesh.mesh.positions.size(), mesh.mesh.triangles.size(),
                                          mesh.built_hash, mesh.likeness.sentence});
        }
    }

    std::optional<Error> probe_features() {
        step("features");
        Result<study::Table> table = study::feature_table();
        if (!table) return table.error();
        add({study::feature_check(table.value())});
        comparison_.tables.push_back(std::move(table).value());
        return std::nullopt;
    }

    void compare_builds() {
        std::vector<study::SpatialMesh> measured;
        for (const study::StudyMesh& mesh : meshes_) {
            step(mesh.name + ": spatial decompositions");
            measured.push_back({&mesh, study::measure_spatial_builds(
                                           mesh, {.rounds = options_.rounds,
                                                  .nearest = !options_.quick,
                                                  .parallel_for = threads_.parallel_for(),
                                                  .stop = is_interrupted})});
            if (is_interrupted()) return;
        }
        comparison_.tables.push_back(study::spatial_table(measured));
        for (const study::SpatialMesh& mesh : measured) {
            comparison_.tables.push_back(study::spatial_details(mesh));
        }
        add(study::spatial_checks(measured));
    }

    std::optional<Error> make_forms() {
        for (const study::StudyMesh& mesh : meshes_) {
            step(mesh.name + ": every structure");
            Result<study::ModelForms> made =
                study::make_model_forms(mesh, threads_.parallel_for(), is_interrupted);
            if (is_interrupted()) return interrupted(mesh.file);
            if (!made) {
                return Error{made.error().code, mesh.file.string() + ": " + made.error().message};
            }
            forms_.push_back(std::move(made).value());
        }
        return std::nullopt;
    }

    std::optional<Error> compare_preparation() {
        std::vector<study::Preparation> prepared;
        for (std::size_t i = 0; i < meshes_.size(); ++i) {
            step(meshes_[i].name + ": hull, hierarchy and pieces");
            prepared.push_back(study::measure_preparation(meshes_[i], forms_[i],
                                                          {.rounds = options_.rounds,
                                                           .pieces_alone = !options_.quick,
                                                           .parallel_for = threads_.parallel_for(),
                                                           .stop = is_interrupted}));
            if (is_interrupted()) return std::nullopt;
        }
        comparison_.tables.push_back(study::preparation_table(meshes_, prepared));
        comparison_.tables.push_back(study::preparation_details(meshes_, prepared));
        std::vector<study::PeerRun> runs;
        if (auto error = ask_builds(runs)) return error;
        comparison_.tables.push_back(study::peer_build_table(meshes_, runs, not_asked_));
        add(study::preparation_checks(meshes_, prepared));
        return std::nullopt;
    }

    [[nodiscard]] study::PoseSet poses_of(const Pair& pair) const {
        const study::PoseSetOptions options = {.seed = options_.seed,
                                               .per_stratum = options_.per_stratum,
                                               .parallel_for = threads_.parallel_for(),
                                               .stop = is_interrupted};
        const Model& a = forms_[pair.a].swept.model;
        const Model& b = forms_[pair.b].swept.model;
        if (options_.poses.empty()) return study::make_pose_set(a, b, options);
        return study::ask_poses(a, b, pair.given, pair.pose_file.string(), options);
    }

    [[nodiscard]] study::PairStudy study_of(const Pair& pair) const {
        study::PairStudy study;
        study.poses = poses_of(pair);
        if (options_.tables.pairs) {
            study = study::study_pair(forms_[pair.a], forms_[pair.b], std::move(study.poses),
                                      {.timing = {.rounds = options_.rounds,
                                                  .budget_s = budget(),
                                                  .stop = is_interrupted},
                                       .literal = !options_.quick});
        }
        study.a = pair.a;
        study.b = pair.b;
        return study;
    }

    [[nodiscard]] double budget() const {
        return options_.quick ? kQuickBudget : kBudget;
    }

    /// Runs the peer program, and keeps the answers and the libraries that did not answer.
    Result<study::PeerRun> ask(const PeerQuestions& questions) {
        const Result<std::string> printed = run_peers(options_.peers, questions);
        if (!printed) return printed.error();
        Result<study::PeerRun> run = report::read_peers(printed.value());
        if (!run) return unusable(run.error().message);
        for (const study::AbsentPeer& absent : run.value().absent) {
            not_asked_[absent.key] = absent.reason;
            keep_line(absent.name + " was not measured: " + absent.reason + ".");
        }
        return run;
    }

    /// Adds the peers to our strategies, if a peer program was given.
    std::optional<Error> ask_peers(const Pair& pair, study::PairStudy& study) {
        if (options_.peers.empty() || !options_.tables.pairs) return std::nullopt;
        const std::string questions = study::peer_questions(study.poses);
        const double tolerance = study::kWithinShare * study.poses.diagonal;
        const Result<study::PeerRun> run =
            ask({.what = "pair",
                 .files = {std::as_const(forms_[pair.a].plain.image).span(),
                           std::as_const(forms_[pair.b].plain.image).span(),
                           std::as_bytes(std::span(questions))},
                 .words = {study::formatted("%.17g", tolerance), std::to_string(options_.rounds),
                           study::formatted("%.17g", budget())}});
        if (!run) return run.error();
        for (const study::PeerAnswers& peer : run.value().peers) {
            const std::string wrong = study::add_peer(peer, study);
            if (!wrong.empty()) return unusable(wrong);
            keep_line(peer.name + ": " + peer.note + "; timed in a separate program.");
        }
        return std::nullopt;
    }

    /// Measures the structures that peers build over each model; does nothing without a peer
    /// program.
    std::optional<Error> ask_builds(std::vector<study::PeerRun>& runs) {
        if (options_.peers.empty()) return std::nullopt;
        for (std::size_t i = 0; i < meshes_.size(); ++i) {
            step(meshes_[i].name + ": structures of peers");
            Result<study::PeerRun> run = ask(
                {.what = "build",
                 .files = {std::as_const(forms_[i].plain.image).span()},
                 .words = {std::to_string(options_.rounds), study::formatted("%.17g", budget())}});
            if (!run) return run.error();
            for (const study::PeerBuild& build : run.value().builds) {
                keep_line(build.name + " builds: " + build.note + ".");
            }
            runs.push_back(std::move(run).value());
        }
        return std::nullopt;
    }

    [[nodiscard]] Error unusable(const std::string& what) const {
        return {ErrorCode::unreadable,
                options_.peers.string() + ": the peer program cannot be used: " + what};
    }

    void keep_line(const std::string& line) {
        auto& lines = comparison_.peers;
        if (std::ranges::find(lines, line) == lines.end()) lines.push_back(line);
    }

    std::optional<Error> compare_pairs() {
        std::vector<study::PairStudy> studies;
        for (const Pair& pair : pairs_) {
            step(meshes_[pair.a].name + " x " + meshes_[pair.b].name);
            studies.push_back(study_of(pair));
            if (is_interrupted()) return std::nullopt;
            if (auto error = ask_peers(pair, studies.back())) return error;
        }
        for (const study::PairStudy& study : studies) {
            comparison_.pairs.push_back(
                {meshes_[study.a].name, meshes_[study.b].name, study.poses});
        }
        if (options_.tables.pairs) {
            comparison_.tables.push_back(study::pair_table(meshes_, studies));
            comparison_.tables.push_back(study::peer_pair_table(meshes_, studies, not_asked_));
            for (const study::PairStudy& study : studies) {
                comparison_.tables.push_back(study::pair_details(meshes_, study));
            }
            add(study::pair_checks(meshes_, studies));
        }
        if (!options_.tables.talk) return std::nullopt;
        step("pruning and cell searches");
        std::vector<const study::ModelForms*> forms;
        for (const study::ModelForms& form : forms_) forms.push_back(&form);
        study::Table table = study::pruning_table(meshes_, studies, forms);
        add(study::pruning_checks(table));
        comparison_.tables.push_back(std::move(table));
        study::CellSearchOptions search = {.rounds = options_.rounds, .stop = is_interrupted};
        if (options_.quick) {
            search.depths = {8};
            search.points /= 8;
        }
        study::Table cells = study::cell_search_table(meshes_, search);
        add(study::cell_search_checks(cells));
        comparison_.tables.push_back(std::move(cells));
        return std::nullopt;
    }

    /// Returns the comparative study's pairs in its order, with every mesh that represents one of
    /// its models.
    [[nodiscard]] std::vector<Pair> paper_pairs() const {
        std::vector<Pair> found;
        for (const study::PublishedPair& pair : study::kPublishedPairs) {
            for (std::size_t a = 0; a < meshes_.size(); ++a) {
                for (std::size_t b = 0; b < meshes_.size(); ++b) {
                    const bool is_it = meshes_[a].likeness.version_of == pair.a &&
                                       meshes_[b].likeness.version_of == pair.b;
                    if (is_it && (pair.a != pair.b || a <= b)) found.push_back({a, b});
                }
            }
        }
        return found;
    }

    [[nodiscard]] std::vector<Pair> choose_pairs() const {
        const bool are_published = std::ranges::all_of(meshes_, [](const study::StudyMesh& mesh) {
            return mesh.likeness.version_of.has_value();
        });
        if (options_.pairs == PairChoice::paper ||
            (options_.pairs == PairChoice::fitting && are_published)) {
            std::vector<Pair> found = paper_pairs();
            if (!found.empty() || options_.pairs == PairChoice::paper) return found;
        }
        if (meshes_.size() == 1) return {{0, 0}};
        std::vector<Pair> all;
        for (std::size_t a = 0; a < meshes_.size(); ++a) {
            for (std::size_t b = a + 1; b < meshes_.size(); ++b) all.push_back({a, b});
        }
        return all;
    }

    /// Keeps enough pairs to include each model. Pairs of two models that are in no other pair come
    /// first, then those with one.
    void leave_out_pairs() {
        std::vector<bool> is_asked(meshes_.size());
        std::vector<bool> is_kept(pairs_.size());
        for (const int wanted : {2, 1}) {
            for (std::size_t i = 0; i < pairs_.size(); ++i) {
                const auto& [a, b, file, given] = pairs_[i];
                const int models = a == b ? 1 : 2;
                const int more = (is_asked[a] ? 0 : 1) + (models == 1 || is_asked[b] ? 0 : 1);
                if (more < std::min(wanted, models)) continue;
                is_kept[i] = is_asked[a] = is_asked[b] = true;
            }
        }
        std::size_t number = 0;
        pairs_left_out_ = std::erase_if(pairs_, [&](const Pair&) { return !is_kept[number++]; });
    }

    void add(std::vector<study::Check> checks) {
        comparison_.checks.insert(comparison_.checks.end(), std::make_move_iterator(checks.begin()),
                                  std::make_move_iterator(checks.end()));
    }

    void step(const std::string& what) {
        progress_->show(done_++, what);
    }

    /// Returns the number of calls of step() once the models are read.
    [[nodiscard]] std::size_t count_steps() const {
        const TableChoice& tables = options_.tables;
        const std::size_t models = meshes_.size();
        std::size_t steps = tables.features ? 1 : 0;
        if (tables.spatial) steps += models;
        if (tables.preparation || tables.pairs || tables.talk) steps += models;
        if (tables.preparation) steps += options_.peers.empty() ? models : 2 * models;
        if (tables.pairs || tables.talk) steps += pairs_.size();
        return steps + (tables.talk ? 1 : 0);
    }

    const ComparisonOptions& options_;
    const Threads& threads_;
    ProgressStyle style_;
    std::optional<Progress> progress_;
    std::size_t done_ = 0;
    std::vector<study::StudyMesh> meshes_;
    std::vector<Pair> pairs_;
    std::size_t pairs_left_out_ = 0;
    std::deque<study::ModelForms> forms_;
    study::PeerReasons not_asked_;
    study::Comparison comparison_;
};

}  // namespace

ComparisonOptions settled(ComparisonOptions options) {
    if (options.per_stratum == 0) options.per_stratum = options.quick ? kQuickPoses : kPoses;
    if (options.rounds == 0) options.rounds = options.quick ? kQuickRounds : kRounds;
    return options;
}

Result<study::Comparison> compare_models(const std::vector<fs::path>& files,
                                         const ComparisonOptions& options, const Threads& threads,
                                         ProgressStyle style) {
    return Comparing(options, threads, style, files.size()).run(files);
}

}  // namespace cdprep::cli
