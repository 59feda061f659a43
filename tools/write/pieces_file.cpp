// SPDX-License-Identifier: GPL-3.0-or-later
#include "write/pieces_file.h"

#include <array>
#include <vector>

#include "write/mesh_bytes.h"
#include "write/output_file.h"

namespace cdprep::write {
namespace {

/// Colours that are easy to distinguish. Neighbouring pieces seldom have the same colour.
constexpr std::array<std::array<std::uint8_t, 3>, 12> kColours = {{{166, 206, 227},
                                                                   {31, 120, 180},
                                                                   {178, 223, 138},
                                                                   {51, 160, 44},
                                                                   {251, 154, 153},
                                                                   {227, 26, 28},
                                                                   {253, 191, 111},
                                                                   {255, 127, 0},
                                                                   {202, 178, 214},
                                                                   {106, 61, 154},
                                                                   {255, 255, 153},
                                                                   {177, 89, 40}}};

/// Returns the colour number of a piece. Mixes the bits, because consecutive pieces are neighbours.
std::size_t colour_of(std::uint32_t piece) {
    std::uint32_t mixed = piece * 2654435761U;
    mixed ^= mixed >> 15U;
    return mixed % kColours.size();
}

std::string grouped_obj(const MeshArrays& mesh, const PieceLists& pieces) {
    std::string text;
    append_positions(text, mesh, "v ");
    for (std::size_t piece = 0; piece + 1 < pieces.first.size(); ++piece) {
        text += "g piece_";
        append_integer(text, piece);
        text += '\n';
        for (std::uint32_t i = pieces.first[piece]; i < pieces.first[piece + 1]; ++i) {
            append_triangle(text, mesh.triangles[pieces.triangles[i]], "f ", 1);
        }
    }
    return text;
}

std::string coloured_ply(const MeshArrays& mesh, const PieceLists& pieces) {
    std::vector<std::uint32_t> piece_of(mesh.triangles.size(), 0);
    for (std::uint32_t piece = 0; piece + 1 < pieces.first.size(); ++piece) {
        for (std::uint32_t i = pieces.first[piece]; i < pieces.first[piece + 1]; ++i) {
            piece_of[pieces.triangles[i]] = piece;
        }
    }
    std::string bytes =
        ply_header(mesh.positions.size(), mesh.single_precision, "", mesh.triangles.size(),
                   "\nproperty uchar red\nproperty uchar green"
                   "\nproperty uchar blue\nproperty uint piece");
    for (const format::Double3& p : mesh.positions) append_point(bytes, p, mesh.single_precision);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        append_bytes(bytes, std::uint8_t{3});
        for (const std::uint32_t vertex : mesh.triangles[i].vertex) append_bytes(bytes, vertex);
        append_bytes(bytes, kColours[colour_of(piece_of[i])]);
        append_bytes(bytes, piece_of[i]);
    }
    return bytes;
}

}  // namespace

Result<Done> write_pieces(const std::filesystem::path& path, const MeshArrays& mesh,
                          const PieceLists& pieces) {
    const std::optional<MeshFormat> format = mesh_format_of(path);
    if (format == MeshFormat::obj) return write_whole(path, grouped_obj(mesh, pieces));
    if (format == MeshFormat::ply) return write_whole(path, coloured_ply(mesh, pieces));
    return Error{ErrorCode::bad_argument,
                 path.string() + ": pieces can be written as .obj or .ply only."};
}

}  // namespace cdprep::write
