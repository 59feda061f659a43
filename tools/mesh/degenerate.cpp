// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/degenerate.h"

#include <algorithm>

#include "triangle_contact.h"

namespace cdprep::mesh {

std::vector<std::uint64_t> find_degenerate(const Mesh& mesh, ParallelFor parallel_for) {
    constexpr std::size_t kBits = 64;
    constexpr std::size_t kWordsPerTask = 64;
    std::vector<std::uint64_t> words((mesh.triangles.size() + kBits - 1) / kBits);
    parallel_for((words.size() + kWordsPerTask - 1) / kWordsPerTask, [&](std::size_t task) {
        const std::size_t first = task * kWordsPerTask * kBits;
        const std::size_t last = std::min(first + kWordsPerTask * kBits, mesh.triangles.size());
        for (std::size_t i = first; i < last; ++i) {
            const auto& v = mesh.triangles[i].vertex;
            if (is_degenerate({mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]})) {
                words[i / kBits] |= std::uint64_t{1} << (i % kBits);
            }
        }
    });
    const bool any = std::any_of(words.begin(), words.end(), [](auto word) { return word != 0; });
    if (!any) words.clear();
    return words;
}

}  // namespace cdprep::mesh
