// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/approximate_parts.h"

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
#include "decompose/enclose/part_cover.h"
#include "decompose/enclose/part_points.h"
#include "decompose/enclose/search_scale.h"
#include "decompose/enclose/separate_nodes.h"
#include "decompose/enclose/solid_cells.h"
#include "hull/enclosing_hull.h"

namespace cdprep::convex {
namespace {

// A number without a reason was chosen by trial. It trades the number of parts and their error
// against time. tests/bench/vary_constants.py measures the effect of each.
constexpr double kCellSize = 6;        ///< side of the largest cells, in errors
constexpr double kCellError = 0.5;     ///< in errors: how far a cell's hull may stick out
constexpr double kSpacing = 0.75;      ///< of the field's nodes, in errors
constexpr double kReach = 2.3;         ///< distance outside to which the field measures, in errors
constexpr double kReuse = 1.5;         ///< factor by which the error may change before a new cut
constexpr double kLeastError = 1e-3;   ///< of the diagonal: smallest error that is searched
constexpr double kMeasured = 0.92;     ///< of the requested error: searched, as estimates are low
constexpr double kRelative = 0.02;     ///< relative gap of error bounds, unless that costs too much
constexpr std::size_t kTries = 8;      ///< errors tried to come near the number of parts
constexpr double kFirstError = 0.18;   ///< of the diagonal: expected error of one part
constexpr double kPower = 0.65;        ///< the expected error falls as (part count)^-kPower
constexpr double kCloseErrors = 1.05;  ///< ratio of two errors below which the search ends
constexpr double kEnough = 0.95;       ///< of the allowed parts: enough to end the search
constexpr double kLeastShare = 0.6;    ///< smallest factor to the next error, if one is too large
constexpr double kCorrected = 0.95;    ///< of the error that should do: nearer to 1, it may not
constexpr int kCorrections = 4;        ///< searches for that error; each takes much work
constexpr std::size_t kRounds = 16;    ///< of attempts with fewer parts
constexpr double kFewer = 0.93;        ///< of the parts: what usually remains after attempts
constexpr double kRounding = 1e-6;     ///< of the diagonal: bodies that stick out less are exact
constexpr double kOneCorner = 1e-7;    ///< of the diagonal: corners this near are merged
constexpr double kFineError = 0.02;    ///< of the diagonal: below, exact parts are good enough
constexpr std::size_t kFewCells = 48;  ///< most cells joined within an error: joining takes long
constexpr std::size_t kShareOfWork = 20;  ///< 1 / share of the work to search for fewer than those

// Limits of a step to the next error, if the bracket has one side only. A smaller step gains
// little. The guess, by kPower, is too rough for a larger one.
constexpr double kLeastDown = 0.1;  ///< of the error: least step to a smaller one
constexpr double kMostDown = 0.4;   ///< the same, largest
constexpr double kLeastUp = 0.1;    ///< of the error: least step to a larger one
constexpr double kMostUp = 0.7;     ///< the same, largest
/// The least step from either end of a bracket, as a share of the way between the logarithms of its
/// errors. A guess nearer to an end may hardly narrow the bracket.
constexpr double kLeastInside = 0.2;
// If attempts with fewer parts do not suffice at the error that came close, larger errors follow.
constexpr double kLooser = 0.04;         ///< of the error: the step; kCloseErrors is hardly more
constexpr std::size_t kLooserTries = 5;  ///< errors in all: up to 1.17 times the first

// Approximate costs and limits, in units of ApproximateOptions::work.
constexpr std::size_t kReserved = 8;              ///< 1 / share of all: kept to measure the result
constexpr std::size_t kShareOfField = 2;          ///< 1 / share of a search for its field
constexpr std::size_t kShareOfCells = 4;          ///< the same for its cells
constexpr std::size_t kShareOfFragments = 4;      ///< the same for their fragments
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
constexpr double kLeastCovered = 0.01;            ///< of the cells: with fewer, as if so many were
constexpr int kMeasurements = 2;                  ///< of the errors: all parts, then costly ones

/// Cells and distances for errors near `error`.
struct Stage {
    double error;
    std::optional<DistanceField> field;  ///< none if the cells are exact
    SolidCells cells;
    std::vector<CoverCell> cover;
};

bool is_request_met(const ApproximateParts& found, const ApproximateOptions& options) {
    return (!options.max_parts || found.parts.size() <= *options.max_parts) &&
           (!options.max_error || found.outer_error <= *options.max_error);
}

/// Parts as sets of cells.
struct Found {
    std::shared_ptr<const Stage> stage;
    double error = 0;  ///< the error of the search
    std::vector<std::vector<std::uint32_t>> parts;
    std::vector<std::uint32_t> whole;  ///< labels that are one part
    bool complete = false;
    double share = 0;  ///< of the cells that parts took in, if incomplete
    [[nodiscard]] std::size_t count() const {
        return parts.size() + whole.size();
    }
};

class PartSearch {
public:
    PartSearch(const mesh::Mesh& mesh, const ApproximateOptions& options)
        : mesh_(separate_nodes(mesh, options.node_of)),
          options_(options),
          solid_(mesh_, options.reference, options.parallel_for) {
        label_bodies();
        measure_bodies();
    }

    ApproximateParts run() {
        const std::size_t most =
            options_.max_parts.value_or(std::numeric_limits<std::size_t>::max());
        Found found;
        if (options_.max_error) {
            found = find_by_error(*options_.max_error);
            if (found.count() > most) found = find_by_parts(most, *options_.max_error);
        } else {
            found = find_by_parts(options_.max_parts.value_or(1), 0);
        }
        ApproximateParts result = finish(found);
        // Estimates may be a little low. The proved error must meet the request.
        for (int i = 0; i < kCorrections && options_.max_error && found.count() <= most; ++i) {
            if (result.outer_error <= *options_.max_error || !found.complete) break;
            if (found.stage && !found.stage->field) break;  // no estimates: errors were proved
            if (ran_out_of_work_ || found.error <= kLeastError * solid_.diagonal()) break;
            const double share = kCorrected * *options_.max_error / result.outer_error;
            found = cover_with_few(std::max(share, kLeastShare) * found.error);
            ran_out_of_work_ = ran_out_of_work_ || !found.complete;
            if (!found.complete || found.count() > most) break;
            result = finish(found);
        }
        if (exact_ && exact_->count() <= most && result.outer_error > *options_.max_error) {
            ApproximateParts exact = finish(*exact_);
            if (exact.outer_error < result.outer_error) result = std::move(exact);
        }
        result.is_as_asked = is_request_met(result, options_);
        result.work = work_done_;
        // Bounds that are loose for lack of work matter only then.
        result.ran_out_of_work =
            ran_out_of_work_ || (result.ran_out_of_work && !result.is_as_asked);
        return result;
    }

private:
    /// Gives bodies that may share a part the same label.
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

    /// Measures how far the hull of each label sticks out if it is one part.
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
            ApproximatePart& part = whole_[label];
            part.triangles = triangles_of_[label];
            part.hull = convex_hull(points_of_[label], options_.parallel_for);
            part.hull.numbers.clear();
            part.node = node_[solid_.body_of(part.triangles.front())];
            if (options_.reference == Reference::solid &&
                is_convex(mesh_, part.triangles, part.hull)) {
                return;
            }
            HullErrorOptions how;
            how.relative = kRelative;
            how.enough = kLeastError * solid_.diagonal();
            how.most_cells = most_cells;
            part.error = find_hull_error(part.hull, solid_, how);
        };
        options_.parallel_for(label_count_, measure);
        for (const ApproximatePart& part : whole_) work_done_ += work_of(part.error);
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
        return (work_left() - std::min(work_left() / 2, options_.work / kReserved)) / 2;
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
        const std::size_t most_nodes = std::clamp(most_search() / kShareOfField / kWorkOfNode,
                                                  kFewestNodes, DistanceField::kMostNodes);
        DistanceField field(solid_, kSpacing * error, kReach * error, options_.parallel_for,
                            most_nodes);
        SolidCellOptions how;
        how.size = kCellSize * error;
        how.error = kCellError * error;
        how.most_cells =
            std::clamp(most_search() / kShareOfCells / kWorkOfCell, kFewestCells, how.most_cells);
        const std::size_t fewest = kFewestFragments * mesh_.triangles.size();
        how.most_fragments = std::max(most_search() / kShareOfFragments / kWorkOfFragment, fewest);
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

    /// Returns the first parts found for one error.
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

    /// Tries to use fewer parts, until there are few enough.
    void improve(Found& found, std::size_t few_enough) {
        if (found.complete && found.stage) search(found, kRounds, few_enough);
    }

    /// Covers the bodies that are not one part, or continues from the given parts.
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
            for (auto& part : found.parts) {
                for (std::uint32_t& cell : part) cell = name[cell];
            }
        };
        renumber(place);
        CoverOptions how;
        how.error = found.error;
        how.rounds = rounds;
        how.few_enough = few_enough > found.whole.size() ? few_enough - found.whole.size() : 0;
        how.begin_with = found.parts;
        how.known = known_;
        how.most_work = most_search();
        how.parallel_for = options_.parallel_for;
        Cover covered = cover_with_parts(cells, *found.stage->field, how);
        work_done_ += covered.work;
        known_.insert(known_.end(), covered.found.begin(), covered.found.end());
        found.complete = covered.complete;
        found.share = covered.share;
        found.parts = std::move(covered.parts);
        renumber(numbers);
    }

    /// Returns as few parts for one error as the search finds.
    Found cover_with_few(double error) {
        Found found = cover(error);
        improve(found, 0);
        return found;
    }

    /// Returns the result that needs no search: every label is one part.
    Found all_whole() {
        Found found;
        found.error = solid_.diagonal();
        for (std::uint32_t label = 0; label < label_count_; ++label) found.whole.push_back(label);
        return found;
    }

    /// Returns parts of bodies with plane faces, cut along these, within an error or exactly.
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
        found.parts = join_cells(*cells, all, solid_, 0, options_.parallel_for);
        if (error > 0 && found.count() > label_count_ + 1 && all.size() <= kFewCells) {
            auto fewer = join_cells(*cells, all, solid_, error, options_.parallel_for);
            if (fewer.size() < found.parts.size()) found.parts = std::move(fewer);
        }
        found.stage =
            std::make_shared<const Stage>(Stage{error, std::nullopt, std::move(*cells), {}});
        return found;
    }

    /// Returns the factor for the next error after a search that took too much work. A larger error
    /// gives larger cells and fewer parts, and so takes less work.
    [[nodiscard]] double growth_after(const Found& incomplete, std::size_t work) const {
        const double needed = static_cast<double>(work) / std::max(incomplete.share, kLeastCovered);
        const double left = static_cast<double>(std::max<std::size_t>(most_search(), 1));
        return std::clamp(std::pow(needed / left, kWorkPower), kLeastGrowth, kMostGrowth);
    }

    Found find_by_error(double max_error) {
        auto exact = cut_exactly(max_error);
        if (!exact) return find_within(max_error);
        // At least one label needs several parts, so this is the smallest possible count.
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

    /// Two errors that enclose the sought one, and the number of parts for each. The number is
    /// about a power of the error.
    struct Bracket {
        double too_small = 0;
        double most_parts = 0;
        double good = std::numeric_limits<double>::infinity();
        double fewest_parts = 0;

        [[nodiscard]] bool is_closed() const {
            return too_small > 0 && good <= kCloseErrors * too_small;
        }
        /// Returns the error at which this number of parts is expected.
        [[nodiscard]] double guess(double parts) const {
            if (too_small == 0) {
                const double factor = std::pow(fewest_parts / parts, kPower);
                return good * std::clamp(factor, 1 - kMostDown, 1 - kLeastDown);
            }
            if (std::isinf(good)) {
                const double factor = std::pow(most_parts / parts, kPower);
                return too_small * std::clamp(factor, 1 + kLeastUp, 1 + kMostUp);
            }
            const double share =
                std::log(most_parts / parts) / std::log(most_parts / std::max(fewest_parts, 1.0));
            const double inside = std::clamp(share, kLeastInside, 1 - kLeastInside);
            return too_small * std::pow(good / too_small, inside);
        }
    };

    /// Returns at most `most` parts, for the least error found that is not below `least`.
    Found find_by_parts(std::size_t most, double least) {
        Found best = all_whole();
        if (most <= label_count_) return best;
        auto exact = cut_exactly(least);
        if (exact && exact->count() <= most) return std::move(*exact);
        // Without attempts to use fewer parts: their saving is known well enough.
        const double aim = static_cast<double>(most) / kFewer;
        double error = std::max(
            least, kFirstError * solid_.diagonal() / std::pow(static_cast<double>(most), kPower));
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
            if (found.count() <= most && found.error < best.error) best = found;
            if (count > aim) {
                bracket.too_small = error;
                bracket.most_parts = count;
            } else {
                bracket.good = error;
                bracket.fewest_parts = count;
                close = std::move(found);
                if (count >= kEnough * static_cast<double>(most) || error <= least) break;
            }
            error = std::max(bracket.guess(static_cast<double>(most)), least);
        }
        for (std::size_t i = 0; i < kLooserTries && close.stage && close.error < best.error; ++i) {
            improve(close, most);
            if (!close.complete) {
                ran_out_of_work_ = true;
                return best;
            }
            if (close.count() <= most) return close;
            close = cover((1 + kLooser) * close.error);
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

    /// Returns about the greatest distance by which some parts stick out: measured, or from the
    /// field. A part below the greatest so far is not examined closely.
    double estimate_greatest(const Found& found, std::span<const ApproximatePart> parts,
                             std::span<const std::uint8_t> is_measured) {
        double greatest = 0;
        std::vector<std::size_t> open;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (is_measured[i] == 0) {
                open.push_back(i);
            } else {
                greatest = std::max(greatest, parts[i].error.upper);
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
                    found.stage->field->estimate(parts[open[begin + k]].hull, least, detail);
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
    ApproximateParts finish(const Found& found) {
        ApproximateParts result;
        std::vector<PartPoints> points;
        for (const std::uint32_t label : found.whole) {
            result.parts.push_back(whole_[label]);
            points.push_back(
                {points_of_[label], whole_[label].triangles, whole_[label].triangles.size()});
        }
        const std::size_t first = result.parts.size();
        if (!found.parts.empty()) {
            auto more = gather_points(found.stage->cells, mesh_, found.parts);
            std::move(more.begin(), more.end(), std::back_inserter(points));
        }
        result.parts.resize(points.size());
        std::vector<EnclosureProof> proofs(points.size());
        std::vector<std::uint8_t> is_measured(points.size(), 0);
        const auto finish_part = [&](std::size_t i) {
            ApproximatePart& part = result.parts[i];
            if (i >= first) {
                part.hull =
                    merge_corners(convex_hull(points[i].points), kOneCorner * solid_.diagonal());
                part.triangles = points[i].triangles;
                if (!part.triangles.empty()) {
                    part.node = node_[solid_.body_of(part.triangles.front())];
                }
            }
            const std::size_t exact = part.hull.points.size();
            part.hull = limited(std::move(part.hull));
            proofs[i] = prove_points(part.hull, points[i].points);
            proofs[i].fragments = points[i].fragments;
            is_measured[i] = i < first && part.hull.points.size() == exact ? 1 : 0;
        };
        options_.parallel_for(points.size(), finish_part);
        measure_errors(found, std::move(is_measured), result);
        result.proof.triangles = mesh_.triangles.size();
        for (std::size_t i = 0; i < proofs.size(); ++i) {
            result.proof.fragments += proofs[i].fragments;
            result.proof.tests += proofs[i].tests;
            result.proof.outside += proofs[i].outside;
            result.outer_error = std::max(result.outer_error, result.parts[i].error.upper);
            result.outer_lower = std::max(result.outer_lower, result.parts[i].error.lower);
        }
        return result;
    }

    /// Measures how far parts stick out, except those already measured.
    void measure_errors(const Found& found, std::vector<std::uint8_t> is_measured,
                        ApproximateParts& result) {
        // A bound below the largest error does not improve the bound of all parts.
        HullErrorOptions how;
        how.relative = kRelative;
        how.enough = (1 + kRelative) * estimate_greatest(found, result.parts, is_measured);
        // A few hulls take more work than most. They get the work that is left.
        how.most_cells = 0;
        for (int round = 0; round < kMeasurements; ++round) {
            std::vector<std::size_t> open;
            for (std::size_t i = 0; i < is_measured.size(); ++i) {
                if (is_measured[i] == 0) open.push_back(i);
            }
            if (open.empty() || most_error_cells(open.size()) <= how.most_cells) break;
            how.most_cells = most_error_cells(open.size());
            const auto measure = [&](std::size_t k) {
                result.parts[open[k]].error =
                    find_hull_error(result.parts[open[k]].hull, solid_, how);
            };
            options_.parallel_for(open.size(), measure);
            for (const std::size_t i : open) {
                const std::size_t cells = result.parts[i].error.cells;
                work_done_ += work_of(result.parts[i].error);
                // find_hull_error() keeps half of the cells for the inside of the hull.
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
    std::vector<ApproximatePart> whole_;
    std::shared_ptr<const Stage> stage_;
    std::optional<Found> exact_;   ///< the fallback if a search for fewer sticks out too far
    std::vector<Estimate> known_;  ///< points far out that parts tried to take in
    std::size_t work_done_ = 0;
    bool ran_out_of_work_ = false;
};

/// Returns an upper bound of the sum of a bound and a growth; the bound itself if that is 0.
double grown_bound(double bound, double by) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return by > 0 ? std::nextafter(bound + by, kInfinity) : bound;
}

/// Brings a part of a search to model units. If rounding adds vertices, the part is enclosed again.
void bring_outwards(ApproximatePart& part, const SearchScale& scale, std::uint32_t max_vertices) {
    OuterHull outer = scale.outwards(part.hull);
    part.hull = std::move(outer.hull);
    part.error = scale.outwards(part.error);
    part.error.upper = grown_bound(part.error.upper, outer.growth);
    if (outer.growth == 0 || max_vertices == 0 || part.hull.points.size() <= max_vertices) return;
    auto few = enclosing_hull(part.hull, std::max(max_vertices, kFewestEnclosingVertices));
    if (!few) return;
    part.hull = std::move(few->hull);
    part.error.upper = grown_bound(part.error.upper, few->distance);
}

/// Searches at another scale. The proof of enclosure stays valid, since hulls only grow.
ApproximateParts find_at_scale(const SearchScale& scale, const mesh::Mesh& mesh,
                               const ApproximateOptions& options) {
    ApproximateOptions how = options;
    if (options.max_error) how.max_error = scale.inwards(*options.max_error);
    ApproximateParts found = PartSearch(scale.inwards(mesh), how).run();
    const auto bring = [&](std::size_t i) {
        bring_outwards(found.parts[i], scale, options.max_vertices);
    };
    options.parallel_for(found.parts.size(), bring);
    found.outer_error = found.outer_lower = 0;
    for (const ApproximatePart& part : found.parts) {
        found.outer_error = std::max(found.outer_error, part.error.upper);
        found.outer_lower = std::max(found.outer_lower, part.error.lower);
    }
    found.is_as_asked = is_request_met(found, options);
    return found;
}

}  // namespace

ApproximateParts find_approximate_parts(const mesh::Mesh& mesh, const ApproximateOptions& options) {
    if (mesh.triangles.empty()) return {};
    const SearchScale scale(mesh.positions);
    return scale.is_needed() ? find_at_scale(scale, mesh, options)
                             : PartSearch(mesh, options).run();
}

}  // namespace cdprep::convex
