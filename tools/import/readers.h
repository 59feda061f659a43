// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "import/import_file.h"
#include "import/source_file.h"

namespace cdprep::import {

// Text may begin with the byte order mark of UTF-8.

/// Reads Wavefront OBJ: v and f in all spellings, g, o and usemtl. Lines may end in LF or CR LF,
/// and a backslash may continue them. Everything else (normals, points, lines, free forms) is
/// skipped. Faces may use later vertices.
[[nodiscard]] Result<mesh::TriangleSoup> read_obj(const SourceFile& file,
                                                  const ImportOptions& options);

/// Returns true if the first lines are those of an OBJ file with vertices.
[[nodiscard]] bool looks_like_obj(std::string_view bytes) noexcept;

/// Reads text OFF with any of the prefixes ST, C and N, one vertex or face per line. Normals,
/// colours and texture coordinates are skipped. Without a prefix, rows may be wrapped or joined if
/// the file has only the numbers of vertices and faces. Fails with `unreadable` if the file is too
/// short for its counts, before memory is allocated for them. Also fails so on binary files and on
/// dimensions other than 3.
[[nodiscard]] Result<mesh::TriangleSoup> read_off(const SourceFile& file,
                                                  const ImportOptions& options);

/// Returns true if the first word outside comments is OFF with any prefix.
[[nodiscard]] bool looks_like_off(std::string_view bytes) noexcept;

/// Reads PLY, text and binary of either byte order. Takes x, y and z of the vertices and the
/// vertex lists of faces and triangle strips, of any number type. Skips all other properties
/// and elements.
///
/// In text files an element is a line; numbers after those that the header
/// declares are skipped. Fails with `unreadable` if the file is too short for its counts,
/// before memory is allocated for them.
[[nodiscard]] Result<mesh::TriangleSoup> read_ply(const SourceFile& file,
                                                  const ImportOptions& options);

/// Reads STL, binary or text. Every triangle has three vertices of its own;
/// normals and colours are skipped; the solids of a text file are its groups. A solid may be one
/// line, and a line may have several.
///
/// A file is binary if its length matches its count, whatever its first word is. Otherwise
/// looks_like_text_stl() decides. Fails with `unreadable` on a binary file of another length and
/// on a text file that ends inside a solid.
[[nodiscard]] Result<mesh::TriangleSoup> read_stl(const SourceFile& file,
                                                  const ImportOptions& options);

/// Returns true if the length is that of a binary STL file with its count.
[[nodiscard]] bool is_binary_stl(std::string_view bytes) noexcept;

/// Returns true if the text begins with a solid, soon followed by a facet or by the solid's end.
[[nodiscard]] bool looks_like_text_stl(std::string_view bytes) noexcept;

}  // namespace cdprep::import
