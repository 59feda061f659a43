// SPDX-License-Identifier: GPL-3.0-or-later
#include "convex/piece_cover.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

#include "convex/convex_hull.h"
#include "convex/separated_points.h"
#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

using Cells = std::vector<std::uint32_t>;

constexpr std::size_t kSeeds = 8;        ///< growths tried for each piece
constexpr std::size_t kWorkOfTry = 500;  ///< besides looking at each group that is kept out
constexpr std::size_t kRegrowths = 2;    ///< of one that sticks out too far
constexpr std::size_t kGivenUp = 4;      ///< pieces that are given up together, at most
constexpr std::size_t kIdle = 3;         ///< rounds of such attempts without success: the last
constexpr std::size_t kAtOnce = 8;       ///< such attempts, side by side

double squared(const Double3& a, const Double3& b) {
    const Double3 ab = mesh::minus(a, b);
    return mesh::dot(ab, ab);
}

/// A well mixed number: choices that are varied without chance.
std::uint64_t mixed(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15ULL;
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31U);
}

/// A piece as it grew.
struct Grown {
    Cells cells;           ///< in the order in which they were taken in
    bool settled = false;  ///< measured
    std::size_t work = 0;
};

class CoverSearch {
public:
    CoverSearch(std::span<const CoverCell> cells, const DistanceField& field,
                const CoverOptions& options)
        : cells_(cells),
          field_(field),
          options_(options),
          far_(field.nodes_beyond((1 - options.margin) * options.error)) {
        place_cells();
        find_neighbours();
    }

    Cover run() {
        std::vector<bool> wanted(cells_.size(), true);
        Cover cover;
        cover.pieces = cover_wanted(wanted, cells_.size() + 1, 0, true, work_);
        cover.complete = work_ <= options_.most_work;
        cover.work = work_;
        if (!cover.complete) {
            cover.pieces.clear();
            return cover;
        }
        drop_needless(cover.pieces);
        improve(cover.pieces);
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
            for (const Double3& p : cell.points) radius = std::max(radius, squared(p, centre));
            centre_.push_back(centre);
            radius_.push_back(std::sqrt(radius));
        }
    }

    /// Cells of one body whose boxes touch.
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

    /// Takes in one cell after the other, the nearest to the seed first: those that are
    /// wanted, and when no more of them goes in, any.
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
                const Next next{squared(centre_[other], centre_[seed]), other};
                if (wanted[other]) {
                    near.push(next);
                } else {
                    later.push_back(next);
                }
            }
        };
        seen[seed] = true;
        grown.cells.push_back(seed);
        hull.add(cells_[seed].points, centre_[seed], radius_[seed]);
        see_around(seed);
        while (!near.empty() || !later.empty()) {
            if (near.empty()) {
                for (const Next& next : later) near.push(next);
                later.clear();
            }
            const std::uint32_t cell = near.top().second;
            near.pop();
            grown.work += kWorkOfTry + kept_out.groups().size();
            if (!hull.add(cells_[cell].points, centre_[cell], radius_[cell])) continue;
            grown.cells.push_back(cell);
            see_around(cell);
        }
        return grown;
    }

    [[nodiscard]] Estimate measure(std::span<const std::uint32_t> piece) const {
        std::vector<Double3> points;
        for (const std::uint32_t cell : piece) {
            points.insert(points.end(), cells_[cell].points.begin(), cells_[cell].points.end());
        }
        return field_.estimate(convex_hull(points));
    }

    /// Sees to it that a piece is within the error: grows it anew with points kept out that
    /// it had taken in; and gives up what it took in last where that does not help. Returns
    /// the work that it took.
    std::size_t settle(Grown& grown, const std::vector<bool>& wanted, PointGroups& kept_out) {
        grown.settled = true;
        std::size_t work = 0;
        for (std::size_t i = 0; grown.cells.size() > 1; ++i) {
            const Estimate error = measure(grown.cells);
            if (error.distance <= options_.error) return work;
            kept_out.add({&error.at, 1});
            if (i == kRegrowths) break;
            grown = grow(grown.cells.front(), wanted, kept_out);
            grown.settled = true;
            work += grown.work;
        }
        std::size_t good = 1;
        std::size_t bad = grown.cells.size();
        while (good + 1 < bad) {
            const std::size_t middle = (good + bad) / 2;
            const bool is_good =
                measure(std::span(grown.cells).first(middle)).distance <= options_.error;
            (is_good ? good : bad) = middle;
        }
        grown.cells.resize(good);
        return work;
    }

    /// Wanted cells far from each other, the first one by `salt`.
    [[nodiscard]] Cells choose_seeds(const std::vector<bool>& wanted, std::size_t count,
                                     std::uint64_t salt) const {
        Cells list;
        for (std::uint32_t i = 0; i < wanted.size(); ++i) {
            if (wanted[i]) list.push_back(i);
        }
        if (list.size() <= count) return list;
        Cells seeds = {list[mixed(salt) % list.size()]};
        std::vector<double> apart(list.size(), std::numeric_limits<double>::infinity());
        // The first is only where to begin: what is far from it lies at an end.
        while (seeds.size() <= count) {
            std::size_t farthest = 0;
            for (std::size_t i = 0; i < list.size(); ++i) {
                apart[i] = std::min(apart[i], squared(centre_[list[i]], centre_[seeds.back()]));
                if (apart[i] > apart[farthest]) farthest = i;
            }
            seeds.push_back(list[farthest]);
        }
        seeds.erase(seeds.begin());
        return seeds;
    }

    /// The number of the one that takes in most of what is wanted, and is within the error.
    std::size_t take_best(std::vector<Grown>& pool, const std::vector<bool>& wanted,
                          bool in_parallel, std::size_t& work) {
        for (;;) {
            std::size_t best = 0;
            std::size_t most = 0;
            for (std::size_t i = 0; i < pool.size(); ++i) {
                const auto gain = static_cast<std::size_t>(
                    std::count_if(pool[i].cells.begin(), pool[i].cells.end(),
                                  [&](std::uint32_t cell) { return wanted[cell]; }));
                if (gain > most) {
                    most = gain;
                    best = i;
                }
            }
            if (pool[best].settled || !in_parallel) return best;
            work += settle(pool[best], wanted, far_);
        }
    }

    /// Pieces that take in all cells that are wanted, or `limit` of them when that is not
    /// enough.
    std::vector<Cells> cover_wanted(std::vector<bool> wanted, std::size_t limit, std::uint64_t salt,
                                    bool in_parallel, std::size_t& work) {
        std::vector<Cells> chosen;
        std::vector<Grown> pool;
        std::size_t left = static_cast<std::size_t>(std::count(wanted.begin(), wanted.end(), true));
        while (left > 0 && chosen.size() < limit && work <= options_.most_work) {
            const Cells seeds =
                choose_seeds(wanted, in_parallel ? kSeeds : kSeeds / 2, salt + chosen.size());
            std::vector<Grown> grown(seeds.size());
            const auto grow_one = [&](std::size_t i) { grown[i] = grow(seeds[i], wanted, far_); };
            if (in_parallel) {
                options_.parallel_for(seeds.size(), grow_one);
            } else {
                serial_for(seeds.size(), grow_one);
            }
            for (Grown& one : grown) {
                work += one.work;
                pool.push_back(std::move(one));
            }
            const std::size_t best = take_best(pool, wanted, in_parallel, work);
            for (const std::uint32_t cell : pool[best].cells) {
                if (!wanted[cell]) continue;
                wanted[cell] = false;
                --left;
            }
            chosen.push_back(std::move(pool[best].cells));
            std::sort(chosen.back().begin(), chosen.back().end());
            pool.erase(pool.begin() + static_cast<std::ptrdiff_t>(best));
        }
        if (left > 0) chosen.resize(limit + 1);  // not enough
        return chosen;
    }

    [[nodiscard]] std::vector<std::uint32_t> count_uses(const std::vector<Cells>& pieces) const {
        std::vector<std::uint32_t> uses(cells_.size(), 0);
        for (const Cells& piece : pieces) {
            for (const std::uint32_t cell : piece) ++uses[cell];
        }
        return uses;
    }

    /// The smallest first: those all of whose cells are in others.
    void drop_needless(std::vector<Cells>& pieces) const {
        std::sort(pieces.begin(), pieces.end(), [](const Cells& a, const Cells& b) {
            return a.size() != b.size() ? a.size() < b.size() : a < b;
        });
        std::vector<std::uint32_t> uses = count_uses(pieces);
        std::vector<Cells> kept;
        for (Cells& piece : pieces) {
            const bool needless = std::all_of(piece.begin(), piece.end(),
                                              [&](std::uint32_t cell) { return uses[cell] > 1; });
            if (!needless) {
                kept.push_back(std::move(piece));
                continue;
            }
            for (const std::uint32_t cell : piece) --uses[cell];
        }
        pieces = std::move(kept);
    }

    /// The piece and those that reach nearest to what it alone takes in.
    [[nodiscard]] std::vector<std::size_t> neighbourhood(const std::vector<Cells>& pieces,
                                                         std::size_t of, std::size_t count) const {
        std::vector<std::pair<double, std::size_t>> order;
        std::vector<Double3> middle;
        for (const Cells& piece : pieces) {
            Double3 sum = {0, 0, 0};
            const double share = 1.0 / static_cast<double>(piece.size());
            for (const std::uint32_t cell : piece) {
                sum = {sum.x + centre_[cell].x * share, sum.y + centre_[cell].y * share,
                       sum.z + centre_[cell].z * share};
            }
            middle.push_back(sum);
        }
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            order.emplace_back(i == of ? -1.0 : squared(middle[i], middle[of]), i);
        }
        std::sort(order.begin(), order.end());
        std::vector<std::size_t> chosen;
        for (std::size_t i = 0; i < std::min(count, order.size()); ++i) {
            chosen.push_back(order[i].second);
        }
        return chosen;
    }

    /// Gives neighbouring pieces up and covers what they alone took in anew, again and
    /// again; attempts of one round begin with the same pieces, the first that does with
    /// fewer is taken.
    void improve(std::vector<Cells>& pieces) {
        std::size_t idle = 0;
        for (std::size_t round = 0; round < options_.rounds && idle < kIdle; ++round) {
            if (pieces.size() <= std::max<std::size_t>(options_.few_enough, 1)) return;
            if (work_ > options_.most_work) return;
            const std::vector<std::uint32_t> uses = count_uses(pieces);
            std::vector<std::vector<Cells>> better(kAtOnce);
            std::vector<std::size_t> work(kAtOnce, 0);
            const auto attempt = [&](std::size_t i) {
                better[i] = try_fewer(pieces, uses, round * kAtOnce + i, work[i]);
            };
            options_.parallel_for(kAtOnce, attempt);
            work_ = std::accumulate(work.begin(), work.end(), work_);
            const auto best = std::find_if(better.begin(), better.end(), [this](auto& list) {
                return !list.empty() && is_within_error(list);
            });
            ++idle;
            if (best == better.end()) continue;
            idle = 0;
            pieces = std::move(*best);
            drop_needless(pieces);
        }
    }

    /// What was not there before stands at the front of the list; points that it should keep
    /// out are remembered.
    bool is_within_error(const std::vector<Cells>& pieces) {
        for (std::size_t i = 0; i < std::min(pieces.size(), kGivenUp); ++i) {
            if (pieces[i].size() < 2) continue;
            const Estimate error = measure(pieces[i]);
            if (error.distance <= options_.error) continue;
            far_.add({&error.at, 1});
            return false;
        }
        return true;
    }

    /// All pieces, fewer than before, or as many that take in more; or nothing.
    std::vector<Cells> try_fewer(const std::vector<Cells>& pieces, std::vector<std::uint32_t> uses,
                                 std::size_t number, std::size_t& work) {
        const std::uint64_t salt = mixed(number);
        const std::size_t count = 2 + salt / 7 % (kGivenUp - 1);
        const auto given_up = neighbourhood(pieces, salt % pieces.size(), count);
        for (const std::size_t i : given_up) {
            for (const std::uint32_t cell : pieces[i]) --uses[cell];
        }
        std::vector<bool> wanted(cells_.size(), false);
        for (const std::size_t i : given_up) {
            for (const std::uint32_t cell : pieces[i]) wanted[cell] = uses[cell] == 0;
        }
        std::vector<Cells> fresh = cover_wanted(wanted, given_up.size() - 1, salt, false, work);
        if (fresh.size() >= given_up.size()) return {};
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            if (std::find(given_up.begin(), given_up.end(), i) == given_up.end()) {
                fresh.push_back(pieces[i]);
            }
        }
        return fresh;
    }

    std::span<const CoverCell> cells_;
    const DistanceField& field_;
    const CoverOptions& options_;
    PointGroups far_;
    std::vector<Double3> centre_;
    std::vector<double> radius_;
    std::vector<Cells> neighbours_;
    std::size_t work_ = 0;
};

}  // namespace

Cover cover_with_pieces(std::span<const CoverCell> cells, const DistanceField& field,
                        const CoverOptions& options) {
    return CoverSearch(cells, field, options).run();
}

}  // namespace cdprep::convex
