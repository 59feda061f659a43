// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "import/import_file.h"
#include "import/source_file.h"

namespace cdprep::import {

/// Reads Wavefront OBJ: v and f in all spellings, g, o and usemtl; lines may end
/// in LF or CR LF and be continued with a backslash. Everything else (normals,
/// points, lines, free forms) is skipped. Faces may use vertices that follow.
[[nodiscard]] Result<mesh::TriangleSoup> read_obj(const SourceFile& file,
                                                  const ImportOptions& options);

/// True when the first lines are those of an OBJ file with vertices.
[[nodiscard]] bool looks_like_obj(std::string_view bytes) noexcept;

/// Reads text OFF with any of the prefixes ST, C and N: one vertex or face a
/// line; normals, colours and texture coordinates are skipped. Without a prefix, rows may
/// be wrapped or joined where there are numbers of vertices and faces alone. Counts that the
/// file is too short for are unreadable, before anything is allocated by them;
/// so are binary files and those of other dimensions than 3.
[[nodiscard]] Result<mesh::TriangleSoup> read_off(const SourceFile& file,
                                                  const ImportOptions& options);

/// True when the first word that is no comment is OFF with any prefix.
[[nodiscard]] bool looks_like_off(std::string_view bytes) noexcept;

/// Reads PLY, text and binary of either byte order: x, y and z of the vertices
/// and the vertex lists of faces and triangle strips, of any number type, between
/// any other properties and elements.
///
/// In text files an element is a line; numbers behind those that the header
/// announces are skipped. Counts that the file is too short for are unreadable,
/// before anything is allocated by them.
[[nodiscard]] Result<mesh::TriangleSoup> read_ply(const SourceFile& file,
                                                  const ImportOptions& options);

/// Reads STL, binary or text. Every triangle has three vertices of its own;
/// normals and colours are skipped; the solids of a text file are its groups.
///
/// A file is binary when its length is what its count says, whatever its first
/// word; else it is text when it looks like it. A binary file of another length
/// and a text file that ends inside a solid are unreadable.
[[nodiscard]] Result<mesh::TriangleSoup> read_stl(const SourceFile& file,
                                                  const ImportOptions& options);

/// True when the length is that of a binary STL file with its count.
[[nodiscard]] bool is_binary_stl(std::string_view bytes) noexcept;

/// True when the text begins with a solid and, soon, a facet or its end.
[[nodiscard]] bool looks_like_text_stl(std::string_view bytes) noexcept;

}  // namespace cdprep::import
