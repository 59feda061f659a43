// SPDX-License-Identifier: GPL-3.0-or-later
#include "convex/solid_cells.h"

#include <CGAL/Interval_nt.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "convex/convex_hull.h"

namespace cdprep::convex {
namespace {

using mesh::Box;
using Axis = double Double3::*;
using Interval = CGAL::Interval_nt<true>;

constexpr std::array<Axis, 3> kAxes = {&Double3::x, &Double3::y, &Double3::z};
constexpr double kSmallest = 0.125;        ///< of the size: cells are not cut beyond
constexpr double kUncut = 0.25;            ///< triangles this small against a cell are not cut
constexpr double kNearMiddle = 0.25;       ///< of a side: how far from its middle a cut may be
constexpr std::size_t kChunk = 1U << 14U;  ///< fragments that are looked at in one go
constexpr std::uint32_t kSharing = 3;      ///< vertices with one coordinate that attract a cut

/// A box that is still to be cut.
struct Open {
    Box box;
    std::vector<std::uint32_t> fragments;
};

double longest_side(const Box& box) {
    return std::max(
        {box.upper.x - box.lower.x, box.upper.y - box.lower.y, box.upper.z - box.lower.z});
}

Axis longest_axis(const Box& box) {
    Axis longest = kAxes[0];
    for (const Axis axis : kAxes) {
        if (box.upper.*axis - box.lower.*axis > box.upper.*longest - box.lower.*longest) {
            longest = axis;
        }
    }
    return longest;
}

Interval between(const Place& place, Axis axis) {
    return {place.lower.*axis, place.upper.*axis};
}

/// Where the segment between two places meets the plane at which its axis is c.
Place cut_segment(const Place& from, const Place& to, Axis across, double c) {
    const Interval start = between(from, across);
    const Interval share = (Interval(c) - start) / (between(to, across) - start);
    Place cut;
    for (const Axis axis : kAxes) {
        const Interval a = between(from, axis);
        const Interval b = between(to, axis);
        const Interval at = a + share * (b - a);
        // The segment does not leave its ends' box, whatever rounding says.
        cut.lower.*axis = std::max(at.inf(), std::min(a.inf(), b.inf()));
        cut.upper.*axis = std::min(at.sup(), std::max(a.sup(), b.sup()));
    }
    cut.lower.*across = c;
    cut.upper.*across = c;
    return cut;
}

class CellCutter {
public:
    CellCutter(const mesh::Mesh& mesh, const Solid& solid, const DistanceField& field,
               const SolidCellOptions& options)
        : solid_(solid), field_(field), options_(options) {
        for (const Double3& p : mesh.positions) cells_.places.push_back({p, p});
        cells_.fragments.reserve(mesh.triangles.size());
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            cells_.fragments.push_back({mesh.triangles[i].vertex, i});
        }
        cells_.fragment_count.assign(mesh.triangles.size(), 1);
        find_shared_coordinates(mesh);
    }

    SolidCells run() {
        Open all{solid_.tree().box(), {}};
        for (std::uint32_t i = 0; i < cells_.fragments.size(); ++i) all.fragments.push_back(i);
        std::vector<Open> level;
        level.push_back(std::move(all));
        while (!level.empty()) level = cut_level(std::move(level));
        add_corners();
        return std::move(cells_);
    }

private:
    /// Coordinates that several vertices have, ascending.
    void find_shared_coordinates(const mesh::Mesh& mesh) {
        std::vector<double> values(mesh.positions.size());
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t i = 0; i < values.size(); ++i) values[i] = mesh.positions[i].*kAxes[k];
            std::sort(values.begin(), values.end());
            for (std::size_t i = 0; i + 1 < values.size();) {
                std::size_t end = i;
                while (end < values.size() && values[end] == values[i]) ++end;
                if (end - i >= kSharing) shared_[k].push_back(values[i]);
                i = end;
            }
        }
    }

    [[nodiscard]] double choose_cut(const Box& box, Axis axis) const {
        const double middle = box.lower.*axis / 2 + box.upper.*axis / 2;
        const double reach = kNearMiddle * (box.upper.*axis - box.lower.*axis);
        const std::size_t k = axis == kAxes[0] ? 0 : axis == kAxes[1] ? 1 : 2;
        const auto above = std::lower_bound(shared_[k].begin(), shared_[k].end(), middle);
        double best = middle;
        double least = reach;
        for (const auto at : {above, above == shared_[k].begin() ? above : above - 1}) {
            if (at == shared_[k].end() || std::fabs(*at - middle) > least) continue;
            best = *at;
            least = std::fabs(*at - middle);
        }
        return best;
    }

    std::vector<Open> cut_level(std::vector<Open> level) {
        const bool is_full = cells_.cells.size() + 2 * level.size() > options_.most_cells;
        std::vector<std::uint8_t> is_done(level.size());
        const auto look = [&](std::size_t i) { is_done[i] = is_small_enough(level[i]) ? 1 : 0; };
        options_.parallel_for(level.size(), look);
        std::vector<Cut> cuts;
        for (std::size_t i = 0; i < level.size(); ++i) {
            const Box& box = level[i].box;
            const Axis axis = longest_axis(box);
            const double at = choose_cut(box, axis);
            const bool has_room = at > box.lower.*axis && at < box.upper.*axis;
            if (is_done[i] != 0 || is_full || !has_room) {
                close(level[i]);
            } else {
                cuts.push_back({&level[i], axis, at});
            }
        }
        return share_all(cuts);
    }

    /// A box that is cut in two.
    struct Cut {
        const Open* open;
        Axis axis;
        double at;
    };
    /// Some of its fragments, by the sides on which they are.
    struct Shared {
        std::size_t cut;
        std::size_t first;
        std::vector<std::uint32_t> below, above, across;
    };

    /// The two halves of each box. Fragments are looked at side by side, many boxes or many
    /// parts of one; those that are cut themselves get their numbers one after the other.
    std::vector<Open> share_all(std::span<const Cut> cuts) {
        std::vector<Shared> shares;
        for (std::size_t i = 0; i < cuts.size(); ++i) {
            const std::size_t count = cuts[i].open->fragments.size();
            for (std::size_t first = 0; first < count; first += kChunk) {
                shares.push_back({i, first, {}, {}, {}});
            }
        }
        const auto look = [&](std::size_t i) { share(cuts[shares[i].cut], shares[i]); };
        options_.parallel_for(shares.size(), look);
        std::vector<Open> halves;
        for (const Cut& cut : cuts) {
            halves.push_back({cut.open->box, {}});
            halves.back().box.upper.*cut.axis = cut.at;
            halves.push_back({cut.open->box, {}});
            halves.back().box.lower.*cut.axis = cut.at;
        }
        for (const Shared& shared : shares) {
            const Cut& cut = cuts[shared.cut];
            Open& below = halves[2 * shared.cut];
            Open& above = halves[2 * shared.cut + 1];
            below.fragments.insert(below.fragments.end(), shared.below.begin(), shared.below.end());
            above.fragments.insert(above.fragments.end(), shared.above.begin(), shared.above.end());
            for (const std::uint32_t number : shared.across) {
                cut_fragment(number, cut.axis, cut.at, below, above);
            }
        }
        return halves;
    }

    [[nodiscard]] bool is_small_enough(const Open& open) const {
        const double side = longest_side(open.box);
        // Boxes without surface may be twice as large: nothing of a hull ends there.
        if (open.fragments.empty()) {
            return side <= 2 * options_.size || !solid_.includes(centre(open.box));
        }
        if (side > options_.size) return false;
        if (side <= options_.size * kSmallest) return true;
        std::vector<std::uint32_t> places;
        for (const std::uint32_t fragment : open.fragments) {
            const auto& of_fragment = cells_.fragments[fragment].place;
            places.insert(places.end(), of_fragment.begin(), of_fragment.end());
        }
        std::sort(places.begin(), places.end());
        places.erase(std::unique(places.begin(), places.end()), places.end());
        std::vector<Double3> points;
        points.reserve(places.size());
        for (const std::uint32_t place : places) points.push_back(cells_.places[place].lower);
        return field_.estimate(convex_hull(points), options_.error, Detail::coarse).distance <=
               options_.error;
    }

    static Double3 centre(const Box& box) {
        return {box.lower.x / 2 + box.upper.x / 2, box.lower.y / 2 + box.upper.y / 2,
                box.lower.z / 2 + box.upper.z / 2};
    }

    /// Hands fragments to the boxes on either side of a cut; large ones across it are left.
    void share(const Cut& cut, Shared& shared) const {
        Box half = cut.open->box;
        half.upper.*cut.axis = cut.at;
        const double uncut_side = kUncut * longest_side(half);
        const auto& all = cut.open->fragments;
        const std::size_t end = std::min(shared.first + kChunk, all.size());
        for (std::size_t i = shared.first; i < end; ++i) {
            const std::uint32_t number = all[i];
            Box around;
            int lower = 0;
            int upper = 0;
            int unclear = 0;
            for (const std::uint32_t place : cells_.fragments[number].place) {
                const Place& p = cells_.places[place];
                around.add(p.lower);
                around.add(p.upper);
                lower += p.upper.*cut.axis <= cut.at ? 1 : 0;
                upper += p.lower.*cut.axis >= cut.at ? 1 : 0;
                unclear += p.lower.*cut.axis < cut.at && p.upper.*cut.axis > cut.at ? 1 : 0;
            }
            const bool is_one_sided = lower == 3 || upper == 3;
            const bool is_uncut = unclear > 0 || longest_side(around) <= uncut_side;
            if (lower == 3 || (!is_one_sided && is_uncut)) shared.below.push_back(number);
            if (upper == 3 || (!is_one_sided && is_uncut)) shared.above.push_back(number);
            if (!is_one_sided && !is_uncut) shared.across.push_back(number);
        }
    }

    std::uint32_t add_place(const Place& place) {
        cells_.places.push_back(place);
        return static_cast<std::uint32_t>(cells_.places.size() - 1);
    }

    /// A side at a time: the corners on it and where the edges cross, as a fan.
    void cut_fragment(std::uint32_t number, Axis axis, double at, Open& below, Open& above) {
        const Fragment fragment = cells_.fragments[number];
        std::vector<std::uint32_t> low;
        std::vector<std::uint32_t> high;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = fragment.place[k];
            const std::uint32_t to = fragment.place[(k + 1) % 3];
            const Place a = cells_.places[from];
            const Place b = cells_.places[to];
            const bool is_low = a.upper.*axis <= at;
            const bool is_high = a.lower.*axis >= at;
            if (is_low) low.push_back(from);
            if (is_high) high.push_back(from);
            const bool crosses = (a.upper.*axis < at && b.lower.*axis > at) ||
                                 (a.lower.*axis > at && b.upper.*axis < at);
            if (!crosses) continue;
            // From the lower end, whichever triangle asks.
            const bool upwards = a.upper.*axis < at;
            const std::uint32_t met =
                add_place(upwards ? cut_segment(a, b, axis, at) : cut_segment(b, a, axis, at));
            low.push_back(met);
            high.push_back(met);
        }
        std::uint32_t made = 0;
        for (const auto& [polygon, side] : {std::pair(&low, &below), std::pair(&high, &above)}) {
            for (std::size_t k = 2; k < polygon->size(); ++k) {
                const Fragment part = {{(*polygon)[0], (*polygon)[k - 1], (*polygon)[k]},
                                       fragment.triangle};
                std::uint32_t part_number = number;
                if (made++ == 0) {
                    cells_.fragments[number] = part;
                } else {
                    part_number = static_cast<std::uint32_t>(cells_.fragments.size());
                    cells_.fragments.push_back(part);
                }
                side->fragments.push_back(part_number);
            }
        }
        cells_.fragment_count[fragment.triangle] += made - 1;
    }

    /// One cell for each body that has a part in the box.
    void close(const Open& open) {
        std::vector<std::uint32_t> bodies = solid_.bodies_around(centre(open.box));
        for (const std::uint32_t fragment : open.fragments) {
            const std::uint32_t body = solid_.body_of(cells_.fragments[fragment].triangle);
            if (bodies.empty() || bodies.back() != body) bodies.push_back(body);
        }
        std::sort(bodies.begin(), bodies.end());
        bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
        for (const std::uint32_t body : bodies) {
            SolidCell cell{open.box, body, {}, {}};
            for (const std::uint32_t fragment : open.fragments) {
                if (solid_.body_of(cells_.fragments[fragment].triangle) == body) {
                    cell.fragments.push_back(fragment);
                }
            }
            cells_.cells.push_back(std::move(cell));
        }
    }

    void add_corners() {
        if (!solid_.encloses()) return;
        const auto add = [this](std::size_t number) {
            SolidCell& cell = cells_.cells[number];
            for (unsigned k = 0; k < 8; ++k) {
                const Double3 corner = {(k & 1U) == 0 ? cell.box.lower.x : cell.box.upper.x,
                                        (k & 2U) == 0 ? cell.box.lower.y : cell.box.upper.y,
                                        (k & 4U) == 0 ? cell.box.lower.z : cell.box.upper.z};
                const auto around = solid_.bodies_around(corner);
                if (std::binary_search(around.begin(), around.end(), cell.body)) {
                    cell.corners.push_back(corner);
                }
            }
        };
        options_.parallel_for(cells_.cells.size(), add);
    }

    const Solid& solid_;
    const DistanceField& field_;
    const SolidCellOptions& options_;
    SolidCells cells_;
    std::array<std::vector<double>, 3> shared_;
};

}  // namespace

SolidCells cut_into_cells(const mesh::Mesh& mesh, const Solid& solid, const DistanceField& field,
                          const SolidCellOptions& options) {
    return CellCutter(mesh, solid, field, options).run();
}

}  // namespace cdprep::convex
