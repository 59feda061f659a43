// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/repair_goal.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "mesh/stars.h"
#include "repair/repair.h"
#include "validate/defects/component_pairs.h"
#include "validate/defects/copies.h"
#include "validate/defects/edge_flaws.h"
#include "validate/defects/sound_mesh.h"

namespace cdprep::mesh {
namespace {

constexpr std::size_t kSourcePairs = std::size_t{1} << 22;  ///< distinct pairs: 100 MB

/// The triangles that can be searched, and their copies.
class SoundSurface {
public:
    explicit SoundSurface(const TriangleSoup& soup) {
        FindingList findings(0);
        DefectCounts counts;
        sound_ = find_sound_mesh(soup, findings, counts);
        copies_ = Copies(find_edge_flaws(collect_stars(sound_.mesh)).repeated);
    }

    [[nodiscard]] const SoundMesh& sound() const {
        return sound_;
    }
    [[nodiscard]] const Copies& copies() const {
        return copies_;
    }

private:
    SoundMesh sound_;
    Copies copies_;
};

bool are_apart(Meeting meeting) {
    return meeting == Meeting::crossing || meeting == Meeting::edge_crossing ||
           meeting == Meeting::touching || meeting == Meeting::flat_touching ||
           meeting == Meeting::coplanar_overlap;
}

/// Counts pairs; calls look(pair, crossing) for each meeting of distinct triangles.
template <class Look>
SelfCrossing search(const SoundSurface& surface, const SearchOptions& options, const Look& look) {
    const Copies& copies = surface.copies();
    SelfCrossing crossing;
    constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
    std::pair<std::uint32_t, std::uint32_t> lowest{kMost, kMost};
    crossing.is_complete = search_distinct_meetings(
        surface.sound().mesh, copies, options, [&](std::span<const TriangleMeeting> some) {
            for (const TriangleMeeting& pair : some) {
                crossing.pairs += copies.of(pair.a).size() * copies.of(pair.b).size();
                lowest = std::min(lowest, {pair.a, pair.b});
                look(pair, crossing);
            }
        });
    copies.for_each([&](const CopyList& list) {
        crossing.pairs += list.size() * (list.size() - 1) / 2;
        lowest = std::min(lowest, {list[0], list[1]});
    });
    if (crossing.pairs > 0) {
        crossing.first = surface.sound().source_triangle[lowest.first];
        crossing.second = surface.sound().source_triangle[lowest.second];
    }
    return crossing;
}

/// The source triangles of an output's triangles.
class SourceTriangles {
public:
    SourceTriangles(const TriangleSoup& input, const RepairMesh& output)
        : output_(output), lowest_(input.triangles.size()), corners_(input.triangles.size()) {
        std::iota(lowest_.begin(), lowest_.end(), 0U);
        const SoundSurface surface(input);
        const SoundMesh& sound = surface.sound();
        for (std::size_t i = 0; i < sound.source_triangle.size(); ++i) {
            corners_[sound.source_triangle[i]] = sound.mesh.triangles[i];
        }
        surface.copies().for_each([&](const CopyList& list) {
            for (std::size_t i = 1; i < list.size(); ++i) {
                lowest_[sound.source_triangle[list[i]]] = sound.source_triangle[list[0]];
            }
        });
    }

    /// Adds the pair of sources of two output triangles, unless the sources are neighbours.
    void add(std::uint32_t a, std::uint32_t b, ComponentPairs& pairs) const {
        const auto [low, high] = std::minmax({source_of(a), source_of(b)});
        if (low == high || are_neighbours(low, high)) return;
        pairs.add({low, high, 0, 0, 1});
    }

private:
    /// New triangles have numbers above those of the input.
    [[nodiscard]] std::uint32_t source_of(std::uint32_t triangle) const {
        const std::uint32_t source = output_.triangle_origin[triangle].source;
        if (source != kNone) return lowest_[source];
        return static_cast<std::uint32_t>(lowest_.size()) + triangle;
    }

    [[nodiscard]] bool are_neighbours(std::uint32_t low, std::uint32_t high) const {
        if (high >= lowest_.size()) return false;
        const auto& v = corners_[low].vertex;
        const auto& w = corners_[high].vertex;
        return std::find_first_of(v.begin(), v.end(), w.begin(), w.end()) != v.end();
    }

    const RepairMesh& output_;
    std::vector<std::uint32_t> lowest_;  ///< the lowest copy of a source triangle
    std::vector<Triangle> corners_;      ///< of a source triangle, with equal positions joined
};

/// A text such as "3 edges have more than two triangles": all counts above 0, with commas.
class Flaws {
public:
    void add(std::uint64_t count, const char* one, const char* several) {
        if (count == 0) return;
        if (!text_.empty()) text_ += ", ";
        text_ += std::to_string(count) + " " + (count == 1 ? one : several);
    }
    [[nodiscard]] const std::string& text() const {
        return text_;
    }

private:
    std::string text_;
};

}  // namespace

SelfCrossing find_self_crossing(const TriangleSoup& soup, const SearchOptions& options) {
    const SoundSurface surface(soup);
    return search(surface, options, [](const TriangleMeeting& pair, SelfCrossing& crossing) {
        crossing.apart += are_apart(pair.meeting) ? 1 : 0;
    });
}

SelfCrossing find_output_crossing(const TriangleSoup& input, const RepairMesh& output,
                                  const SearchOptions& options) {
    TriangleSoup soup;
    soup.positions = output.positions;
    soup.triangles = output.triangles;
    const SoundSurface surface(soup);
    const SourceTriangles sources(input, output);
    ComponentPairs apart(kSourcePairs);
    SelfCrossing crossing =
        search(surface, options, [&](const TriangleMeeting& pair, SelfCrossing&) {
            const std::vector<std::uint32_t>& number = surface.sound().source_triangle;
            sources.add(number[pair.a], number[pair.b], apart);
        });
    crossing.apart = apart.take().size();
    crossing.is_complete = crossing.is_complete && apart.is_complete();
    return crossing;
}

std::string worse_crossing(const SelfCrossing& before, const SelfCrossing& after) {
    if (!before.is_complete || after.apart <= before.apart) return "";
    return (after.is_complete ? "" : "at least ") + std::to_string(after.apart) +
           " pairs of triangles cross or touch, compared with " +
           (before.apart == 0 ? "none" : std::to_string(before.apart)) +
           " before; the fragments of a triangle count as one";
}

std::string missed_goal(std::string_view preset, const StoredVerdict& after,
                        const SelfCrossing& crossing_before, const SelfCrossing& crossing_after) {
    const std::string missed = "not " + std::string(preset) + ": ";
    if (after.verdict.triangle_count == 0) return missed + "there are no triangles";
    Flaws flaws;
    flaws.add(after.non_manifold_edges, "edge has more than two triangles",
              "edges have more than two triangles");
    flaws.add(after.non_manifold_vertices, "vertex has several fans", "vertices have several fans");
    flaws.add(after.duplicate_triangles, "triangle is a copy", "triangles are copies");
    flaws.add(after.repeated_corners, "triangle repeats a corner", "triangles repeat a corner");
    flaws.add(after.inconsistent_edges, "edge has triangles wound differently",
              "edges have triangles wound differently");
    if (preset != kSafePreset) {
        flaws.add(after.boundary_edges, "edge is still open", "edges are still open");
    }
    if (preset == kSolidPreset) {
        flaws.add(crossing_after.pairs, "pair of triangles still crosses or touches",
                  "pairs of triangles still cross or touch");
    }
    std::string sentence = flaws.text().empty() ? "" : missed + flaws.text();
    if (preset == kSolidPreset && crossing_after.pairs > 0) {
        return sentence + "; first " + std::to_string(crossing_after.first) + " and " +
               std::to_string(crossing_after.second);
    }
    if (preset == kSolidPreset && !crossing_after.is_complete) {
        return (sentence.empty() ? missed : sentence + ", ") +
               "not all pairs of triangles were examined for crossings";
    }
    const std::string worse = worse_crossing(crossing_before, crossing_after);
    if (worse.empty()) return sentence;
    return (sentence.empty() ? "worse than the input: " : sentence + "; ") + worse;
}

}  // namespace cdprep::mesh
