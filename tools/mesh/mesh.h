// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cdprep/format/file_header.h"

namespace cdprep::mesh {

using format::Double3;
using format::Triangle;

/// Where an import found a number that no mesh may hold. Data, not an error:
/// bake refuses, validate reports.
struct BadNumber {
    enum class Kind : std::uint8_t {
        not_finite,         ///< vertex `vertex` has a coordinate that is NaN or infinite
        index_out_of_range  ///< triangle `triangle` uses vertex `found` of `limit`
    };
    Kind kind;
    std::uint32_t vertex = 0;    ///< number in the file's order
    std::uint32_t triangle = 0;  ///< source number
    std::int64_t found = 0;      ///< the index as the file has it
    std::int64_t limit = 0;      ///< how many vertices there are
    std::int64_t first = 0;      ///< the number of the first vertex, as the format counts
};

/// Named runs over source triangles: groups or materials. Names are UTF-8.
struct NamedRuns {
    std::vector<format::NamedRun> runs;
    std::vector<std::string> names;
};

/// A file that an import read.
struct InputFile {
    std::string name;        ///< relative to the folder of the file asked for
    std::uint64_t hash = 0;  ///< format::checksum() of its bytes
};

/// What a mesh file held: corners as the file gave them, flattened to one list.
///
/// Triangles stand in source order: nodes depth first, faces in file order, the
/// triangles of an n-gon one after the other; a triangle's place is its source
/// number. A triangle with a corner out of range is kept in its place with all
/// corners set to vertex 0, and is listed in `bad_numbers`.
struct TriangleSoup {
    std::vector<Double3> positions;   ///< model units, node transforms applied
    std::vector<Triangle> triangles;  ///< source order
    std::vector<std::uint32_t> face;  ///< per triangle, face within its instance; empty: 0, 1, 2...
    /// Every coordinate is a float without loss (PRODUCT 3): either it was a
    /// binary float, or a text number of at most 9 significant digits that the
    /// nearest float prints the same. Positions then hold those floats.
    bool single_precision = false;
    std::vector<format::Instance> instances;
    std::vector<std::string> instance_names;  ///< node paths, "root/arm/hand"
    NamedRuns groups;
    NamedRuns materials;
    std::uint64_t source_hash = 0;       ///< format::checksum() of the file asked for
    std::vector<InputFile> other_files;  ///< that it refers to and that were read, by name
    double metres_per_unit = 0;          ///< 0: nobody says
    format::UpAxis up_axis = format::UpAxis::unknown;
    std::vector<BadNumber> bad_numbers;  ///< at most 1000, lowest first
    std::uint64_t bad_number_count = 0;  ///< all of them
};

/// Shared vertices: every stored vertex is used, no two are equal.
struct Mesh {
    std::vector<Double3> positions;
    std::vector<Triangle> triangles;           ///< source order
    std::vector<std::uint32_t> source_vertex;  ///< per vertex: lowest source number it stands for
    bool single_precision = false;
};

}  // namespace cdprep::mesh
