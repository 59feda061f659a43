// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/solid_cells.h"

#include <CGAL/Interval_nt.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "hull/convex_hull.h"

namespace cdprep::convex {
namespace {

using mesh::Box;
using Axis = double Double3::*;
using Interval = CGAL::Interval_nt<true>;

constexpr std::array<Axis, 3> kAxes = {&Double3::x, &Double3::y, &Double3::z};
// Chosen by trial: more and smaller cells follow the surface more closely, and take more time.
constexpr double kSmallest = 0.125;        ///< of the size: smaller cells are not cut
constexpr double kUncut = 0.125;           ///< of a cell: triangles this small are not cut
constexpr double kNearMiddle = 0.25;       ///< of a side: how far from its middle a cut may be
constexpr std::size_t kChunk = 1U << 14U;  ///< fragments per task: changes no result
constexpr std::uint32_t kSharing = 3;      ///< vertices with one coordinate that attract a cut
// Far above the rounding of coordinates.
constexpr double kBeside = 1e-7;  ///< of the diagonal: the step to a point beside a plane

/// A box that may still be cut.
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

/// Returns the place where the segment between two places meets the plane at c across an axis.
Place cut_segment(const Place& from, const Place& to, Axis across, double c) {
    const Interval start = between(from, across);
    const Interval share = (Interval(c) - start) / (between(to, across) - start);
    Place cut;
    for (const Axis axis : kAxes) {
        const Interval a = between(from, axis);
        const Interval b = between(to, axis);
        const Interval at = a + share * (b - a);
        // The segment does not leave the box of its ends, whatever the rounding.
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
        drop_trimmed();
        add_corners();
        return std::move(cells_);
    }

private:
    /// Finds the coordinates that at least kSharing vertices share, ascending.
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
        const bool is_full = cells_.cells.size() + 2 * level.size() > options_.most_cells ||
                             cells_.fragments.size() > options_.most_fragments;
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

    /// A box to cut in two.
    struct Cut {
        const Open* open;
        Axis axis;
        double at;
    };
    /// Some of its fragments, by the sides on which they lie.
    struct Shared {
        std::size_t cut;
        std::size_t first;
        std::vector<std::uint32_t> below = {}, above = {}, both = {}, across = {}, loose = {};
    };

    /// Returns the two halves of each box. Fragments are examined in parallel: many boxes, or many
    /// in one. Fragments that are cut get their numbers one after the other.
    std::vector<Open> share_all(std::span<const Cut> cuts) {
        std::vector<Shared> shares;
        for (std::size_t i = 0; i < cuts.size(); ++i) {
            const std::size_t count = cuts[i].open->fragments.size();
            for (std::size_t first = 0; first < count; first += kChunk) {
                shares.push_back({i, first});
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
            for (const std::uint32_t number : shared.both) share_copy(number, below, above);
            for (const std::uint32_t number : shared.across) {
                cut_in_two(number, cut, below, above);
            }
            for (const std::uint32_t number : shared.loose) {
                for (const std::uint32_t inner : trim(number, cut.open->box, uncut_side(cut))) {
                    cut_in_two(inner, cut, below, above);
                }
            }
        }
        return halves;
    }

    [[nodiscard]] bool is_small_enough(const Open& open) const {
        const double side = longest_side(open.box);
        // Boxes without surface may be twice as large: no hull ends in them.
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

    /// Returns the size up to which fragments are not cut and may extend beyond their box.
    static double uncut_side(const Cut& cut) {
        Box half = cut.open->box;
        half.upper.*cut.axis = cut.at;
        return kUncut * longest_side(half);
    }

    /// Assigns fragments to the boxes on either side of a cut. Large ones across it are left for
    /// later.
    void share(const Cut& cut, Shared& shared) const {
        const Box& box = cut.open->box;
        const double small = uncut_side(cut);
        const auto& all = cut.open->fragments;
        const std::size_t end = std::min(shared.first + kChunk, all.size());
        for (std::size_t i = shared.first; i < end; ++i) {
            const std::uint32_t number = all[i];
            const Box around = box_around(cells_.fragments[number]);
            const Lying lying = lie(cells_.fragments[number], cut.axis, cut.at);
            const bool is_uncut = lying.is_unclear || longest_side(around) <= small;
            if (sticks_out(around, box, small)) {
                shared.loose.push_back(number);
            } else if (lying.below == 3 && lying.above == 3) {
                const Sides sides = sides_of_body(number, cut);
                (!sides.above  ? shared.below
                 : sides.below ? shared.both
                               : shared.above)
                    .push_back(number);
            } else if (lying.below == 3) {
                shared.below.push_back(number);
            } else if (lying.above == 3) {
                shared.above.push_back(number);
            } else {
                (is_uncut ? shared.both : shared.across).push_back(number);
            }
        }
    }

    struct Sides {
        bool below;
        bool above;
    };

    /// Returns the sides on which the body of a fragment in the plane of a cut lies, or one of
    /// them. If both boxes got the fragment, an empty box between two walls would become a cell
    /// that bridges them.
    [[nodiscard]] Sides sides_of_body(std::uint32_t number, const Cut& cut) const {
        const Fragment& fragment = cells_.fragments[number];
        Double3 middle = {0, 0, 0};
        for (const std::uint32_t place : fragment.place) {
            const Double3& p = cells_.places[place].lower;
            middle = {middle.x + p.x / 3, middle.y + p.y / 3, middle.z + p.z / 3};
        }
        const double step = kBeside * solid_.diagonal();
        const std::uint32_t body = solid_.body_of(fragment.triangle);
        middle.*cut.axis = cut.at + step;
        const bool above = is_in_body(middle, body);
        middle.*cut.axis = cut.at - step;
        return {!above || is_in_body(middle, body), above};
    }

    [[nodiscard]] bool is_in_body(const Double3& p, std::uint32_t body) const {
        const auto around = solid_.bodies_around(p);
        return std::binary_search(around.begin(), around.end(), body);
    }

    [[nodiscard]] Box box_around(const Fragment& fragment) const {
        Box around;
        for (const std::uint32_t place : fragment.place) {
            around.add(cells_.places[place].lower);
            around.add(cells_.places[place].upper);
        }
        return around;
    }

    static bool sticks_out(const Box& around, const Box& box, double by) {
        return std::any_of(kAxes.begin(), kAxes.end(), [&](Axis axis) {
            return around.lower.*axis < box.lower.*axis - by ||
                   around.upper.*axis > box.upper.*axis + by;
        });
    }

    /// Gives both boxes a copy of the fragment: each cuts its own.
    void share_copy(std::uint32_t number, Open& below, Open& above) {
        below.fragments.push_back(number);
        const Fragment copy = cells_.fragments[number];
        above.fragments.push_back(add_fragment(copy));
    }

    std::uint32_t add_fragment(const Fragment& fragment) {
        cells_.fragments.push_back(fragment);
        ++cells_.fragment_count[fragment.triangle];
        return static_cast<std::uint32_t>(cells_.fragments.size() - 1);
    }

    std::uint32_t add_place(const Place& place) {
        cells_.places.push_back(place);
        return static_cast<std::uint32_t>(cells_.places.size() - 1);
    }

    /// What a plane leaves of a fragment on its low and its high side.
    struct Halves {
        std::vector<std::uint32_t> low;
        std::vector<std::uint32_t> high;
    };

    /// The number of corners on either side of a plane; corners on it count on both. `is_unclear`:
    /// some corner is on no side for certain.
    struct Lying {
        int below = 0;
        int above = 0;
        bool is_unclear = false;
    };

    [[nodiscard]] Lying lie(const Fragment& fragment, Axis axis, double at) const {
        Lying lying;
        for (const std::uint32_t place : fragment.place) {
            const Place& p = cells_.places[place];
            lying.below += p.upper.*axis <= at ? 1 : 0;
            lying.above += p.lower.*axis >= at ? 1 : 0;
            // A box that only touches the plane is unclear too: its point need not be on the plane.
            const bool is_met = p.lower.*axis <= at && p.upper.*axis >= at;
            lying.is_unclear = lying.is_unclear || (is_met && p.lower.*axis < p.upper.*axis);
        }
        return lying;
    }

    /// Cuts a fragment. Each half is a fan of its corners and of the points where the edges cross.
    /// A fragment that may or may not cross the plane is in both halves. One in the plane is in the
    /// lower half.
    Halves cut_fragment(std::uint32_t number, Axis axis, double at) {
        const Fragment fragment = cells_.fragments[number];
        const Lying lying = lie(fragment, axis, at);
        if (lying.below == 3) return {{number}, {}};
        if (lying.above == 3) return {{}, {number}};
        if (lying.is_unclear) return {{number}, {add_fragment(fragment)}};
        Halves halves;
        std::vector<std::uint32_t> low;
        std::vector<std::uint32_t> high;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = fragment.place[k];
            const std::uint32_t to = fragment.place[(k + 1) % 3];
            const Place a = cells_.places[from];
            const Place b = cells_.places[to];
            if (a.upper.*axis <= at) low.push_back(from);
            if (a.lower.*axis >= at) high.push_back(from);
            const bool crosses = (a.upper.*axis < at && b.lower.*axis > at) ||
                                 (a.lower.*axis > at && b.upper.*axis < at);
            if (!crosses) continue;
            // The cut starts at the lower end, so that all triangles of an edge get the same point.
            const bool upwards = a.upper.*axis < at;
            const std::uint32_t met =
                add_place(upwards ? cut_segment(a, b, axis, at) : cut_segment(b, a, axis, at));
            low.push_back(met);
            high.push_back(met);
        }
        bool is_first = true;
        for (const auto& [polygon, half] :
             {std::pair(&low, &halves.low), std::pair(&high, &halves.high)}) {
            for (std::size_t k = 2; k < polygon->size(); ++k) {
                const Fragment made = {{(*polygon)[0], (*polygon)[k - 1], (*polygon)[k]},
                                       fragment.triangle};
                if (is_first) cells_.fragments[number] = made;
                half->push_back(is_first ? number : add_fragment(made));
                is_first = false;
            }
        }
        return halves;
    }

    void cut_in_two(std::uint32_t number, const Cut& cut, Open& below, Open& above) {
        const Lying lying = lie(cells_.fragments[number], cut.axis, cut.at);
        if (lying.below == 3 && lying.above == 3 && sides_of_body(number, cut).above) {
            above.fragments.push_back(number);
            return;
        }
        const Halves halves = cut_fragment(number, cut.axis, cut.at);
        below.fragments.insert(below.fragments.end(), halves.low.begin(), halves.low.end());
        above.fragments.insert(above.fragments.end(), halves.high.begin(), halves.high.end());
    }

    /// Returns what of a fragment extends beyond the box by at most `by`. Other boxes have the same
    /// fragment for the rest.
    std::vector<std::uint32_t> trim(std::uint32_t number, const Box& box, double by) {
        std::vector<std::uint32_t> kept = {number};
        for (const Axis axis : kAxes) {
            for (const bool is_upper : {false, true}) {
                const double at = is_upper ? box.upper.*axis : box.lower.*axis;
                std::vector<std::uint32_t> next;
                for (const std::uint32_t one : kept) {
                    const Box around = box_around(cells_.fragments[one]);
                    const double beyond =
                        is_upper ? around.upper.*axis - at : at - around.lower.*axis;
                    if (beyond <= by) {
                        next.push_back(one);
                        continue;
                    }
                    const std::uint32_t triangle = cells_.fragments[one].triangle;
                    const Halves halves = cut_fragment(one, axis, at);
                    const auto& in = is_upper ? halves.low : halves.high;
                    const auto& out = is_upper ? halves.high : halves.low;
                    next.insert(next.end(), in.begin(), in.end());
                    cells_.fragment_count[triangle] -= static_cast<std::uint32_t>(out.size());
                }
                kept = std::move(next);
            }
        }
        return kept;
    }

    /// Makes one cell for each body that reaches into the box.
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

    /// Removes fragments that are in no cell because they were trimmed. The others are renumbered.
    void drop_trimmed() {
        std::vector<Fragment> held;
        held.reserve(cells_.fragments.size());
        for (SolidCell& cell : cells_.cells) {
            for (std::uint32_t& number : cell.fragments) {
                held.push_back(cells_.fragments[number]);
                number = static_cast<std::uint32_t>(held.size() - 1);
            }
        }
        cells_.fragments = std::move(held);
    }

    /// Returns true if a corner of the box belongs to the body. A corner on the surface belongs
    /// only if the body continues from it within the box. If it does in part, fragments end in the
    /// corner.
    [[nodiscard]] bool is_corner_of_body(const Double3& corner, const SolidCell& cell) const {
        if (!is_in_body(corner, cell.body)) return false;
        if (solid_.tree().nearest(corner).distance > solid_.slack()) return true;
        const Double3 middle = centre(cell.box);
        const double share = std::min(0.5, kBeside * solid_.diagonal() / longest_side(cell.box));
        return is_in_body(
            {corner.x + share * (middle.x - corner.x), corner.y + share * (middle.y - corner.y),
             corner.z + share * (middle.z - corner.z)},
            cell.body);
    }

    void add_corners() {
        if (!solid_.encloses()) return;
        const auto add = [this](std::size_t number) {
            SolidCell& cell = cells_.cells[number];
            for (unsigned k = 0; k < 8; ++k) {
                const Double3 corner = {(k & 1U) == 0 ? cell.box.lower.x : cell.box.upper.x,
                                        (k & 2U) == 0 ? cell.box.lower.y : cell.box.upper.y,
                                        (k & 4U) == 0 ? cell.box.lower.z : cell.box.upper.z};
                if (is_corner_of_body(corner, cell)) cell.corners.push_back(corner);
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
