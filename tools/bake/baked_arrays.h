// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/structures.h"
#include "cdprep/advanced/build_bvh.h"
#include "cdprep/advanced/section_list.h"
#include "cdprep/format/section_set.h"
#include "cdprep/format/verdict.h"
#include "decompose/surface/contact_arrays.h"
#include "decompose/surface/piece_arrays.h"
#include "decompose/surface/piece_tree.h"
#include "mesh/mesh.h"

namespace cdprep::cli {

/// The texts that a bake stores, and the verdicts on its mesh.
struct BakedNotes {
    std::vector<format::Verdict> verdicts;
    std::string findings;                      ///< JSON
    std::string provenance;                    ///< JSON
    std::vector<std::uint32_t> repaired_from;  ///< empty: nothing was repaired
};

/// Everything a baked file may hold, as arrays that sections can point into.
class BakedArrays {
public:
    /// Copies from `soup` the facts about the source that a file holds. `ordered` and `bvh` are in
    /// tree order. `degenerate` has the form that find_degenerate() returns.
    BakedArrays(const mesh::TriangleSoup& soup, mesh::Mesh ordered, build::Bvh bvh,
                std::vector<std::uint64_t> degenerate, std::vector<format::Component> components,
                const format::Bounds& bounds, const std::optional<format::MassProperties>& mass,
                BakedNotes notes);

    /// Adds the structures that were built over mesh().
    void keep(Structures structures);

    /// Adds the pieces of mesh()'s surface, and the hierarchy over them.
    void keep(convex::PieceArrays pieces, convex::PieceTree tree);
    /// Adds the arrays that contacts between pieces use besides the pieces.
    void keep(convex::ContactArrays contacts);
    [[nodiscard]] const convex::PieceArrays& pieces() const noexcept {
        return pieces_;
    }

    /// Returns views of the sections in `wanted`, without those whose absence means the same as
    /// an empty array. The views are valid while this object lives and does not move.
    [[nodiscard]] build::SectionList sections(format::SectionSet wanted) const;

    [[nodiscard]] const mesh::Mesh& mesh() const noexcept {
        return mesh_;
    }
    [[nodiscard]] const build::Bvh& bvh() const noexcept {
        return bvh_;
    }
    [[nodiscard]] const Structures& structures() const noexcept {
        return structures_;
    }
    [[nodiscard]] std::size_t component_count() const noexcept {
        return components_.size();
    }
    [[nodiscard]] std::size_t degenerate_count() const noexcept;

private:
    mesh::Mesh mesh_;
    build::Bvh bvh_;
    std::vector<std::uint64_t> degenerate_;
    std::vector<format::Component> components_;
    std::vector<format::Bounds> bounds_;
    std::vector<format::MassProperties> mass_;
    BakedNotes notes_;
    Structures structures_;
    convex::PieceArrays pieces_;
    convex::PieceTree piece_tree_;
    convex::ContactArrays contacts_;
    std::vector<format::Float3> floats_;
    std::vector<std::uint32_t> face_;
    std::vector<format::Instance> instances_;
    mesh::NamedRuns groups_;
    mesh::NamedRuns materials_;
    std::string instance_names_;
    std::string group_names_;
    std::string material_names_;
};

}  // namespace cdprep::cli
