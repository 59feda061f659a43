// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/readers.h"

#include <cstddef>
#include <string_view>
#include <utility>

#include "import/join_chunks.h"
#include "import/read_ply_body.h"
#include "import/text_chunks.h"

namespace cdprep::import {

void add_strip(const std::vector<std::int64_t>& strip, PolygonChunk& chunk) {
    std::size_t first = 0;
    for (std::size_t i = 0; i < strip.size(); ++i) {
        if (strip[i] == -1) first = i + 1;
        if (strip[i] == -1 || i < first + 2) continue;
        const bool odd = (i - first) % 2 == 1;
        for (const std::size_t corner : {odd ? i - 1 : i - 2, odd ? i - 2 : i - 1, i}) {
            chunk.add_corner(strip[corner], strip[corner]);
        }
        chunk.end_face(3);
    }
}

Result<mesh::TriangleSoup> read_ply(const SourceFile& file, const ImportOptions& options) {
    const std::string_view bytes = without_byte_order_mark(file.bytes());
    if (!bytes.starts_with("ply")) {
        return file.unreadable("line 1: a PLY file begins with 'ply', not with " +
                               quoted_word(bytes.data(), bytes.data() + bytes.size()));
    }
    const Result<PlyHeader> header = read_ply_header(file);
    if (!header) return header.error();
    const bool is_text = header.value().format == PlyHeader::Format::text;
    Result<std::vector<PolygonChunk>> chunks = is_text
                                                   ? read_ply_text(file, header.value(), options)
                                                   : read_ply_binary(file, header.value(), options);
    if (!chunks) return chunks.error();
    return join_chunks(
        file, std::move(chunks.value()),
        {.memory_bytes = options.memory_bytes, .parallel_for = options.parallel_for});
}

}  // namespace cdprep::import
