// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#ifndef __wasi__  // WebAssembly without files
#include <filesystem>
#endif
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "cdprep/advanced/model_views.h"
#include "cdprep/ask.h"
#include "cdprep/format/api.h"
#include "cdprep/format/file_header.h"
#include "cdprep/format/section_set.h"
#include "cdprep/result.h"

namespace cdprep {

using format::SectionId;
using format::SectionSet;

/// The place of an opened file's bytes.
enum class OpenMode : std::uint8_t {
    /// In the file, mapped: nothing is copied, and processes share the memory. Needs a file that
    /// nobody truncates or rewrites while the Model lives; see Model.
    map,
    /// In memory that the Model owns, aligned to pages. Opening reads the whole file, and allocates
    /// memory of the file's size. Later changes to the file never change an answer. Use it for
    /// network shares, removable media, and files that others truncate.
    copy,
};

/// The options for opening a model. The sections that are not opened are not checked, and only
/// OpenMode::copy reads them.
struct OpenOptions {
    /// The queries to open the model for. Opening fails if the file lacks something that they need.
    /// With Ask::nothing, no query is required: the model serves whatever the opened sections
    /// allow.
    Ask asks = Ask::nothing;
    /// The sections to open, if the file has them, in addition to those of `asks`. Unset: those of
    /// `asks` only, or every section if `asks` is Ask::nothing. bvh_nodes and triangles bring
    /// degenerate_bits with them: Degenerate::skip reads it.
    std::optional<SectionSet> sections = std::nullopt;
    /// The name of bytes in memory, for messages. For a file, messages use its path.
    std::string_view name = "memory";
    /// The mode for a file that a path names. Bytes in memory are used in place.
    OpenMode mode = OpenMode::map;
};

/// The reason why a model does not serve a query.
struct Refusal {
    enum class Reason : std::uint8_t {
        /// The file lacks sections: bake it again. For a LiveModel or a Window, no bake helps.
        not_baked,
        not_opened,  ///< the file has the sections, but they were not opened
    };
    Reason reason;
    std::string message;  ///< a sentence: file, query, missing sections, remedy
};

/// A baked model, open for queries.
///
/// Opening maps the file and checks it once. Nothing is decoded; only OpenMode::copy copies. Spans,
/// and answers that refer to geometry, are valid as long as the Model is alive. Move-only. All
/// const members and all queries may run on any number of threads at once.
///
/// A mapped file must not change while the Model lives:
/// - Replacing it by a rename is safe: the Model keeps the old file mapped. `cdprep bake` writes in
///   this way.
/// - If it is truncated, access to a missing page stops the program with SIGBUS on POSIX. The same
///   happens if a network share or disk fails. No check beforehand can prevent this.
/// - If it is rewritten in place, queries may see the new, unchecked bytes. Answers may then be
///   wrong, and a query may read outside the file or not end.
/// Open with OpenMode::copy if other processes may truncate or rewrite the file.
///
/// No answer depends on the caller's floating-point environment: rounding mode, flushing of
/// subnormal numbers, unmasked exceptions. Each call computes in the default environment and
/// restores the caller's (cdprep/format/float_environment.h).
///
///     auto opened = cdprep::Model::open("bracket.cdp.h5");
///     if (!opened) {
///         std::cerr << opened.error().message << '\n';
///         return 1;
///     }
///     const cdprep::Model& model = opened.value();
///     std::cout << model.triangle_count() << " triangles\n";
class Model {
public:
#ifndef __wasi__
    /// Maps or copies `path`, and completely checks the sections that `options` names. The others
    /// are not checked and give empty spans. Takes O(bytes of the checked sections) time, at memory
    /// speed. OpenMode::copy also takes the time to read the whole file.
    ///
    /// Fails with `unreadable` if the file cannot be read, is not a finished bake, or is damaged.
    /// Fails in the same way if an incompatible version wrote the file, or another tool rewrote it.
    /// Fails with `bad_argument` if the file lacks sections that options.asks needs.
    [[nodiscard]] CDPREP_API static Result<Model> open(const std::filesystem::path& path,
                                                       const OpenOptions& options = {});

    /// Opens as above, with options.asks = asks: only the sections that `asks` needs or uses.
    ///
    ///     auto arm = cdprep::Model::open("arm.cdp.h5", cdprep::Ask::collide);
    [[nodiscard]] CDPREP_API static Result<Model> open(const std::filesystem::path& path, Ask asks);

    /// Opens as above, but only the sections of `wanted` that are present. The model serves
    /// whatever these allow.
    [[nodiscard]] CDPREP_API static Result<Model> open(const std::filesystem::path& path,
                                                       SectionSet wanted);
#endif

    /// Opens bytes that the caller keeps, such as an archive or a network buffer. The bytes are
    /// used in place. They must start at a multiple of format::kSectionAlignment; otherwise fails
    /// with `bad_argument`. They must stay unchanged while the Model lives.
    [[nodiscard]] CDPREP_API static Result<Model> open(std::span<const std::byte> bytes,
                                                       const OpenOptions& options = {});
    [[nodiscard]] CDPREP_API static Result<Model> open(std::span<const std::byte> bytes,
                                                       SectionSet wanted);

#ifndef __wasi__
    /// Maps `path` and checks only the first 4,144 bytes of the file, whatever its size. Use this
    /// function only for files whose hash was verified by other means: a damaged file may crash a
    /// query.
    [[nodiscard]] CDPREP_API static Result<Model> open_trusted(const std::filesystem::path& path);
#endif

    CDPREP_API Model(Model&&) noexcept;
    CDPREP_API Model& operator=(Model&&) noexcept;
    CDPREP_API ~Model();

    /// Returns the number of triangles, from the header. For a Window, or a LiveModel that can
    /// tear, this counts places for triangles, some of which may be empty.
    [[nodiscard]] CDPREP_API std::uint32_t triangle_count() const noexcept;
    [[nodiscard]] CDPREP_API std::uint32_t vertex_count() const noexcept;  ///< from the header
    /// Returns a number that is greater than all triangle numbers in answers. It is
    /// triangle_count(), unless the model belongs to a Window, or to a LiveModel that can tear.
    [[nodiscard]] CDPREP_API std::uint32_t triangle_number_bound() const noexcept;

    [[nodiscard]] CDPREP_API const format::FileHeader& header() const noexcept;

    /// Returns the bytes of the file: mapped, copied or the caller's. find_deep_damage() and the
    /// functions of find_falsehood.h read them.
    [[nodiscard]] CDPREP_API std::span<const std::byte> bytes() const noexcept;

    /// Returns the sections that were requested and are present, and degenerate_bits with some:
    /// see OpenOptions.
    [[nodiscard]] CDPREP_API SectionSet sections() const noexcept;

    /// Reads one byte of each page of the open sections in `wanted`. Returns the size of these
    /// sections in bytes. After this call, the first query does not wait for the disk. Pages may be
    /// evicted later; the caller may lock them (mlock() on bytes()). Pages are assumed to have at
    /// least format::kPageAlignment bytes. Takes as long as the disk needs for pages that are not
    /// in memory, otherwise a few nanoseconds per page. Needs no Ask. Never allocates.
    CDPREP_API std::size_t touch(SectionSet wanted = SectionSet::all()) const noexcept;
    /// As above, for the sections that the queries of `asks` need or use.
    CDPREP_API std::size_t touch(Ask asks) const noexcept;

    /// Returns the features that this model serves, computed once at opening. Calling a query that
    /// the model does not serve aborts the program with a message (precondition.h).
    [[nodiscard]] Ask asks() const noexcept {
        return served_;
    }
    /// Returns whether the model serves all of `asks`.
    [[nodiscard]] bool serves(Ask asks) const noexcept {
        return contains(served_, asks);
    }
    /// Returns why the model does not serve all of `asks`, or nothing if serves(asks) is true.
    /// Allocates.
    [[nodiscard]] CDPREP_API std::optional<Refusal> refusal(Ask asks) const;

    /// Views of the sections (advanced/model_views.h), for tools and for queries that the library
    /// lacks. O(1).
    [[nodiscard]] CDPREP_API const MeshView& mesh() const noexcept;
    [[nodiscard]] CDPREP_API const SourceView& source() const noexcept;
    [[nodiscard]] CDPREP_API const BvhView& bvh() const noexcept;
    [[nodiscard]] CDPREP_API const OctreeView& octree() const noexcept;
    [[nodiscard]] CDPREP_API const AdaptiveOctreeView& adaptive_octree() const noexcept;
    [[nodiscard]] CDPREP_API const TetraTreeView& tetra_tree() const noexcept;
    [[nodiscard]] CDPREP_API const HullView& hulls() const noexcept;
    [[nodiscard]] CDPREP_API const PieceView& pieces() const noexcept;
    [[nodiscard]] CDPREP_API const RecordView& record() const noexcept;

    /// Returns the name with number `index`, from 0, in the section `names`. This section is
    /// instance_names, group_names or material_names. Returns an empty text if there is no such
    /// name. Takes O(index) time.
    [[nodiscard]] CDPREP_API std::string_view name(SectionId names,
                                                   std::uint32_t index) const noexcept;

    /// Returns true for the model of a Window, or of a LiveModel that has ever gained or lost
    /// triangles. Queries about solids then give Answer::unknown, unless bounding boxes or a touch
    /// of the surface decide.
    [[nodiscard]] CDPREP_API bool is_torn() const noexcept;

    /// Returns whether bvh().leaves is not empty and holds model coordinates without loss.
    [[nodiscard]] CDPREP_API bool has_exact_leaves() const noexcept;
    /// Returns whether every edge is used equally often in both directions. Winding numbers then
    /// exist, and queries about solids have exact answers. Returns false if is_torn().
    [[nodiscard]] CDPREP_API bool is_balanced() const noexcept;

private:
    struct State;
    explicit Model(std::unique_ptr<State> state) noexcept;
    [[nodiscard]] static Result<Model> from_bytes(std::span<const std::byte> bytes,
                                                  const OpenOptions& options);
    friend class LiveModel;
    friend class Window;
    void set_lanes(std::span<const std::uint8_t> lanes,
                   std::uint32_t triangle_number_bound) noexcept;
    void set_torn(std::uint32_t triangle_number_bound) noexcept;
    /// Makes this the model of a Window, which serves `asks` alone.
    void set_part(Ask asks) noexcept;
    /// Makes this a live model: refusal() then suggests no bake.
    void set_live() noexcept;
    /// Sets the number of leaves of a Window's model. Also sets its positions, triangles and
    /// oriented boxes; each may be empty.
    void set_leaves(std::uint32_t count, std::span<const format::Double3> positions,
                    std::span<const format::Triangle> triangles,
                    std::span<const format::OrientedNode> oriented) noexcept;
    std::unique_ptr<State> state_;
    Ask served_ = Ask::nothing;
};

}  // namespace cdprep
