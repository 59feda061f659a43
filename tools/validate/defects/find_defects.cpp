// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/defects/find_defects.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/close_groups.h"
#include "mesh/component_numbers.h"
#include "mesh/nesting.h"
#include "validate/defects/boundary.h"
#include "validate/defects/copies.h"
#include "validate/defects/edge_flaws.h"
#include "validate/defects/finding_list.h"
#include "validate/defects/meetings.h"
#include "validate/defects/orientability.h"
#include "validate/defects/sound_mesh.h"
#include "validate/defects/source_places.h"
#include "validate/defects/surface_measures.h"
#include "validate/defects/verdicts.h"

namespace cdprep::mesh {
namespace {

constexpr double kLargestFloat = std::numeric_limits<float>::max();

/// Applies the rules in order, related ones together, and keeps the results that later rules
/// use.
class DefectFinder {
public:
    DefectFinder(const TriangleSoup& soup, const DefectOptions& options)
        : soup_(soup), options_(options), findings_(options.max_places) {}

    DefectReport find() {
        sound_ = find_sound_mesh(soup_, findings_, counts());
        components_ = number_components(sound_.mesh);
        counts().components = components_.count;
        list_large_extents();
        list_near_vertices();
        if (sound_.mesh.triangles.empty()) {
            findings_.add(Rule::empty_mesh, [] { return Place{}; });
        }
        for (const auto stage :
             {&DefectFinder::find_flaws_of_edges, &DefectFinder::find_flaws_of_boundary,
              &DefectFinder::measure, &DefectFinder::list_components, &DefectFinder::judge}) {
            if (is_stopped(options_.stop)) return std::move(report_);
            (this->*stage)();
        }
        report_.findings = findings_.take();
        return std::move(report_);
    }

private:
    [[nodiscard]] DefectCounts& counts() {
        return report_.counts;
    }

    /// Lists extents beyond float (CDP0103). Triangles that repeat a corner count: a baked file
    /// and its box hold them.
    void list_large_extents() {
        const std::vector<std::uint32_t> vertices = used_vertices();
        for (const std::uint32_t vertex : vertices) {
            const Double3& p = soup_.positions[vertex];
            const double size = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
            if (!(size > kLargestFloat)) continue;
            findings_.add(Rule::extent_beyond_float, [&] { return Place{{}, {vertex}, p, size}; });
        }
        if (vertices.empty()) return;
        for (const auto axis : {&Double3::x, &Double3::y, &Double3::z}) {
            list_large_extent(vertices, axis);
        }
    }

    /// Returns the vertices of all triangles whose corners are finite, as the lowest numbers of
    /// their positions, ascending.
    [[nodiscard]] std::vector<std::uint32_t> used_vertices() const {
        const std::vector<std::uint32_t>& sound = sound_.mesh.source_vertex;
        const std::vector<std::uint32_t>& repeated = sound_.repeated_vertex;
        std::vector<std::uint32_t> vertices(sound.size() + repeated.size());
        std::merge(sound.begin(), sound.end(), repeated.begin(), repeated.end(), vertices.begin());
        return vertices;
    }

    void list_large_extent(const std::vector<std::uint32_t>& vertices, double Double3::*axis) {
        const auto along = [&](std::uint32_t vertex) { return soup_.positions[vertex].*axis; };
        const auto ends = std::minmax_element(
            vertices.begin(), vertices.end(),
            [&](std::uint32_t a, std::uint32_t b) { return along(a) < along(b); });
        const std::uint32_t first = *ends.first;
        const std::uint32_t last = *ends.second;
        const double least = along(first);
        const double most = along(last);
        const bool is_told = std::max(std::fabs(least), std::fabs(most)) > kLargestFloat;
        if (is_told || !(most - least > kLargestFloat)) return;
        findings_.add(Rule::extent_beyond_float, [&] {
            return Place{{}, {first, last}, soup_.positions[first], most - least};
        });
    }

    /// Lists the vertices that welding would join (CDP0106).
    void list_near_vertices() {
        if (!(options_.weld_distance > 0)) return;
        const std::vector<Double3>& points = sound_.mesh.positions;
        const std::vector<std::uint32_t> lowest = close_groups(points, options_.weld_distance);
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            if (lowest[i] == i) continue;
            findings_.add(Rule::near_vertex, [&] {
                const std::vector<std::uint32_t>& source = sound_.mesh.source_vertex;
                return Place{{},
                             {source[lowest[i]], source[i]},
                             points[i],
                             distance_between(points[lowest[i]], points[i])};
            });
        }
    }

    /// Lists flaws of edges (CDP0204, CDP0205, CDP0303 to CDP0306).
    void find_flaws_of_edges() {
        const Stars stars = collect_stars(sound_.mesh);
        flaws_ = find_edge_flaws(stars);
        non_orientable_ = find_non_orientable(stars, components_, flaws_);
        balanced_.assign(components_.count, true);
        for (const std::uint32_t vertex : flaws_.unbalanced) {
            balanced_[components_.of_vertex[vertex]] = false;
        }
        list_repeated();
        counts().non_manifold_edges = flaws_.non_manifold.size();
        findings_.add_sorted(Rule::non_manifold_edge, flaws_.non_manifold, comes_before,
                             [this](const FlawedEdge& edge) {
                                 return place_of_edge(soup_, sound_, edge, edge.uses);
                             });
        counts().inconsistent_edges = flaws_.inconsistent.size();
        findings_.add_sorted(Rule::inconsistent_winding, flaws_.inconsistent, comes_before,
                             [this](const FlawedEdge& edge) {
                                 return place_of_edge(soup_, sound_, edge, length_of(edge));
                             });
        list_pinched(stars);
        list_non_orientable();
    }

    [[nodiscard]] double length_of(const FlawedEdge& edge) const {
        return distance_between(sound_.mesh.positions[edge.from], sound_.mesh.positions[edge.to]);
    }

    void list_repeated() {
        std::sort(flaws_.repeated.begin(), flaws_.repeated.end(),
                  [](const RepeatedTriangle& a, const RepeatedTriangle& b) {
                      return a.triangle < b.triangle;
                  });
        for (const RepeatedTriangle& repeated : flaws_.repeated) {
            ++counts().duplicate_triangles;
            if (repeated.opposite) ++counts().opposite_triangles;
            findings_.add(repeated.opposite ? Rule::opposite_triangle : Rule::duplicate_triangle,
                          [&] {
                              const std::vector<std::uint32_t>& source = sound_.source_triangle;
                              return Place{{source[repeated.first], source[repeated.triangle]},
                                           {},
                                           corner_of(repeated.triangle),
                                           0};
                          });
        }
    }

    [[nodiscard]] const Double3& corner_of(std::uint32_t triangle) const {
        return sound_.mesh.positions[sound_.mesh.triangles[triangle].vertex[0]];
    }

    void list_pinched(const Stars& stars) {
        counts().non_manifold_vertices = flaws_.pinched.size();
        // The stars are read in order, so the vertices ascend.
        for (const PinchedVertex& pinched : flaws_.pinched) {
            findings_.add(Rule::non_manifold_vertex, [&] {
                Place place;
                for (const std::uint32_t triangle : lowest_of_fans(stars.at(pinched.vertex))) {
                    if (place.triangles.size() == kMaxPlaceNumbers) break;
                    place.triangles.push_back(sound_.source_triangle[triangle]);
                }
                place.vertices = {sound_.mesh.source_vertex[pinched.vertex]};
                place.position = sound_.mesh.positions[pinched.vertex];
                place.measure = pinched.fans;
                return place;
            });
        }
    }

    void list_non_orientable() {
        counts().non_orientable_components = non_orientable_.size();
        for (const NonOrientable& found : non_orientable_) {
            findings_.add(Rule::non_orientable, [&] {
                const auto [a, b] = std::minmax(found.first_triangle, found.second_triangle);
                return Place{
                    {sound_.source_triangle[a], sound_.source_triangle[b]}, {}, corner_of(a), 0};
            });
        }
    }

    /// Lists flaws of the boundary (CDP0301, CDP0302, CDP0307, CDP0308).
    void find_flaws_of_boundary() {
        boundary_ = find_boundary(sound_.mesh, std::move(flaws_.boundary));
        counts().boundary_edges = boundary_.edge.size();
        counts().boundary_loops = boundary_.loop.size();
        list_boundary(soup_, sound_, boundary_, findings_);
        report_.t_junctions_complete =
            find_t_junctions(soup_, sound_, boundary_, options_.stop, findings_, counts());
        find_near_seams(soup_, sound_, boundary_, options_.seam_width, findings_, counts());
    }

    /// Measures areas and volumes; lists triangles of zero area and slivers (CDP0202, CDP0203).
    void measure() {
        measures_ = measure_surface(sound_, components_, balanced_, findings_, counts());
    }

    /// Lists components (CDP0401, CDP0404).
    void list_components() {
        first_triangle_.assign(components_.count, std::numeric_limits<std::uint32_t>::max());
        std::vector<std::uint32_t> triangles(components_.count, 0);
        for (std::uint32_t i = 0; i < sound_.mesh.triangles.size(); ++i) {
            const std::uint32_t component =
                components_.of_vertex[sound_.mesh.triangles[i].vertex[0]];
            first_triangle_[component] = std::min(first_triangle_[component], i);
            ++triangles[component];
        }
        for (std::uint32_t i = 0; i < components_.count; ++i) {
            if (components_.count > 1) {
                findings_.add(Rule::several_components,
                              [&] { return place_of_component(i, triangles[i]); });
            }
            if (!balanced_[i] || measures_.component[i].volume_sign >= 0) continue;
            ++counts().inverted_components;
            findings_.add(Rule::inverted_component,
                          [&] { return place_of_component(i, measures_.component[i].volume); });
        }
    }

    [[nodiscard]] Place place_of_component(std::uint32_t component, double measure) const {
        const std::uint32_t triangle = first_triangle_[component];
        return {{sound_.source_triangle[triangle]}, {}, corner_of(triangle), measure};
    }

    /// Lists pairs (CDP0402, CDP0403, CDP0501 to CDP0503), and makes the verdicts.
    void judge() {
        const std::vector<Nested> nested = find_nested(sound_.mesh, components_, balanced_);
        ComponentMeetings meetings;
        meetings.overlapping.resize(nested.size());
        if (options_.crossings) {
            const Copies copies(std::move(flaws_.repeated));
            meetings = list_meetings({copies, sound_, components_, nested}, search_options(),
                                     findings_, counts());
        }
        report_.crossings_complete = options_.crossings && meetings.is_complete;
        // Two components may overlap if not all their pairs of triangles were examined.
        if (meetings.is_complete) list_nested(nested, meetings);
        report_.verdicts =
            make_verdicts({sound_, components_, flaws_, boundary_, non_orientable_, balanced_,
                           measures_, nested, options_.crossings ? &meetings : nullptr});
    }

    [[nodiscard]] SearchOptions search_options() const {
        const std::uint64_t steps = options_.max_steps > 0
                                        ? options_.max_steps
                                        : default_steps(sound_.mesh.triangles.size());
        return {{options_.max_pairs, steps}, options_.stop, options_.parallel_for};
    }

    void list_nested(const std::vector<Nested>& nested, const ComponentMeetings& meetings) {
        for (std::size_t i = 0; i < nested.size(); ++i) {
            if (meetings.overlapping[i]) continue;
            const Nested& pair = nested[i];
            ++counts().nested_components;
            findings_.add(Rule::nested_component, [&] {
                Place place = place_of_component(pair.inner, pair.winding);
                place.triangles.push_back(sound_.source_triangle[first_triangle_[pair.outer]]);
                std::sort(place.triangles.begin(), place.triangles.end());
                return place;
            });
        }
    }

    const TriangleSoup& soup_;
    const DefectOptions& options_;
    FindingList findings_;
    DefectReport report_;
    SoundMesh sound_;
    ComponentNumbers components_;
    EdgeFlaws flaws_;
    std::vector<NonOrientable> non_orientable_;
    std::vector<bool> balanced_;  ///< per component: the oriented uses of every edge cancel
    Boundary boundary_;
    SurfaceMeasures measures_;
    std::vector<std::uint32_t> first_triangle_;  ///< the first triangle of each component
};

}  // namespace

DefectReport find_defects(const TriangleSoup& soup, const DefectOptions& options) {
    return DefectFinder(soup, options).find();
}

}  // namespace cdprep::mesh
