// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "study/table.h"

/// What "A comparative study of implemented collision detection strategies" printed in its
/// Tables 1 to 4, and what of it cannot be right.
namespace cdprep::study {

/// Pre-processing of one structure over one model.
struct PublishedBuild {
    double seconds;
    double mebibytes;     ///< printed as MB; the sizes of PQP show what is meant
    const char* erratum;  ///< what cannot be right about the size, or empty
};

/// A row of Tables 2 and 3.
struct PublishedModel {
    const char* name;
    std::uint32_t vertices;
    std::uint32_t triangles;
    PublishedBuild tetra_tree;
    PublishedBuild octree;
    PublishedBuild hull;
    PublishedBuild pqp;
    std::optional<PublishedBuild> swift;  ///< nothing: "Not 2-manifold"
};
inline constexpr std::size_t kPublishedModels = 6;
extern const std::array<PublishedModel, kPublishedModels> kPublished;

/// Seconds of a row of Table 4, with errata where there are any.
struct PublishedPair {
    std::size_t a;  ///< in kPublished
    std::size_t b;
    double octree_collide, octree_overlap;
    double tetra_collide, tetra_overlap;
    double pqp_collide, pqp_overlap;
    bool has_swift;              ///< "about 0" rather than "Not-2-Manifold"
    const char* octree_erratum;  ///< or empty
    const char* pqp_erratum;     ///< of its overlapping triangles, or empty
};
extern const std::array<PublishedPair, 12> kPublishedPairs;

/// The pair in either order; null when it was not published.
[[nodiscard]] const PublishedPair* find_published_pair(std::size_t a, std::size_t b) noexcept;

/// Which published model a mesh is, and how surely.
struct Likeness {
    std::optional<std::size_t> model;  ///< in kPublished; its figures may stand beside
    Mark mark = Mark::none;            ///< none: the published counts
    std::string sentence;  ///< for people: what the mesh is, or why nothing stands beside
    /// The model that it is a version of, if of any, also where counts are too far apart for
    /// figures to stand beside.
    std::optional<std::size_t> version_of{};
};

/// By the hash of its geometry where that is known, else by its counts. A mesh with counts of
/// its own has no published figures beside it, but the sentence says of which model it is a
/// reduced copy where that is known. Counts and hash (geometry_hash()) are as read.
[[nodiscard]] Likeness find_likeness(std::size_t vertices, std::size_t triangles,
                                     std::uint64_t hash);

/// Checksum of positions in double, then of triangles' vertex numbers, as read.
[[nodiscard]] std::uint64_t geometry_hash(std::span<const std::byte> positions,
                                          std::span<const std::byte> triangles);

/// The figure as it stands in a cell beside one of `likeness`: a dash with the reason where that
/// is a version of a model whose counts are too far apart; nothing of a mesh of no model.
[[nodiscard]] std::optional<Published> beside(const Likeness& likeness, double value,
                                              const char* erratum = "");

/// What is wrong with the printed tables as a whole: a sentence each.
[[nodiscard]] std::span<const char* const> published_errata() noexcept;

/// Bytes of PQP's hierarchy over `triangles`: 2n - 1 nodes, n triangles and a header, with
/// doubles aligned to 4 as in the paper, or to 8 as today.
[[nodiscard]] constexpr double pqp_bytes_32(double triangles) noexcept {
    return (2 * triangles - 1) * 172 + triangles * 76 + 36;
}
[[nodiscard]] constexpr double pqp_bytes_64(double triangles) noexcept {
    return (2 * triangles - 1) * 176 + triangles * 80;
}

}  // namespace cdprep::study
