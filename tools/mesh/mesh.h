// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cdprep/format/file_header.h"

namespace cdprep::mesh {

using format::Double3;
using format::Triangle;

/// The place of an invalid number in an import. This is data, not an error: bake refuses it,
/// validate reports it.
struct BadNumber {
    enum class Kind : std::uint8_t {
        not_finite,         ///< vertex `vertex` has a coordinate that is NaN or infinite
        index_out_of_range  ///< triangle `triangle` uses vertex `found` of `limit`
    };
    Kind kind;
    std::uint32_t vertex = 0;    ///< number in file order
    std::uint32_t triangle = 0;  ///< source number
    std::int64_t found = 0;      ///< the index in the file
    std::int64_t limit = 0;      ///< the number of vertices
    std::int64_t first = 0;      ///< the number of the first vertex in this format
};

/// A triangle with a corner out of range.
struct OutOfRange {
    std::uint32_t triangle;  ///< source number
    std::int64_t found;      ///< the number of its first such corner in the file
};

/// Named runs over source triangles: groups or materials. Names are UTF-8.
struct NamedRuns {
    std::vector<format::NamedRun> runs;
    std::vector<std::string> names;
};

/// A file that an import read.
struct InputFile {
    std::string name;        ///< relative to the folder of the requested file
    std::uint64_t hash = 0;  ///< format::checksum() of its bytes
};

/// The content of a mesh file: corners as in the file, flattened to one list.
///
/// Triangles are in source order: nodes depth first, faces in file order, the triangles of an
/// n-gon one after the other. The position of a triangle is its source number. A triangle with a
/// corner out of range keeps its position; all its corners are vertex 0, and `out_of_range` lists
/// it.
struct TriangleSoup {
    std::vector<Double3> positions;   ///< model units, node transforms applied
    std::vector<Triangle> triangles;  ///< source order
    std::vector<std::uint32_t> face;  ///< by triangle, face within its instance; empty: 0, 1, 2...
    /// Every coordinate is a float without loss. It was a binary float, or a text number of at
    /// most 9 significant digits. The nearest float prints as the same number. Positions then
    /// hold those floats.
    bool single_precision = false;
    std::vector<format::Instance> instances;
    std::vector<std::string> instance_names;  ///< node paths, "root/arm/hand"
    NamedRuns groups;
    NamedRuns materials;
    std::uint64_t source_hash = 0;       ///< format::checksum() of the requested file
    std::vector<InputFile> other_files;  ///< files that it refers to and that were read, by name
    double metres_per_unit = 0;          ///< 0: unknown
    format::UpAxis up_axis = format::UpAxis::unknown;
    std::vector<std::string> remarks;    ///< sentences on content that the import did not apply
    std::vector<BadNumber> bad_numbers;  ///< the first 1000 at most, lowest first
    std::uint64_t bad_number_count = 0;  ///< of all bad numbers
    /// All triangles with a corner out of range, ascending; bad_numbers may lack some.
    std::vector<OutOfRange> out_of_range;
};

/// A mesh with shared vertices: every stored vertex is used, and no two are equal.
struct Mesh {
    std::vector<Double3> positions;
    std::vector<Triangle> triangles;           ///< source order
    std::vector<std::uint32_t> source_vertex;  ///< per vertex: lowest source number it represents
    bool single_precision = false;
};

}  // namespace cdprep::mesh
