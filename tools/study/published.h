// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "study/table.h"

/// The figures printed in Tables 1 to 4 of "A comparative study of implemented collision detection
/// strategies" (the comparative study), and their errata.
namespace cdprep::study {

/// The time and memory to build one structure over one model.
struct PublishedBuild {
    double seconds;
    double mebibytes;     ///< printed as MB; the sizes of PQP show that MiB is meant
    const char* erratum;  ///< why the size cannot be right, or empty
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

/// The seconds of a row of Table 4, with errata.
struct PublishedPair {
    std::size_t a;  ///< in kPublished
    std::size_t b;
    double octree_collide, octree_overlap;
    double tetra_collide, tetra_overlap;
    double pqp_collide, pqp_overlap;
    bool has_swift;              ///< "about 0" rather than "Not-2-Manifold"
    const char* octree_erratum;  ///< or empty
    const char* pqp_erratum;     ///< for overlapping triangles, or empty
};
extern const std::array<PublishedPair, 12> kPublishedPairs;

/// Returns the published pair of two models, in either order, or null if there is none.
[[nodiscard]] const PublishedPair* find_published_pair(std::size_t a, std::size_t b) noexcept;

/// The published model that a mesh is or resembles.
struct Likeness {
    std::optional<std::size_t> model;  ///< in kPublished; its figures may be shown beside ours
    Mark mark = Mark::none;            ///< none: the published counts
    std::string sentence;              ///< text: what the mesh is, or why no figures are shown
    /// The model that the mesh is a version of, if any. It is also set if the counts differ too
    /// much to show the published figures.
    std::optional<std::size_t> version_of{};
};

/// Returns the published model of a mesh, by the hash of its geometry if that is known, else by its
/// counts. A mesh with other counts has no published figures. If it is a known reduced copy, the
/// sentence names its model. The counts and the hash (geometry_hash()) are those of the mesh as
/// read.
[[nodiscard]] Likeness find_likeness(std::size_t vertices, std::size_t triangles,
                                     std::uint64_t hash);

/// Returns the checksum of positions in double followed by the triangles' vertex numbers, as read.
[[nodiscard]] std::uint64_t geometry_hash(std::span<const std::byte> positions,
                                          std::span<const std::byte> triangles);

/// Returns the published figure for a cell about the mesh of `likeness`. Returns a dash with the
/// reason if the mesh is a version of a model but its counts differ too much. Returns nothing if
/// the mesh is no version of a published model.
[[nodiscard]] std::optional<Published> beside(const Likeness& likeness, double value,
                                              const char* erratum = "");

/// Returns the errata of the printed tables, one or more sentences each.
[[nodiscard]] std::span<const char* const> published_errata() noexcept;

/// Returns the bytes of PQP's hierarchy over n triangles: 2n - 1 nodes, n triangles and a header.
/// pqp_bytes_32() aligns doubles to 4 bytes, as in the comparative study. pqp_bytes_64() aligns
/// them to 8, as today, and counts no header.
[[nodiscard]] constexpr double pqp_bytes_32(double triangles) noexcept {
    return (2 * triangles - 1) * 172 + triangles * 76 + 36;
}
[[nodiscard]] constexpr double pqp_bytes_64(double triangles) noexcept {
    return (2 * triangles - 1) * 176 + triangles * 80;
}

}  // namespace cdprep::study
