// SPDX-License-Identifier: MIT
#include "support/tiny_baker.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <numeric>
#include <utility>

#include "cdprep/build_image.h"
#include "triangle_contact.h"

namespace cdprep::test {
namespace {

template <class T>
TinySection section(SectionId id, const std::vector<T>& elements) {
    TinySection made{id, std::vector<std::byte>(elements.size() * sizeof(T))};
    if (!elements.empty()) std::memcpy(made.bytes.data(), elements.data(), made.bytes.size());
    return made;
}

/// Triangles in tree order with vertices in the order of their first use.
struct Ordered {
    std::vector<Double3> positions;
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> source_vertex;
};

Ordered in_order(std::span<const Double3> positions, std::span<const Triangle> triangles,
                 const std::vector<std::uint32_t>& order) {
    Ordered ordered;
    std::map<std::uint32_t, std::uint32_t> renamed;
    for (const std::uint32_t source : order) {
        Triangle triangle = triangles[source];
        for (std::uint32_t& vertex : triangle.vertex) {
            const auto next = static_cast<std::uint32_t>(ordered.positions.size());
            const auto [at, is_new] = renamed.try_emplace(vertex, next);
            if (is_new) {
                ordered.positions.push_back(positions[vertex]);
                ordered.source_vertex.push_back(vertex);
            }
            vertex = at->second;
        }
        ordered.triangles.push_back(triangle);
    }
    return ordered;
}

std::vector<std::uint64_t> degenerate_bits(const Ordered& mesh) {
    std::vector<std::uint64_t> bits((mesh.triangles.size() + 63) / 64);
    bool any = false;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& v = mesh.triangles[i].vertex;
        if (is_degenerate({mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]})) {
            bits[i / 64] |= std::uint64_t{1} << (i % 64);
            any = true;
        }
    }
    if (!any) bits.clear();
    return bits;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t vertex) {
    while (parent[vertex] != vertex) vertex = parent[vertex] = parent[parent[vertex]];
    return vertex;
}

/// Uses of each edge, one direction against the other.
bool edges_cancel(const std::vector<Triangle>& triangles) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
    for (const Triangle& triangle : triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t from = triangle.vertex[i];
            const std::uint32_t to = triangle.vertex[(i + 1) % 3];
            balance[std::minmax(from, to)] += from < to ? 1 : (from > to ? -1 : 0);
        }
    }
    return std::all_of(balance.begin(), balance.end(),
                       [](const auto& entry) { return entry.second == 0; });
}

std::vector<format::Component> components(const Ordered& mesh,
                                          std::span<const std::uint32_t> order) {
    std::vector<std::uint32_t> parent(mesh.positions.size());
    std::iota(parent.begin(), parent.end(), 0U);
    for (const Triangle& triangle : mesh.triangles) {
        for (const std::uint32_t vertex : triangle.vertex) {
            parent[root_of(parent, vertex)] = root_of(parent, triangle.vertex[0]);
        }
    }
    std::vector<std::size_t> by_source(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) by_source[order[i]] = i;
    std::map<std::uint32_t, std::size_t> found;
    std::vector<format::Component> result;
    for (const std::size_t i : by_source) {
        const std::uint32_t vertex = mesh.triangles[i].vertex[0];
        const auto [at, is_new] = found.try_emplace(root_of(parent, vertex), result.size());
        if (is_new) result.push_back({vertex, 0, 0, 0, 0});
        ++result[at->second].triangle_count;
    }
    return result;
}

/// Ends the test program when something cannot be built.
template <class T>
T or_abort(Result<T> result) {
    if (!result) {
        std::fprintf(stderr, "%s\n", result.error().message.c_str());
        std::abort();
    }
    return std::move(result).value();
}

}  // namespace

AlignedBytes assemble(const format::FileHeader& facts, const std::vector<TinySection>& sections,
                      std::uint64_t section_alignment) {
    std::vector<build::Section> views;
    for (const TinySection& made : sections) views.push_back({made.id, made.bytes});
    const build::ImageOptions options{.section_alignment = section_alignment};
    AlignedBytes file(or_abort(build::image_size(views, options)));
    or_abort(build::build_image(facts, views, file.span(), options));
    return file;
}

AlignedBytes bake_tiny(std::span<const Double3> positions, std::span<const Triangle> triangles,
                       const TinyOptions& options) {
    return bake_tiny(positions, triangles,
                     build::build_bvh(positions, triangles,
                                      {.bounds = options.bounds, .quality = options.quality}),
                     options);
}

AlignedBytes bake_tiny(std::span<const Double3> positions, std::span<const Triangle> triangles,
                       const build::Bvh& bvh, const TinyOptions& options) {
    const Ordered mesh = in_order(positions, triangles, bvh.order);

    std::vector<TinySection> all;
    if (options.double_precision) {
        all.push_back(section(SectionId::positions_f64, mesh.positions));
    } else {
        std::vector<format::Float3> floats;
        for (const Double3& p : mesh.positions) {
            floats.push_back(
                {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
        }
        all.push_back(section(SectionId::positions_f32, floats));
    }
    all.push_back(section(SectionId::triangles, mesh.triangles));
    all.push_back(section(SectionId::source_triangle, bvh.order));
    all.push_back(section(SectionId::source_vertex, mesh.source_vertex));
    all.push_back(section(SectionId::bvh_nodes, bvh.nodes));
    if (const auto bits = degenerate_bits(mesh); !bits.empty()) {
        all.push_back(section(SectionId::degenerate_bits, bits));
    }
    all.push_back(section(SectionId::components, components(mesh, bvh.order)));
    all.push_back(section(SectionId::bvh_leaves, bvh.leaves));
    if (!bvh.oriented_nodes.empty()) {
        all.push_back(section(SectionId::oriented_nodes, bvh.oriented_nodes));
    }
    if (!bvh.swept_nodes.empty()) {
        all.push_back(section(SectionId::swept_nodes, bvh.swept_nodes));
    }
    std::erase_if(all, [&](const TinySection& s) { return options.leave_out.contains(s.id); });

    format::FileHeader facts{};
    facts.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
    facts.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size());
    if (edges_cancel(mesh.triangles)) facts.flags |= format::model_closed;
    if (bvh.exact_leaves) facts.flags |= format::model_exact_leaves;
    facts.flags |= format::swept_flags(bvh.swept_kind);
    facts.frame_origin = bvh.frame.origin;
    facts.frame_exponent = bvh.frame.exponent;
    return assemble(facts, all, options.section_alignment);
}

}  // namespace cdprep::test
