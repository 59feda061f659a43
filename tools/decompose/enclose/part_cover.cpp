// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/part_cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

#include "decompose/enclose/separated_points.h"
#include "hull/convex_hull.h"
#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

using Cells = std::vector<std::uint32_t>;

// A number without a reason was chosen by trial. It trades the number of parts against time.
constexpr std::size_t kSeeds = 4;           ///< growths tried for each part
constexpr std::size_t kInVain = 8;          ///< consecutive unwanted cells tried before growth ends
constexpr std::size_t kWorkOfTry = 100;     ///< one cell tried, without tests of kept-out points
constexpr std::size_t kLooksOfWork = 4;     ///< planes and points tested per unit of work
constexpr std::size_t kRegrowths = 2;       ///< attempts to regrow a part that sticks out too far
constexpr std::size_t kGivenUp = 4;         ///< most parts given up in one attempt
constexpr std::size_t kIdle = 3;            ///< rounds without success after which attempts end
constexpr std::size_t kAttemptsAtOnce = 8;  ///< attempts in parallel per round
constexpr std::size_t kTrial = 8;  ///< 1 / share of the work after which is_hopeless() may stop
constexpr double kHopeless = 2;    ///< predicted work, in limits, at which the search stops
/// Of the error: hulls keep out nodes beyond the error less this. A hull that passes between nodes
/// may reach farther out than they are.
constexpr double kNodeMargin = 0.25;
/// Divides a salt, so that the number of parts to give up does not follow from the first of them.
constexpr std::uint64_t kUnrelated = 7;

/// Returns a well mixed number, for choices that vary without randomness: SplitMix64 (Steele, Lea
/// and Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15ULL;
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31U);
}

/// The points that lie farthest along a few directions: a rough hull for quick tests.
class Reach {
public:
    void add(std::span<const Double3> points) {
        for (std::size_t k = 0; k < kDirections.size(); ++k) {
            for (const Double3& p : points) {
                const double height = mesh::dot(kDirections[k], p);
                if (height <= height_[k]) continue;
                height_[k] = height;
                point_[k] = p;
            }
        }
    }

    /// Returns true if the common hull of both contains a point farther from the solid than
    /// `error`. It tests the middles of the segments between their points.
    [[nodiscard]] bool bridges_gap(const Reach& other, const DistanceField& field,
                                   double error) const {
        for (const Double3& p : other.point_) {
            for (const Double3& q : point_) {
                const Double3 middle = {p.x / 2 + q.x / 2, p.y / 2 + q.y / 2, p.z / 2 + q.z / 2};
                if (field.at(middle) > error) return true;
            }
        }
        return false;
    }

private:
    static constexpr std::array<Double3, 8> kDirections = {{{1, 1, 1},
                                                            {-1, -1, -1},
                                                            {-1, 1, 1},
                                                            {1, -1, -1},
                                                            {1, -1, 1},
                                                            {-1, 1, -1},
                                                            {1, 1, -1},
                                                            {-1, -1, 1}}};
    static constexpr double kNone = -std::numeric_limits<double>::infinity();
    std::array<Double3, 8> point_{};
    std::array<double, 8> height_ = {kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone};
};

/// A grown part.
struct Grown {
    Cells cells;                  ///< in the order in which they were added
    std::vector<Estimate> found;  ///< points too far out that it contained earlier
    std::size_t work = 0;
};

class CoverSearch {
public:
    CoverSearch(std::span<const CoverCell> cells, const DistanceField& field,
                const CoverOptions& options)
        : cells_(cells),
          field_(field),
          options_(options),
          far_(field.nodes_beyond((1 - kNodeMargin) * options.error)) {
        for (const Estimate& known : options.known) {
            if (known.distance > options.error) far_.add({&known.at, 1});
        }
        place_cells();
        find_neighbours();
    }

    Cover run() {
        Cover cover;
        cover.parts.assign(options_.begin_with.begin(), options_.begin_with.end());
        if (cover.parts.empty()) {
            Progress all = cover_wanted(std::vector<bool>(cells_.size(), true), cells_.size() + 1,
                                        0, far_, options_.parallel_for);
            work_ = all.work;
            cover.share = all.share;
            found_ = std::move(all.found);
            cover.parts = std::move(all.chosen);
        }
        cover.complete = cover.share >= 1 && work_ <= options_.most_work;
        if (cover.complete) {
            drop_needless(cover.parts);
            improve(cover.parts);
        } else {
            cover.parts.clear();
        }
        cover.found = std::move(found_);
        cover.work = work_;
        return cover;
    }

private:
    void place_cells() {
        for (const CoverCell& cell : cells_) {
            mesh::Box box;
            for (const Double3& p : cell.points) box.add(p);
            const Double3 centre = {box.lower.x / 2 + box.upper.x / 2,
                                    box.lower.y / 2 + box.upper.y / 2,
                                    box.lower.z / 2 + box.upper.z / 2};
            double radius = 0;
            for (const Double3& p : cell.points)
                radius = std::max(radius, mesh::squared_distance(p, centre));
            reach_.emplace_back().add(cell.points);
            centre_.push_back(centre);
            radius_.push_back(std::sqrt(radius));
        }
    }

    /// Finds the neighbours of each cell: cells of the same body whose boxes touch.
    void find_neighbours() {
        neighbours_.resize(cells_.size());
        Cells order(cells_.size());
        std::iota(order.begin(), order.end(), 0U);
        std::sort(order.begin(), order.end(), [this](std::uint32_t a, std::uint32_t b) {
            const double x = cells_[a].box.lower.x;
            const double y = cells_[b].box.lower.x;
            return x != y ? x < y : a < b;
        });
        for (std::size_t i = 0; i < order.size(); ++i) {
            const CoverCell& a = cells_[order[i]];
            for (std::size_t k = i + 1; k < order.size(); ++k) {
                const CoverCell& b = cells_[order[k]];
                if (b.box.lower.x > a.box.upper.x) break;
                if (a.body != b.body || !a.box.meets(b.box)) continue;
                neighbours_[order[i]].push_back(order[k]);
                neighbours_[order[k]].push_back(order[i]);
            }
        }
        for (Cells& list : neighbours_) std::sort(list.begin(), list.end());
    }

    /// Grows a part by one cell after the other, the nearest to the seed first. Wanted cells come
    /// first. When no more of them fit, a few others follow, because wanted cells may lie beyond
    /// them.
    Grown grow(std::uint32_t seed, const std::vector<bool>& wanted,
               const PointGroups& kept_out) const {
        SeparatedPoints hull(kept_out);
        Grown grown;
        std::vector<bool> seen(cells_.size(), false);
        using Next = std::pair<double, std::uint32_t>;
        std::priority_queue<Next, std::vector<Next>, std::greater<>> near;
        std::vector<Next> later;
        const auto see_around = [&](std::uint32_t cell) {
            for (const std::uint32_t other : neighbours_[cell]) {
                if (seen[other]) continue;
                seen[other] = true;
                const Next next{mesh::squared_distance(centre_[other], centre_[seed]), other};
                if (wanted[other]) {
                    near.push(next);
                } else {
                    later.push_back(next);
                }
            }
        };
        seen[seed] = true;
        grown.cells.push_back(seed);
        Reach reach = reach_[seed];
        hull.add(cells_[seed].points, centre_[seed], radius_[seed]);
        see_around(seed);
        std::size_t in_vain = 0;
        while ((!near.empty() || !later.empty()) && in_vain <= kInVain) {
            if (near.empty()) {
                for (const Next& next : later) near.push(next);
                later.clear();
            }
            const std::uint32_t cell = near.top().second;
            near.pop();
            in_vain = wanted[cell] ? 0 : in_vain + 1;
            grown.work += kWorkOfTry;
            if (reach.bridges_gap(reach_[cell], field_, options_.error)) continue;
            if (!hull.add(cells_[cell].points, centre_[cell], radius_[cell])) continue;
            reach.add(cells_[cell].points);
            grown.cells.push_back(cell);
            see_around(cell);
        }
        grown.work += hull.work() / kLooksOfWork;
        return grown;
    }

    [[nodiscard]] Estimate measure(std::span<const std::uint32_t> part, ParallelFor run) const {
        std::vector<Double3> points;
        for (const std::uint32_t cell : part) {
            points.insert(points.end(), cells_[cell].points.begin(), cells_[cell].points.end());
        }
        return field_.estimate(convex_hull(points), options_.error, Detail::fine, run);
    }

    /// Returns a part within the error. A part that exceeds the error is regrown, with the points
    /// that are too far out kept out. If that does not help, its last cells are removed.
    Grown grow_within_error(std::uint32_t seed, const std::vector<bool>& wanted,
                            const PointGroups& far, ParallelFor run) const {
        Grown grown = grow(seed, wanted, far);
        std::vector<Estimate> found;
        PointGroups kept_out(&far);
        std::size_t work = grown.work;
        for (std::size_t i = 0; grown.cells.size() > 1; ++i) {
            const Estimate error = measure(grown.cells, run);
            work += error.samples * kWorkOfSample;
            if (error.distance <= options_.error) break;
            if (i == kRegrowths) {
                work += give_up_last(grown.cells, run);
                break;
            }
            kept_out.add({&error.at, 1});
            found.push_back(error);
            grown = grow(seed, wanted, kept_out);
            work += grown.work;
        }
        grown.found = std::move(found);
        grown.work = work;
        return grown;
    }

    /// Removes the last cells by bisection: if a prefix sticks out too far, so does a longer one.
    /// Returns the work.
    std::size_t give_up_last(Cells& cells, ParallelFor run) const {
        std::size_t good = 1;
        std::size_t bad = cells.size();
        std::size_t work = 0;
        while (good + 1 < bad) {
            const std::size_t middle = (good + bad) / 2;
            const Estimate error = measure(std::span(cells).first(middle), run);
            work += error.samples * kWorkOfSample;
            (error.distance <= options_.error ? good : bad) = middle;
        }
        cells.resize(good);
        return work;
    }

    /// Returns wanted cells far from each other. `salt` selects the first.
    [[nodiscard]] Cells choose_seeds(const std::vector<bool>& wanted, std::size_t count,
                                     std::uint64_t salt) const {
        Cells list;
        for (std::uint32_t i = 0; i < wanted.size(); ++i) {
            if (wanted[i]) list.push_back(i);
        }
        if (list.size() <= count) return list;
        Cells seeds = {list[mixed(salt) % list.size()]};
        std::vector<double> apart(list.size(), std::numeric_limits<double>::infinity());
        // The first cell is only a start: the cell farthest from it lies at an end.
        while (seeds.size() <= count) {
            std::size_t farthest = 0;
            for (std::size_t i = 0; i < list.size(); ++i) {
                apart[i] = std::min(
                    apart[i], mesh::squared_distance(centre_[list[i]], centre_[seeds.back()]));
                if (apart[i] > apart[farthest]) farthest = i;
            }
            seeds.push_back(list[farthest]);
        }
        seeds.erase(seeds.begin());
        return seeds;
    }

    /// Returns the index of the part that takes in most wanted cells.
    static std::size_t find_best(const std::vector<Grown>& pool, const std::vector<bool>& wanted) {
        std::size_t best = 0;
        std::ptrdiff_t most = 0;
        for (std::size_t i = 0; i < pool.size(); ++i) {
            const auto gain = std::count_if(pool[i].cells.begin(), pool[i].cells.end(),
                                            [&](std::uint32_t cell) { return wanted[cell]; });
            if (gain <= most) continue;
            most = gain;
            best = i;
        }
        return best;
    }

    /// The state of a cover of some cells.
    struct Progress {
        std::vector<Cells> chosen;
        std::vector<Estimate> found;
        std::size_t work = 0;
        double share = 1;  ///< of the wanted cells that were taken in
    };

    /// Returns true if the work for the cells taken so far predicts that the limit will not
    /// suffice. The first parts take in more cells than the last ones.
    [[nodiscard]] bool is_hopeless(std::size_t work, std::size_t taken, std::size_t all) const {
        if (work <= options_.most_work / kTrial) return false;
        return static_cast<double>(work) * static_cast<double>(all) >
               kHopeless * static_cast<double>(options_.most_work) * static_cast<double>(taken);
    }

    /// Returns parts that take in all wanted cells. Returns more than `limit` parts if `limit`
    /// are not enough.
    Progress cover_wanted(std::vector<bool> wanted, std::size_t limit, std::uint64_t salt,
                          PointGroups& far, ParallelFor run) const {
        Progress progress;
        std::vector<Grown> pool;
        const auto all = static_cast<std::size_t>(std::count(wanted.begin(), wanted.end(), true));
        std::size_t left = all;
        while (left > 0 && progress.chosen.size() < limit &&
               work_ + progress.work <= options_.most_work &&
               !is_hopeless(progress.work, all - left, all)) {
            const Cells seeds = choose_seeds(wanted, kSeeds, salt + progress.chosen.size());
            progress.work += kSeeds * left / kLooksOfWork;
            std::vector<Grown> grown(seeds.size());
            const auto grow_one = [&](std::size_t i) {
                grown[i] = grow_within_error(seeds[i], wanted, far, run);
            };
            run(seeds.size(), grow_one);
            for (Grown& one : grown) {
                progress.work += one.work;
                for (const Estimate& error : one.found) far.add({&error.at, 1});
                progress.found.insert(progress.found.end(), one.found.begin(), one.found.end());
                pool.push_back(std::move(one));
            }
            for (const Grown& one : pool) progress.work += one.cells.size() / kLooksOfWork;
            const std::size_t best = find_best(pool, wanted);
            for (const std::uint32_t cell : pool[best].cells) {
                if (!wanted[cell]) continue;
                wanted[cell] = false;
                --left;
            }
            progress.chosen.push_back(std::move(pool[best].cells));
            std::sort(progress.chosen.back().begin(), progress.chosen.back().end());
            pool.erase(pool.begin() + static_cast<std::ptrdiff_t>(best));
        }
        if (left > 0) progress.chosen.resize(limit + 1);  // not enough
        progress.share =
            1 - static_cast<double>(left) / static_cast<double>(std::max<std::size_t>(all, 1));
        return progress;
    }

    [[nodiscard]] std::vector<std::uint32_t> count_uses(const std::vector<Cells>& parts) const {
        std::vector<std::uint32_t> uses(cells_.size(), 0);
        for (const Cells& part : parts) {
            for (const std::uint32_t cell : part) ++uses[cell];
        }
        return uses;
    }

    /// Removes parts whose cells are all in others, the smallest first.
    void drop_needless(std::vector<Cells>& parts) const {
        std::sort(parts.begin(), parts.end(), [](const Cells& a, const Cells& b) {
            return a.size() != b.size() ? a.size() < b.size() : a < b;
        });
        std::vector<std::uint32_t> uses = count_uses(parts);
        std::vector<Cells> kept;
        for (Cells& part : parts) {
            const bool needless = std::all_of(part.begin(), part.end(),
                                              [&](std::uint32_t cell) { return uses[cell] > 1; });
            if (!needless) {
                kept.push_back(std::move(part));
                continue;
            }
            for (const std::uint32_t cell : part) --uses[cell];
        }
        parts = std::move(kept);
    }

    /// Returns the part `of` and the parts whose mean cell centres are nearest to its own.
    [[nodiscard]] std::vector<std::size_t> neighbourhood(const std::vector<Cells>& parts,
                                                         std::size_t of, std::size_t count) const {
        std::vector<std::pair<double, std::size_t>> order;
        std::vector<Double3> middle;
        for (const Cells& part : parts) {
            Double3 sum = {0, 0, 0};
            const double share = 1.0 / static_cast<double>(part.size());
            for (const std::uint32_t cell : part) {
                sum = {sum.x + centre_[cell].x * share, sum.y + centre_[cell].y * share,
                       sum.z + centre_[cell].z * share};
            }
            middle.push_back(sum);
        }
        for (std::size_t i = 0; i < parts.size(); ++i) {
            order.emplace_back(i == of ? -1.0 : mesh::squared_distance(middle[i], middle[of]), i);
        }
        std::sort(order.begin(), order.end());
        std::vector<std::size_t> chosen;
        for (std::size_t i = 0; i < std::min(count, order.size()); ++i) {
            chosen.push_back(order[i].second);
        }
        return chosen;
    }

    /// Gives up neighbouring parts and covers the cells that only they contain again, in rounds.
    /// All attempts of a round start from the same parts. The first one that ends with fewer is
    /// used.
    void improve(std::vector<Cells>& parts) {
        std::size_t idle = 0;
        for (std::size_t round = 0; round < options_.rounds && idle < kIdle; ++round) {
            if (parts.size() <= std::max<std::size_t>(options_.few_enough, 1)) return;
            if (work_ > options_.most_work) return;
            const std::vector<std::uint32_t> uses = count_uses(parts);
            std::vector<Progress> tried(kAttemptsAtOnce);
            const auto attempt = [&](std::size_t i) {
                tried[i] = try_fewer(parts, uses, round * kAttemptsAtOnce + i);
            };
            options_.parallel_for(kAttemptsAtOnce, attempt);
            for (const Progress& one : tried) {
                work_ += one.work;
                for (const Estimate& error : one.found) far_.add({&error.at, 1});
                found_.insert(found_.end(), one.found.begin(), one.found.end());
            }
            const auto best = std::find_if(tried.begin(), tried.end(),
                                           [](const Progress& one) { return !one.chosen.empty(); });
            ++idle;
            if (best == tried.end()) continue;
            idle = 0;
            parts = std::move(best->chosen);
            drop_needless(parts);
        }
    }

    /// Returns all parts if they are fewer than before, else none.
    Progress try_fewer(const std::vector<Cells>& parts, std::vector<std::uint32_t> uses,
                       std::size_t number) const {
        const std::uint64_t salt = mixed(number);
        const std::size_t count = 2 + salt / kUnrelated % (kGivenUp - 1);
        const auto given_up = neighbourhood(parts, salt % parts.size(), count);
        for (const std::size_t i : given_up) {
            for (const std::uint32_t cell : parts[i]) --uses[cell];
        }
        std::vector<bool> wanted(cells_.size(), false);
        for (const std::size_t i : given_up) {
            for (const std::uint32_t cell : parts[i]) wanted[cell] = uses[cell] == 0;
        }
        PointGroups far(&far_);
        Progress fresh =
            cover_wanted(std::move(wanted), given_up.size() - 1, salt, far, serial_for);
        if (fresh.chosen.size() >= given_up.size()) {
            fresh.chosen.clear();
            return fresh;
        }
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (std::find(given_up.begin(), given_up.end(), i) == given_up.end()) {
                fresh.chosen.push_back(parts[i]);
            }
        }
        return fresh;
    }

    std::span<const CoverCell> cells_;
    const DistanceField& field_;
    const CoverOptions& options_;
    PointGroups far_;
    std::vector<Estimate> found_;
    std::vector<Reach> reach_;
    std::vector<Double3> centre_;
    std::vector<double> radius_;
    std::vector<Cells> neighbours_;
    std::size_t work_ = 0;
};

}  // namespace

Cover cover_with_parts(std::span<const CoverCell> cells, const DistanceField& field,
                       const CoverOptions& options) {
    return CoverSearch(cells, field, options).run();
}

}  // namespace cdprep::convex
