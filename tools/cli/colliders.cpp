// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/colliders.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>

#include "mesh/source_faces.h"
#include "text/number_text.h"
#include "text/printable.h"

namespace cdprep::cli {
namespace {

constexpr std::size_t kMostNames = 3;  ///< in a sentence

enum TriangleUse : std::uint8_t { of_nothing = 0, of_collider = 1, of_rest = 2 };

/// What is left of a soup: old numbers become new ones. Empty if there are no colliders.
struct Rest {
    std::vector<std::uint8_t> is_left;  ///< by triangle
    /// By triangle, and at the end: how many of those before it are left.
    std::vector<std::uint32_t> before;
    std::vector<std::string> colliders;  ///< paths, each once
};

template <class Run>
std::uint32_t count_left(const Rest& rest, const Run& run) {
    return rest.before[run.first_triangle + run.triangle_count] - rest.before[run.first_triangle];
}

template <class Run>
Rest find_rest(std::size_t triangles, const std::vector<Run>& runs,
               const std::vector<std::string>& names) {
    Rest rest;
    std::set<std::string_view> known;
    for (const Run& run : runs) {
        const std::string& path = names[run.name];
        if (run.triangle_count == 0 || !is_collider(path)) continue;
        rest.is_left.resize(triangles, 1);
        std::fill_n(rest.is_left.begin() + run.first_triangle, run.triangle_count, 0);
        if (known.insert(path).second) rest.colliders.push_back(path);
    }
    if (known.empty()) return rest;
    rest.before.push_back(0);
    for (const std::uint8_t is_left : rest.is_left) {
        rest.before.push_back(rest.before.back() + is_left);
    }
    return rest;
}

/// Keeps the runs that have triangles, and the names that these have.
template <class Run>
void take_runs(const Rest& rest, std::vector<Run>& runs, std::vector<std::string>& names) {
    constexpr std::uint32_t kNone = UINT32_MAX;
    std::vector<std::string> left_names;
    std::vector<std::uint32_t> number_of(names.size(), kNone);
    std::vector<Run> left;
    for (Run run : runs) {
        const std::uint32_t count = count_left(rest, run);
        if (count == 0) continue;
        std::uint32_t& name = number_of[run.name];
        if (name == kNone) {
            name = static_cast<std::uint32_t>(left_names.size());
            left_names.push_back(std::move(names[run.name]));
        }
        run.name = name;
        run.first_triangle = rest.before[run.first_triangle];
        run.triangle_count = count;
        left.push_back(run);
    }
    runs = std::move(left);
    names = std::move(left_names);
}

/// Does so too, and joins neighbours of one name.
void take_runs(const Rest& rest, mesh::NamedRuns& named) {
    take_runs(rest, named.runs, named.names);
    std::vector<format::NamedRun> joined;
    for (const format::NamedRun& run : named.runs) {
        if (!joined.empty() && joined.back().name == run.name) {
            joined.back().triangle_count += run.triangle_count;
        } else {
            joined.push_back(run);
        }
    }
    named.runs = std::move(joined);
}

void take_vertices(const Rest& rest, mesh::TriangleSoup& soup) {
    std::vector<std::uint8_t> use(soup.positions.size(), of_nothing);
    for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
        for (const std::uint32_t vertex : soup.triangles[i].vertex) {
            use[vertex] = std::max(
                use[vertex], static_cast<std::uint8_t>(rest.is_left[i] ? of_rest : of_collider));
        }
    }
    std::vector<std::uint32_t> number(use.size());
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < use.size(); ++i) {
        number[i] = next;
        if (use[i] != of_collider) soup.positions[next++] = soup.positions[i];
    }
    soup.positions.resize(next);
    for (format::Triangle& triangle : soup.triangles) {
        for (std::uint32_t& vertex : triangle.vertex) vertex = number[vertex];
    }
}

void take_triangles(const Rest& rest, mesh::TriangleSoup& soup) {
    std::size_t next = 0;
    for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
        if (!rest.is_left[i]) continue;
        soup.face[next] = soup.face[i];
        soup.triangles[next++] = soup.triangles[i];
    }
    soup.triangles.resize(next);
    soup.face.resize(next);
}

/// Finds nothing if numbers were not read: whose they are is not known.
Rest find_rest(const mesh::TriangleSoup& soup) {
    if (soup.bad_number_count > 0) return {};
    const std::size_t triangles = soup.triangles.size();
    Rest rest = soup.instances.empty() ? find_rest(triangles, soup.groups.runs, soup.groups.names)
                                       : find_rest(triangles, soup.instances, soup.instance_names);
    if (!rest.colliders.empty() && rest.before.back() == 0) return {};
    return rest;
}

/// Returns "a, b and 2 more".
std::string first_names(std::span<const std::string> paths) {
    const std::size_t shown = std::min(paths.size(), kMostNames);
    std::string names;
    for (std::size_t i = 0; i < shown; ++i) {
        const bool is_last = i + 1 == paths.size();
        names += (i == 0 ? "" : is_last ? " and " : ", ") + report::printable(paths[i]);
    }
    if (shown < paths.size()) names += " and " + std::to_string(paths.size() - shown) + " more";
    return names;
}

/// Colliders may be the only ones that need doubles, because a transform moves them.
bool are_floats(const std::vector<format::Double3>& positions) {
    const auto is_float = [](double x) { return double{static_cast<float>(x)} == x; };
    return std::all_of(positions.begin(), positions.end(), [&](const format::Double3& p) {
        return is_float(p.x) && is_float(p.y) && is_float(p.z);
    });
}

}  // namespace

bool is_collider(std::string_view path) noexcept {
    constexpr std::array<std::string_view, 4> kBeginnings = {"UCX_", "UBX_", "USP_", "UCP_"};
    constexpr std::array<std::string_view, 2> kEndings = {"-colonly", "-convcolonly"};
    const std::size_t slash = path.find_last_of('/');
    const std::string_view name = path.substr(slash == std::string_view::npos ? 0 : slash + 1);
    const std::string_view above = path.substr(0, path.size() - name.size());
    const auto begins = [&](std::string_view text) { return name.starts_with(text); };
    const auto ends = [&](std::string_view text) { return name.ends_with(text); };
    return above.starts_with("colliders/") || above.find("/colliders/") != std::string_view::npos ||
           std::any_of(kBeginnings.begin(), kBeginnings.end(), begins) ||
           std::any_of(kEndings.begin(), kEndings.end(), ends);
}

std::vector<std::string> leave_out_colliders(mesh::TriangleSoup& soup) {
    const Rest rest = find_rest(soup);
    if (rest.colliders.empty()) return {};
    soup.face = mesh::source_faces(soup);  // while the instances still have all their triangles
    take_runs(rest, soup.instances, soup.instance_names);
    take_runs(rest, soup.groups);
    take_runs(rest, soup.materials);
    take_vertices(rest, soup);
    take_triangles(rest, soup);
    soup.single_precision = soup.single_precision || are_floats(soup.positions);
    return rest.colliders;
}

std::vector<std::string> find_colliders(const mesh::TriangleSoup& soup) {
    return find_rest(soup).colliders;
}

std::string left_out_text(std::span<const std::string> paths) {
    return report::counted(paths.size(), "collider was", "colliders were") +
           " left out: " + first_names(paths) + ". Keep " + (paths.size() == 1 ? "it" : "them") +
           " with --with-colliders.";
}

std::string kept_text(std::span<const std::string> paths, const std::string& way) {
    return report::counted(paths.size(), "collider is", "colliders are") +
           " a part of the mesh: " + first_names(paths) + ". Leave " +
           (paths.size() == 1 ? "it" : "them") + " out " + way + ".";
}

void add_with_colliders(const Command& command, bool& with_colliders) {
    command
        .add_flag("--with-colliders", with_colliders,
                  "Treat nodes and groups that are colliders of an engine as parts of the mesh")
        .group("Import");
}

void add_without_colliders(const Command& command, bool& without_colliders) {
    command
        .add_flag("--without-colliders", without_colliders,
                  "Leave out nodes and groups that are colliders of an engine, as 'cdprep bake' "
                  "does")
        .group("Import");
}

}  // namespace cdprep::cli
