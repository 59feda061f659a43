// SPDX-License-Identifier: MIT
// The proof on real models: every triangle in exactly one piece, every one exactly on its
// hull. The models are not ours to keep here: without them everything is skipped.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "decompose/surface/surface_pieces.h"
#include "import/import_file.h"
#include "mesh/normalize.h"
#include "mesh/weld.h"
#include "support/run_threads.h"
#include "support/shared_models.h"
#include "unit/tools/pieces_flaw.h"

namespace cdprep::convex {
namespace {

/// As bake does with --normalize; nothing where bake would refuse.
std::optional<mesh::Mesh> load(const std::filesystem::path& path) {
    Result<mesh::TriangleSoup> imported = import::import_file(path);
    if (!imported || imported.value().bad_number_count > 0) return std::nullopt;
    mesh::TriangleSoup soup = std::move(imported).value();
    mesh::normalize(soup);
    return mesh::weld(soup).mesh;
}

/// Every `step`-th piece that is said to be contained, against all triangles of its model.
std::string sampled_containment_flaw(const mesh::Mesh& mesh, SurfacePieces pieces,
                                     std::size_t step) {
    for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
        if (i % step != 0) pieces.pieces[i].contained = false;
    }
    return test::containment_flaw(mesh, pieces);
}

struct Expected {
    const char* name;
    std::size_t most_pieces;  ///< 1 % more than SWIFT++'s fewest; where it stops, as many as there
};

TEST(SurfacePiecesModels, SeedModelsAreCutExactlyIntoFewPieces) {
    const auto folder = test::shared_models("seed");
    if (!folder) GTEST_SKIP() << "no test models beside the checkout (set CDPREP_SHARED)";
    for (const Expected& expected :
         {Expected{"skull", 11413}, Expected{"bunny", 16702}, Expected{"armadillo", 26256},
          Expected{"buddha", 34704}, Expected{"horse", 2000}, Expected{"dragon", 250000}}) {
        const auto mesh = load(*folder / "seed" / (std::string(expected.name) + ".ply"));
        ASSERT_TRUE(mesh) << expected.name;
        const SurfacePieces pieces = find_surface_pieces(*mesh);
        EXPECT_EQ(test::partition_flaw(*mesh, pieces), "") << expected.name;
        EXPECT_EQ(test::hull_face_flaw(*mesh, pieces), "") << expected.name;
        EXPECT_LE(pieces.pieces.size(), expected.most_pieces) << expected.name;
        const std::size_t step = pieces.pieces.size() / 50 + 1;
        if (mesh->triangles.size() > 100000) continue;
        EXPECT_EQ(sampled_containment_flaw(*mesh, pieces, step), "") << expected.name;
    }
}

// Open, not manifold, crossing itself, without area: whatever is there.
TEST(SurfacePiecesModels, HardModelsAreCutExactly) {
    const auto folder = test::shared_models("seed");
    if (!folder) GTEST_SKIP() << "no test models beside the checkout (set CDPREP_SHARED)";
    std::size_t cut = 0;
    for (const auto& entry : std::filesystem::directory_iterator(*folder / "hard")) {
        const std::string name = entry.path().filename().string();
        if (!entry.is_regular_file() || name.ends_with(".md")) continue;
        const auto mesh = load(entry.path());
        if (!mesh) continue;
        ++cut;
        for (const double tolerance : {0.0, 1e-3}) {
            const SurfacePieces pieces = find_surface_pieces(*mesh, {.tolerance = tolerance});
            EXPECT_EQ(test::partition_flaw(*mesh, pieces), "") << name;
            if (tolerance > 0) continue;
            EXPECT_EQ(test::hull_face_flaw(*mesh, pieces), "") << name;
        }
    }
    EXPECT_GE(cut, 20U);
}

TEST(SurfacePiecesModels, ToleranceSavesPieces) {
    const auto folder = test::shared_models("seed");
    if (!folder) GTEST_SKIP() << "no test models beside the checkout (set CDPREP_SHARED)";
    for (const auto& [name, most] : {std::pair{"bunny", 0.06}, std::pair{"dragon", 0.02}}) {
        const auto mesh = load(*folder / "seed" / (std::string(name) + ".ply"));
        ASSERT_TRUE(mesh) << name;
        const SurfacePieces pieces = find_surface_pieces(*mesh, {.tolerance = 1e-3});
        EXPECT_EQ(test::partition_flaw(*mesh, pieces), "") << name;
        EXPECT_LE(static_cast<double>(pieces.pieces.size()),
                  most * static_cast<double>(mesh->triangles.size()));
        for (const SurfacePiece& piece : pieces.pieces) EXPECT_LE(piece.outer_error, 1e-3);
    }
}

TEST(SurfacePiecesModels, ThreadsChangeNothing) {
    const auto folder = test::shared_models("seed");
    if (!folder) GTEST_SKIP() << "no test models beside the checkout (set CDPREP_SHARED)";
    const auto mesh = load(*folder / "seed" / "skull.ply");
    ASSERT_TRUE(mesh);
    const SurfacePieces alone = find_surface_pieces(*mesh);
    for (std::size_t threads = 2; threads <= 8; ++threads) {
        const auto run = [&](std::size_t count, Task task) {
            test::run_threads(std::min(count, threads), [&](std::size_t thread) {
                for (std::size_t i = thread; i < count; i += threads) task(i);
            });
        };
        const SurfacePieces together = find_surface_pieces(*mesh, {.parallel_for = run});
        EXPECT_EQ(alone.triangles, together.triangles);
        EXPECT_EQ(alone.first, together.first);
    }
}

}  // namespace
}  // namespace cdprep::convex
