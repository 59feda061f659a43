// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/approximate_pieces.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "decompose/enclose/distance_field.h"
#include "decompose/enclose/face_cells.h"
#include "decompose/enclose/is_convex.h"
#include "decompose/enclose/join_cells.h"
#include "decompose/enclose/merge_corners.h"
#include "decompose/enclose/part_nodes.h"
#include "decompose/enclose/piece_cover.h"
#include "decompose/enclose/piece_points.h"
#include "decompose/enclose/solid_cells.h"
#include "hull/enclosing_hull.h"

namespace cdprep::convex {
namespace {

constexpr double kCellSize = 6;        ///< side of the largest cells, in errors
constexpr double kCellError = 0.5;     ///< in errors: how far a cell's hull may stick out
constexpr double kSpacing = 0.75;      ///< of the field's nodes, in errors
constexpr double kReach = 2.3;         ///< distance outside to which the field measures, in errors
constexpr double kReuse = 1.5;         ///< factor by which the error may change before a new cut
constexpr double kLeastError = 1e-3;   ///< of the diagonal: smallest error that is searched
constexpr double kMeasured = 0.92;     ///< of the requested error: searched, as estimates are low
constexpr double kRelative = 0.02;     ///< relative gap of error bounds, unless that costs too much
constexpr std::size_t kTries = 8;      ///< errors tried to come near the number of parts
constexpr double kFirstError = 0.18;   ///< of the diagonal: expected error of one piece
constexpr double kPower = 0.65;        ///< the expected error falls as (piece count)^-kPower
constexpr double kCloseErrors = 1.05;  ///< ratio of two errors below which the search ends
constexpr double kEnough = 0.95;       ///< of the allowed pieces: enough to end the search
constexpr double kLeastShare = 0.6;    ///< smallest factor to the next error, if one is too large
constexpr std::size_t kRounds = 16;    ///< of attempts with fewer pieces
constexpr double kFewer = 0.93;        ///< of the pieces: what usually remains after attempts
constexpr double kRounding = 1e-6;     ///< of the diagonal: bodies that stick out less are exact
constexpr double kOneCorner = 1e-7;    ///< of the diagonal: corners this near are merged
constexpr double kFineError = 0.02;    ///< of the diagonal: below, exact pieces are good enough
constexpr std::size_t kFewCells = 48;  ///< most cells joined within an error: joining takes long
constexpr std::size_t kShareOfWork = 20;  ///< 1 / share of the work to search for fewer than those

// Approximate costs and limits, in units of ApproximateOptions::work.
constexpr std::size_t kWorkOfNode = 60;           ///< one measured node of a field
constexpr std::size_t kWorkOfFragment = 60;       ///< one fragment of cut cells
constexpr std::size_t kWorkOfCell = 2'000;        ///< one cell that is cut out
constexpr std::size_t kWorkOfErrorCell = 150;     ///< one cell examined by find_hull_error()
constexpr std::size_t kEstimatesAtOnce = 32;      ///< hulls estimated in parallel
constexpr std::size_t kTestsOfWork = 4;           ///< plane tests of find_hull_error() per unit
constexpr std::size_t kFewestNodes = 100'000;     ///< least for a field, whatever work is left
constexpr std::size_t kFewestCells = 500;         ///< least to cut, whatever work is left
constexpr std::size_t kFewestFragments = 4;       ///< least, per triangle on average
constexpr std::size_t kFewestErrorCells = 2'000;  ///< largest minimum per hull, for few hulls
constexpr std::size_t kFewestOfMany = 100;        ///< smallest minimum per hull, for many hulls
constexpr std::size_t kFewestInAll = 400'000;     ///< minimum of all hulls, between these limits
constexpr double kWorkPower = 0.5;                ///< exponent: error growth from the work ratio
constexpr double kLeastGrowth = 1.5;              ///< of an error that takes too much work
constexpr double kMostGrowth = 8;                 ///< the same, at most: predictions are rough

/// Cells and distances for errors near `error`.
struct Stage {
    double error;
    std::optional<DistanceField> field;  ///< none if the cells are exact
    SolidCells cells;
    std::vector<CoverCell> cover;
};

/// Pieces as sets of cells.
struct Found {
    std::shared_ptr<const Stage> stage;
    double error = 0;  ///< the error of the search
    std::vector<std::vector<std::uint32_t>> pieces;
    std::vector<std::uint32_t> whole;  ///< labels that are one piece
    bool complete = false;
    double share = 0;  ///< of the cells that pieces took in, if incomplete
    [[nodiscard]] std::size_t count() const {
        return pieces.size() + whole.size();
    }
};

class PieceSearch {
public:
    PieceSearch(const mesh::Mesh& mesh, const ApproximateOptions& options)
        : mesh_(part_nodes(mesh, options.node_of)),
          options_(options),
          solid_(mesh_, options.reference, options.parallel_for) {
        label_bodies();
        measure_bodies();
    }

    ApproximatePieces run() {
        const std::size_t most = options_.parts.value_or(std::numeric_limits<std::size_t>::max());
        Found found;
        if (options_.max_error) {
            found = find_by_error(*options_.max_error);
            if (found.count() > most) found = find_by_parts(most, *options_.max_error);
        } else {
            found = find_by_parts(options_.parts.value_or(1), 0);
        }
        ApproximatePieces result = finish(found);
        // Estimates may be a little low. The proved error must meet the request.
        for (int i = 0; i < 4 && options_.max_error && found.count() <= most; ++i) {
            if (result.outer_error <= *options_.max_error || !found.complete) break;
            if (found.stage && !found.stage->field) break;  // no estimates: errors were proved
            if (ran_out_of_work_ || found.error <= kLeastError * solid_.diagonal()) break;
            const double share = 0.95 * *options_.max_error / result.outer_error;
            found = cover_with_few(std::max(share, kLeastShare) * found.error);
            ran_out_of_work_ = ran_out_of_work_ || !found.complete;
            if (!found.complete || found.count() > most) break;
            result = finish(found);
        }
        if (exact_ && exact_->count() <= most && result.outer_error > *options_.max_error) {
            ApproximatePieces exact = finish(*exact_);
            if (exact.outer_error < result.outer_error) result = std::move(exact);
        }
        result.is_as_asked = result.pieces.size() <= most &&
                             (!options_.max_error || result.outer_error <= *options_.max_error);
        result.work = work_done_;
        // Bounds that are loose for lack of work matter only then.
        result.ran_out_of_work =
            ran_out_of_work_ || (result.ran_out_of_work && !result.is_as_asked);
        return result;
    }

private:
    /// Gives bodies that may share a piece the same label.
    void label_bodies() {
        label_.resize(solid_.body_count());
        std::map<std::uint32_t, std::uint32_t> label_of_node;
        node_.assign(solid_.body_count(), 0);
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            const std::uint32_t body = solid_.body_of(i);
            if (!options_.node_of.empty()) node_[body] = options_.node_of[i];
        }
        label_count_ = 0;
        for (std::uint32_t body = 0; body < solid_.body_count(); ++body) {
            const bool one =
                node_[body] < options_.convex_node.size() && options_.convex_node[node_[body]] != 0;
            if (one || options_.merge_components) {
                // Node numbers plus 1; 0 is for merged bodies.
                const auto key = one ? node_[body] + 1 : 0;
                const auto [at, is_new] = label_of_node.try_emplace(key, label_count_);
                label_count_ += is_new ? 1 : 0;
                label_[body] = at->second;
                if (one) is_convex_label_.insert(at->second);
            } else {
                label_[body] = label_count_++;
            }
        }
    }

    /// Measures how far the hull of each label sticks out if it is one piece.
    void measure_bodies() {
        points_of_.resize(label_count_);
        triangles_of_.resize(label_count_);
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            triangles_of_[label_[solid_.body_of(i)]].push_back(i);
        }
        gather_vertices();
        whole_.resize(label_count_);
        const std::size_t most_cells = most_error_cells(label_count_);
        const auto measure = [&](std::size_t label) {
            ApproximatePiece& piece = whole_[label];
            piece.triangles = triangles_of_[label];
            piece.hull = convex_hull(points_of_[label], options_.parallel_for);
            piece.hull.numbers.clear();
            piece.node = node_[solid_.body_of(piece.triangles.front())];
            if (options_.reference == Reference::solid &&
                is_convex(mesh_, piece.triangles, piece.hull)) {
                return;
            }
            HullErrorOptions how;
            how.relative = kRelative;
            how.enough = kLeastError * solid_.diagonal();
            how.most_cells = most_cells;
            piece.error = find_hull_error(piece.hull, solid_, how);
        };
        options_.parallel_for(label_count_, measure);
        for (const ApproximatePiece& piece : whole_) work_done_ += work_of(piece.error);
    }

    [[nodiscard]] static std::size_t work_of(const HullError& error) {
        return kWorkOfErrorCell * error.cells + error.tests / kTestsOfWork;
    }
    [[nodiscard]] std::size_t work_left() const {
        return options_.work > work_done_ ? options_.work - work_done_ : 0;
    }
    /// Returns the budget of one search. It keeps a reserve to measure the result and halves the
    /// rest. The other half is for a looser search if this one does not suffice.
    [[nodiscard]] std::size_t most_search() const {
        return (work_left() - std::min(work_left() / 2, options_.work / 8)) / 2;
    }
    /// Returns the number of cells for each of some hulls. Together they take at most half of the
    /// work that is left, above a minimum.
    [[nodiscard]] std::size_t most_error_cells(std::size_t hulls) const {
        const std::size_t fewest =
            std::clamp(kFewestInAll / hulls, kFewestOfMany, kFewestErrorCells);
        return std::clamp(work_left() / 2 / kWorkOfErrorCell / hulls, fewest,
                          HullErrorOptions{}.most_cells);
    }

    /// Gathers the vertices of each label. A vertex belongs to one body, and so to one label.
    void gather_vertices() {
        std::vector<std::uint32_t> label_of(mesh_.positions.size(), label_count_);
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            for (const std::uint32_t v : mesh_.triangles[i].vertex) {
                label_of[v] = label_[solid_.body_of(i)];
            }
        }
        for (std::size_t v = 0; v < label_of.size(); ++v) {
            if (label_of[v] < label_count_) points_of_[label_of[v]].push_back(mesh_.positions[v]);
        }
    }

    [[nodiscard]] bool is_whole(std::uint32_t label, double error) const {
        return is_convex_label_.contains(label) || whole_[label].error.upper <= error;
    }

    const std::shared_ptr<const Stage>& stage_for(double error) {
        const bool fits =
            stage_ && error <= stage_->error * kReuse && error >= stage_->error / kReuse;
        if (fits) return stage_;
        const std::size_t most_nodes =
            std::clamp(most_search() / 2 / kWorkOfNode, kFewestNodes, DistanceField::kMostNodes);
        DistanceField field(solid_, kSpacing * error, kReach * error, options_.parallel_for,
                            most_nodes);
        SolidCellOptions how;
        how.size = kCellSize * error;
        how.error = kCellError * error;
        how.most_cells = std::clamp(most_search() / 4 / kWorkOfCell, kFewestCells, how.most_cells);
        const std::size_t fewest = kFewestFragments * mesh_.triangles.size();
        how.most_fragments = std::max(most_search() / 4 / kWorkOfFragment, fewest);
        how.parallel_for = options_.parallel_for;
        SolidCells cells = cut_into_cells(mesh_, solid_, field, how);
        std::vector<CoverCell> cover(cells.cells.size());
        const auto gather = [&](std::size_t i) {
            const SolidCell& cell = cells.cells[i];
            cover[i] = {cell.box, label_[cell.body], extreme_points(cells, cell)};
        };
        options_.parallel_for(cover.size(), gather);
        work_done_ += kWorkOfNode * field.measured() + kWorkOfFragment * cells.fragments.size() +
                      kWorkOfCell * cells.cells.size();
        stage_ = std::make_shared<const Stage>(
            Stage{error, std::move(field), std::move(cells), std::move(cover)});
        return stage_;
    }

    /// Returns the first pieces found for one error.
    Found cover(double error) {
        Found found;
        found.error = std::max(error, kLeastError * solid_.diagonal());
        for (std::uint32_t label = 0; label < label_count_; ++label) {
            if (is_whole(label, found.error)) found.whole.push_back(label);
        }
        found.complete = true;
        if (found.whole.size() == label_count_) return found;
        found.stage = stage_for(found.error);
        search(found, 0, 0);
        return found;
    }

    /// Tries to use fewer pieces, until there are few enough.
    void improve(Found& found, std::size_t few_enough) {
        if (found.complete && found.stage) search(found, kRounds, few_enough);
    }

    /// Covers the bodies that are not one piece, or continues from the given pieces.
    void search(Found& found, std::size_t rounds, std::size_t few_enough) {
        const std::vector<CoverCell>& all = found.stage->cover;
        std::vector<CoverCell> cells;
        std::vector<std::uint32_t> numbers;
        std::vector<std::uint32_t> place(all.size());
        for (std::uint32_t i = 0; i < all.size(); ++i) {
            if (std::binary_search(found.whole.begin(), found.whole.end(), all[i].body)) continue;
            place[i] = static_cast<std::uint32_t>(cells.size());
            cells.push_back(all[i]);
            numbers.push_back(i);
        }
        const auto renumber = [&](const std::vector<std::uint32_t>& name) {
            for (auto& piece : found.pieces) {
                for (std::uint32_t& cell : piece) cell = name[cell];
            }
        };
        renumber(place);
        CoverOptions how;
        how.error = found.error;
        how.rounds = rounds;
        how.few_enough = few_enough > found.whole.size() ? few_enough - found.whole.size() : 0;
        how.begin_with = found.pieces;
        how.known = known_;
        how.most_work = most_search();
        how.parallel_for = options_.parallel_for;
        Cover covered = cover_with_pieces(cells, *found.stage->field, how);
        work_done_ += covered.work;
        known_.insert(known_.end(), covered.found.begin(), covered.found.end());
        found.complete = covered.complete;
        found.share = covered.share;
        found.pieces = std::move(covered.pieces);
        renumber(numbers);
    }

    /// Returns as few pieces for one error as the search finds.
    Found cover_with_few(double error) {
        Found found = cover(error);
        improve(found, 0);
        return found;
    }

    /// Returns the result that needs no search: every label is one piece.
    Found all_whole() {
        Found found;
        found.error = solid_.diagonal();
        for (std::uint32_t label = 0; label < label_count_; ++label) found.whole.push_back(label);
        return found;
    }

    /// Returns pieces of bodies with plane faces, cut along these, within an error or exactly.
    /// Returns nothing if a body that does not stay whole has too many faces.
    std::optional<Found> cut_exactly(double error) {
        Found found;
        found.error = error;
        std::vector<bool> is_wanted(solid_.body_count(), false);
        for (std::uint32_t label = 0; label < label_count_; ++label) {
            if (is_whole(label, std::max(error, kRounding * solid_.diagonal()))) {
                found.whole.push_back(label);
            }
        }
        for (std::uint32_t body = 0; body < is_wanted.size(); ++body) {
            is_wanted[body] =
                !std::binary_search(found.whole.begin(), found.whole.end(), label_[body]);
        }
        found.complete = true;
        if (found.whole.size() == label_count_) return found;
        auto cells = cut_along_faces(mesh_, solid_, is_wanted);
        if (!cells) return std::nullopt;
        std::vector<std::uint32_t> all(cells->cells.size());
        std::iota(all.begin(), all.end(), 0U);
        found.pieces = join_cells(*cells, all, solid_, 0, options_.parallel_for);
        if (error > 0 && found.count() > label_count_ + 1 && all.size() <= kFewCells) {
            auto fewer = join_cells(*cells, all, solid_, error, options_.parallel_for);
            if (fewer.size() < found.pieces.size()) found.pieces = std::move(fewer);
        }
        found.stage =
            std::make_shared<const Stage>(Stage{error, std::nullopt, std::move(*cells), {}});
        return found;
    }

    /// Returns the factor for the next error after a search that took too much work. A larger error
    /// gives larger cells and fewer pieces, and so takes less work.
    [[nodiscard]] double growth_after(const Found& incomplete, std::size_t work) const {
        const double needed = static_cast<double>(work) / std::max(incomplete.share, 0.01);
        const double left = static_cast<double>(std::max<std::size_t>(most_search(), 1));
        return std::clamp(std::pow(needed / left, kWorkPower), kLeastGrowth, kMostGrowth);
    }

    Found find_by_error(double max_error) {
        auto exact = cut_exactly(max_error);
        if (!exact) return find_within(max_error);
        // At least one label needs several pieces, so this is the smallest possible count.
        const bool is_enough =
            exact->count() <= label_count_ + 1 || max_error < kFineError * solid_.diagonal();
        if (is_enough) return std::move(*exact);
        const std::size_t kept_back = options_.work - options_.work / kShareOfWork;
        work_done_ += kept_back;
        Found found = cover_with_few(kMeasured * max_error);
        work_done_ -= kept_back;
        if (!found.complete || found.count() >= exact->count()) return std::move(*exact);
        exact_ = std::move(exact);
        return found;
    }

    Found find_within(double max_error) {
        double error = kMeasured * max_error;
        while (error < solid_.diagonal()) {
            const std::size_t before = work_done_;
            Found found = cover_with_few(error);
            if (found.complete) return found;
            ran_out_of_work_ = true;
            error = found.error * growth_after(found, work_done_ - before);
        }
        return all_whole();
    }

    /// Two errors that enclose the sought one, and the number of pieces for each. The number is
    /// about a power of the error.
    struct Bracket {
        double too_small = 0;
        double most_pieces = 0;
        double good = std::numeric_limits<double>::infinity();
        double fewest_pieces = 0;

        [[nodiscard]] bool is_closed() const {
            return too_small > 0 && good <= kCloseErrors * too_small;
        }
        /// Returns the error at which this number of pieces is expected.
        [[nodiscard]] double guess(double pieces) const {
            if (too_small == 0) {
                return good * std::clamp(std::pow(fewest_pieces / pieces, kPower), 0.6, 0.9);
            }
            if (std::isinf(good)) {
                return too_small * std::clamp(std::pow(most_pieces / pieces, kPower), 1.1, 1.7);
            }
            const double share = std::log(most_pieces / pieces) /
                                 std::log(most_pieces / std::max(fewest_pieces, 1.0));
            return too_small * std::pow(good / too_small, std::clamp(share, 0.2, 0.8));
        }
    };

    /// Returns pieces for the least error found, not below `least`, that needs at most `parts`
    /// pieces.
    Found find_by_parts(std::size_t parts, double least) {
        Found best = all_whole();
        if (parts <= label_count_) return best;
        auto exact = cut_exactly(least);
        if (exact && exact->count() <= parts) return std::move(*exact);
        // Without attempts to use fewer pieces: their saving is known well enough.
        const double aim = static_cast<double>(parts) / kFewer;
        double error = std::max(
            least, kFirstError * solid_.diagonal() / std::pow(static_cast<double>(parts), kPower));
        Bracket bracket;
        Found close;
        for (std::size_t i = 0; i < kTries && !bracket.is_closed(); ++i) {
            const std::size_t before = work_done_;
            Found found = cover(error);
            if (!found.complete) {
                ran_out_of_work_ = true;
                if (best.error < solid_.diagonal()) return best;
                error *= growth_after(found, work_done_ - before);
                if (error >= solid_.diagonal()) return best;
                continue;
            }
            const double count = static_cast<double>(found.count());
            if (found.count() <= parts && found.error < best.error) best = found;
            if (count > aim) {
                bracket.too_small = error;
                bracket.most_pieces = count;
            } else {
                bracket.good = error;
                bracket.fewest_pieces = count;
                close = std::move(found);
                if (count >= kEnough * static_cast<double>(parts) || error <= least) break;
            }
            error = std::max(bracket.guess(static_cast<double>(parts)), least);
        }
        for (int i = 0; i < 5 && close.stage && close.error < best.error; ++i) {
            improve(close, parts);
            if (!close.complete) {
                ran_out_of_work_ = true;
                return best;
            }
            if (close.count() <= parts) return close;
            close = cover(1.04 * close.error);
        }
        return best;
    }

    /// Returns a hull with no more vertices than an engine takes, or the hull itself if that fails.
    [[nodiscard]] ConvexHull limited(ConvexHull hull) const {
        hull.numbers.clear();
        if (options_.max_vertices == 0 || hull.points.size() <= options_.max_vertices) return hull;
        auto few = enclosing_hull(hull, std::max(options_.max_vertices, kFewestEnclosingVertices));
        return few ? std::move(few->hull) : hull;
    }

    /// Returns about the greatest distance by which some pieces stick out: measured, or from the
    /// field. A piece below the greatest so far is not examined closely.
    double estimate_greatest(const Found& found, std::span<const ApproximatePiece> pieces,
                             std::span<const std::uint8_t> is_measured) {
        double greatest = 0;
        std::vector<std::size_t> open;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            if (is_measured[i] == 0) {
                open.push_back(i);
            } else {
                greatest = std::max(greatest, pieces[i].error.upper);
            }
        }
        if (!found.stage || !found.stage->field) return greatest;
        std::vector<Estimate> estimates(open.size());
        for (std::size_t begin = 0; begin < open.size(); begin += kEstimatesAtOnce) {
            const std::size_t count = std::min(kEstimatesAtOnce, open.size() - begin);
            const double least = greatest;
            const Detail detail = work_left() > 0 ? Detail::fine : Detail::coarse;
            const auto estimate = [&](std::size_t k) {
                estimates[begin + k] =
                    found.stage->field->estimate(pieces[open[begin + k]].hull, least, detail);
            };
            options_.parallel_for(count, estimate);
            for (std::size_t k = begin; k < begin + count; ++k) {
                greatest = std::max(greatest, estimates[k].distance);
                work_done_ += kWorkOfSample * estimates[k].samples;
            }
        }
        return greatest;
    }

    /// Builds the hulls, proves that they contain their points, and measures their errors.
    ApproximatePieces finish(const Found& found) {
        ApproximatePieces result;
        std::vector<PiecePoints> points;
        for (const std::uint32_t label : found.whole) {
            result.pieces.push_back(whole_[label]);
            points.push_back(
                {points_of_[label], whole_[label].triangles, whole_[label].triangles.size()});
        }
        const std::size_t first = result.pieces.size();
        if (!found.pieces.empty()) {
            auto more = gather_points(found.stage->cells, mesh_, found.pieces);
            std::move(more.begin(), more.end(), std::back_inserter(points));
        }
        result.pieces.resize(points.size());
        std::vector<EnclosureProof> proofs(points.size());
        std::vector<std::uint8_t> is_measured(points.size(), 0);
        const auto finish_piece = [&](std::size_t i) {
            ApproximatePiece& piece = result.pieces[i];
            if (i >= first) {
                piece.hull =
                    merge_corners(convex_hull(points[i].points), kOneCorner * solid_.diagonal());
                piece.triangles = points[i].triangles;
                if (!piece.triangles.empty()) {
                    piece.node = node_[solid_.body_of(piece.triangles.front())];
                }
            }
            const std::size_t exact = piece.hull.points.size();
            piece.hull = limited(std::move(piece.hull));
            proofs[i] = prove_points(piece.hull, points[i].points);
            proofs[i].fragments = points[i].fragments;
            is_measured[i] = i < first && piece.hull.points.size() == exact ? 1 : 0;
        };
        options_.parallel_for(points.size(), finish_piece);
        measure_errors(found, std::move(is_measured), result);
        result.proof.triangles = mesh_.triangles.size();
        for (std::size_t i = 0; i < proofs.size(); ++i) {
            result.proof.fragments += proofs[i].fragments;
            result.proof.tests += proofs[i].tests;
            result.proof.outside += proofs[i].outside;
            result.outer_error = std::max(result.outer_error, result.pieces[i].error.upper);
            result.outer_lower = std::max(result.outer_lower, result.pieces[i].error.lower);
        }
        return result;
    }

    /// Measures how far pieces stick out, except those already measured.
    void measure_errors(const Found& found, std::vector<std::uint8_t> is_measured,
                        ApproximatePieces& result) {
        // A bound below the largest error does not improve the bound of all pieces.
        HullErrorOptions how;
        how.relative = kRelative;
        how.enough = (1 + kRelative) * estimate_greatest(found, result.pieces, is_measured);
        // A few hulls take more work than most. They get the work that is left.
        how.most_cells = 0;
        for (int round = 0; round < 2; ++round) {
            std::vector<std::size_t> open;
            for (std::size_t i = 0; i < is_measured.size(); ++i) {
                if (is_measured[i] == 0) open.push_back(i);
            }
            if (open.empty() || most_error_cells(open.size()) <= how.most_cells) break;
            how.most_cells = most_error_cells(open.size());
            const auto measure = [&](std::size_t k) {
                result.pieces[open[k]].error =
                    find_hull_error(result.pieces[open[k]].hull, solid_, how);
            };
            options_.parallel_for(open.size(), measure);
            for (const std::size_t i : open) {
                const std::size_t cells = result.pieces[i].error.cells;
                work_done_ += work_of(result.pieces[i].error);
                is_measured[i] = cells < how.most_cells / 2 ? 1 : 0;
            }
        }
        result.ran_out_of_work =
            std::find(is_measured.begin(), is_measured.end(), 0) != is_measured.end();
    }

    mesh::Mesh mesh_;
    const ApproximateOptions& options_;
    Solid solid_;
    std::uint32_t label_count_ = 0;
    std::vector<std::uint32_t> label_;  ///< of each body
    std::vector<std::uint32_t> node_;   ///< of each body
    std::set<std::uint32_t> is_convex_label_;
    std::vector<std::vector<Double3>> points_of_;  ///< of each label
    std::vector<std::vector<std::uint32_t>> triangles_of_;
    std::vector<ApproximatePiece> whole_;
    std::shared_ptr<const Stage> stage_;
    std::optional<Found> exact_;   ///< the fallback if a search for fewer sticks out too far
    std::vector<Estimate> known_;  ///< points far out that pieces tried to take in
    std::size_t work_done_ = 0;
    bool ran_out_of_work_ = false;
};

}  // namespace

ApproximatePieces find_approximate_pieces(const mesh::Mesh& mesh,
                                          const ApproximateOptions& options) {
    if (mesh.triangles.empty()) return {};
    return PieceSearch(mesh, options).run();
}

}  // namespace cdprep::convex
