// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "cdprep/advanced/model_views.h"
#include "cdprep/ask.h"
#include "cdprep/format/file_header.h"
#include "cdprep/format/section_set.h"
#include "cdprep/result.h"

namespace cdprep {

using format::SectionId;
using format::SectionSet;

/// Where the bytes of an opened file are.
enum class OpenMode : std::uint8_t {
    /// In the file, mapped: nothing is copied, and processes share the memory. Needs a file that
    /// nobody truncates or rewrites while the Model lives; see Model.
    map,
    /// In memory that the Model owns, aligned to pages. Costs reading the whole file at opening,
    /// and its size in memory. Whatever happens to the file then, the answers stay the same. For
    /// network shares, removable media, and files that others truncate.
    copy,
};

/// How a model is opened. Only the sections that are opened are checked and read.
struct OpenOptions {
    /// What will be asked. Opening fails when the file was baked without something that this
    /// needs. Nothing: whatever the file has can be asked.
    Ask asks = Ask::nothing;
    /// The sections to open where the file has them, beside those of `asks`. Unset: those of
    /// `asks` alone, or every section when `asks` is nothing.
    std::optional<SectionSet> sections = std::nullopt;
    /// Stands for the file in messages about bytes in memory.
    std::string_view name = "memory";
    /// Of a path; bytes in memory are used where they are.
    OpenMode mode = OpenMode::map;
};

/// Why a model does not serve a question.
struct Refusal {
    enum class Reason : std::uint8_t {
        not_baked,   ///< the file lacks sections: bake it again
        not_opened,  ///< the file has them, but they were not asked for at opening
    };
    Reason reason;
    std::string message;  ///< a sentence: file, question, missing sections, what to do
};

/// A baked model, open for queries.
///
/// Opening maps the file and checks it once; nothing is decoded, and nothing copied unless
/// OpenMode::copy asks for it. Every span and every answer that refers to geometry is valid as long
/// as the Model is alive. Move-only. All const members and all queries may run on any number of
/// threads at once.
///
/// A mapped file must stay as it is while the Model lives:
/// - Replacing it by rename is safe: the Model keeps the old file, also when that has no name any
///   more. `cdprep bake` writes in this way.
/// - When it is truncated, or a network share or disk fails, touching a page that is not there
///   stops the program with SIGBUS on POSIX. Nothing can be checked beforehand.
/// - When it is rewritten in place, queries may see the new bytes, which nobody has checked:
///   answers may be wrong, and a query may read outside the file or not end.
/// Open with OpenMode::copy where others may do so.
///
/// No answer depends on the caller's floating-point environment: rounding mode, flushing of
/// subnormal numbers, unmasked exceptions. Each call computes in the default one and restores the
/// caller's (cdprep/format/float_environment.h).
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
    /// Maps or copies `path` and checks completely the sections that `options` names; the others
    /// are not touched and give empty spans. Fails with `unreadable` when the file cannot be read,
    /// is not a finished bake, was written by an incompatible version, was rewritten by another
    /// tool, or is damaged; with `bad_argument` when it lacks sections that options.asks needs.
    /// O(bytes of the sections), at memory speed.
    [[nodiscard]] static Result<Model> open(const std::filesystem::path& path,
                                            const OpenOptions& options = {});

    /// The same with options.asks: opens the sections that `asks` needs or uses, and no others.
    ///
    ///     auto arm = cdprep::Model::open("arm.cdp.h5", cdprep::Ask::collide);
    [[nodiscard]] static Result<Model> open(const std::filesystem::path& path, Ask asks);

    /// The same with those of `wanted` that are present; whatever they serve can be asked.
    [[nodiscard]] static Result<Model> open(const std::filesystem::path& path, SectionSet wanted);

    /// The same for bytes that the caller keeps: an archive, a network buffer. They must start at
    /// a multiple of format::kSectionAlignment and stay as they are while the Model lives.
    [[nodiscard]] static Result<Model> open(std::span<const std::byte> bytes,
                                            const OpenOptions& options = {});
    [[nodiscard]] static Result<Model> open(std::span<const std::byte> bytes, SectionSet wanted);

    /// Maps `path` and checks its first 4,144 bytes alone, whatever its size. For files whose hash
    /// the caller has verified by other means: a damaged one may crash a query.
    [[nodiscard]] static Result<Model> open_trusted(const std::filesystem::path& path);

    Model(Model&&) noexcept;
    Model& operator=(Model&&) noexcept;
    ~Model();

    [[nodiscard]] std::uint32_t triangle_count() const noexcept;  ///< from the header
    [[nodiscard]] std::uint32_t vertex_count() const noexcept;    ///< from the header

    [[nodiscard]] const format::FileHeader& header() const noexcept;

    /// The bytes of the file: mapped, copied or the caller's. find_deep_damage() and the functions
    /// of find_falsehood.h read them.
    [[nodiscard]] std::span<const std::byte> bytes() const noexcept;

    /// Sections that were asked for and are present.
    [[nodiscard]] SectionSet sections() const noexcept;

    /// What can be asked of this model, computed once at opening. A question that is not served
    /// stops the program with a sentence (precondition.h).
    [[nodiscard]] Ask asks() const noexcept {
        return served_;
    }
    /// True when all of `asks` can be asked.
    [[nodiscard]] bool serves(Ask asks) const noexcept {
        return contains(served_, asks);
    }
    /// Returns why not all of `asks` can be asked, or nothing when serves() is true. Allocates.
    [[nodiscard]] std::optional<Refusal> refusal(Ask asks) const;

    /// Views of the sections (advanced/model_views.h): for tools, and for questions that the
    /// library does not answer. O(1).
    [[nodiscard]] const MeshView& mesh() const noexcept;
    [[nodiscard]] const SourceView& source() const noexcept;
    [[nodiscard]] const BvhView& bvh() const noexcept;
    [[nodiscard]] const OctreeView& octree() const noexcept;
    [[nodiscard]] const AdaptiveOctreeView& adaptive_octree() const noexcept;
    [[nodiscard]] const TetraTreeView& tetra_tree() const noexcept;
    [[nodiscard]] const HullView& hulls() const noexcept;
    [[nodiscard]] const PieceView& pieces() const noexcept;
    [[nodiscard]] const RecordView& record() const noexcept;

    /// Name number `index` of instance_names, group_names or material_names;
    /// empty when there is none. O(index).
    [[nodiscard]] std::string_view name(SectionId names, std::uint32_t index) const noexcept;

    /// True when bvh().leaves is not empty and holds model coordinates without loss.
    [[nodiscard]] bool has_exact_leaves() const noexcept;
    /// True when the directed uses of every edge cancel. Winding numbers then exist, and questions
    /// about solids have exact answers.
    [[nodiscard]] bool is_balanced() const noexcept;

private:
    struct State;
    explicit Model(std::unique_ptr<State> state) noexcept;
    [[nodiscard]] static Result<Model> from_bytes(std::span<const std::byte> bytes,
                                                  const OpenOptions& options);
    std::unique_ptr<State> state_;
    Ask served_ = Ask::nothing;
};

}  // namespace cdprep
