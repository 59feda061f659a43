// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/repaired_soup.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "mesh/source_faces.h"

namespace cdprep::mesh {
namespace {

constexpr const char* kMadeName = "repair";

/// Sets each run to the triangles whose source lies in it; `from` must be ascending.
template <class Run>
void recount(std::vector<Run>& runs, const std::vector<std::uint32_t>& from) {
    std::uint32_t next = 0;
    for (Run& run : runs) {
        const std::uint64_t end = std::uint64_t{run.first_triangle} + run.triangle_count;
        run.first_triangle = next;
        while (next < from.size() && from[next] < end) ++next;
        run.triangle_count = next - run.first_triangle;
    }
}

std::uint32_t add_name(std::vector<std::string>& names) {
    names.emplace_back(kMadeName);
    return static_cast<std::uint32_t>(names.size() - 1);
}

/// Adds the run of the triangles without a source, after all others.
template <class Run>
void add_made(std::vector<Run>& runs, std::vector<std::string>& names, std::uint32_t first,
              std::uint32_t count, Run made) {
    if (runs.empty() || count == 0) return;
    made.first_triangle = first;
    made.triangle_count = count;
    made.name = add_name(names);
    runs.push_back(made);
}

format::Instance made_instance(const std::vector<format::Instance>& instances) {
    format::Instance made{};
    made.model_from_node = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    for (const format::Instance& instance : instances) {
        made.mesh = std::max(made.mesh, instance.mesh + 1);
    }
    return made;
}

/// Returns the faces of the sources, of which `face` has one for each; triangles without a source
/// get running numbers.
std::vector<std::uint32_t> faces_of(const std::vector<std::uint32_t>& face,
                                    const std::vector<std::uint32_t>& from) {
    std::vector<std::uint32_t> faces;
    faces.reserve(from.size());
    std::uint32_t made = 0;
    for (const std::uint32_t source : from) {
        faces.push_back(source == kNone ? made++ : face[source]);
    }
    return faces;
}

}  // namespace

RepairedSoup as_soup(const TriangleSoup& source, RepairMesh repaired) {
    std::vector<std::uint32_t> order(repaired.triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return repaired.triangle_origin[a].source < repaired.triangle_origin[b].source;
    });

    RepairedSoup result;
    result.soup = source;
    TriangleSoup& soup = result.soup;
    soup.bad_numbers.clear();
    soup.bad_number_count = 0;
    soup.out_of_range.clear();
    soup.single_precision = repaired.single_precision;
    soup.positions = std::move(repaired.positions);
    soup.triangles.clear();
    for (const std::uint32_t i : order) {
        soup.triangles.push_back(repaired.triangles[i]);
        result.triangle_from.push_back(repaired.triangle_origin[i].source);
    }
    for (const Origin& origin : repaired.vertex_origin) result.vertex_from.push_back(origin.source);

    const std::vector<std::uint32_t>& from = result.triangle_from;
    const auto with_source = static_cast<std::uint32_t>(
        std::lower_bound(from.begin(), from.end(), kNone) - from.begin());
    const auto made = static_cast<std::uint32_t>(from.size() - with_source);
    soup.face = faces_of(source_faces(source), from);
    recount(soup.instances, from);
    recount(soup.groups.runs, from);
    recount(soup.materials.runs, from);
    add_made(soup.instances, soup.instance_names, with_source, made, made_instance(soup.instances));
    add_made(soup.groups.runs, soup.groups.names, with_source, made, format::NamedRun{});
    add_made(soup.materials.runs, soup.materials.names, with_source, made, format::NamedRun{});
    return result;
}

}  // namespace cdprep::mesh
