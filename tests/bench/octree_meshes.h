// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench_input.h"
#include "cell_searches/search_contenders.h"
#include "support/meshes.h"
#include "support/more_sections.h"

namespace cdprep {

/// A mesh that octrees are made of.
struct OctreeMesh {
    std::string name;
    mesh::Mesh mesh;
};

/// The bakes of these names, or, without a folder, a sphere of 327,680 triangles.
inline std::vector<OctreeMesh> octree_meshes(const std::filesystem::path& bakes,
                                             const std::vector<std::string>& names) {
    std::vector<OctreeMesh> meshes;
    const auto add = [&](const std::string& name, const auto& read) {
        meshes.push_back(
            {name,
             {.positions = read.positions, .triangles = read.triangles, .source_vertex = {}}});
    };
    if (bakes.empty()) add("sphere", test::icosphere(7));
    for (const std::string& name : names) {
        if (bakes.empty()) break;
        add(name, test::builder_input(open_or_stop(bakes / (name + ".cdp.h5"))));
    }
    return meshes;
}

/// The share of points in leaves; ends the program unless all contenders find the same.
inline double share_found(const std::vector<study::search::Contender>& contenders,
                          std::span<const Double3> points) {
    const study::search::Found found = study::search::compare_leaves(contenders, points);
    if (!found.other.empty()) {
        stop(found.other + " finds other leaves than " + contenders.front().name + ".");
    }
    return found.share;
}

}  // namespace cdprep
