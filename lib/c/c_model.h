// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "c/input.h"
#include "c/memory.h"
#include "cdprep/c/model.h"
#include "cdprep/c/window.h"
#include "cdprep/format/api.h"
#include "cdprep/live_model.h"
#include "cdprep/model.h"

/// An open model, with indices for cdprep_model_corners() and cdprep_model_mesh().
struct cdprep_model {
    std::optional<cdprep::Model> own;  ///< none if a live model or a window has it
    const cdprep::Model& model;
    const cdprep::LiveModel* live = nullptr;  ///< or null
    const cdprep_window* window = nullptr;    ///< or null
    cdprep::c::Memory object;                 ///< this object; none in the caller's memory
    cdprep::c::Memory bytes;                  ///< a copy of the file, or none
    cdprep::c::Memory index;                  ///< of what follows, or none
    /// By source number. Empty where the model does not serve Ask::corners, and where it can tear.
    std::span<std::uint32_t> tree_triangle;
    /// Empty where there is at most one component, and where the model can tear.
    std::span<std::uint32_t> component_of_vertex;

    cdprep_model(cdprep::Model opened, const cdprep::c::Memory& of_object,
                 const cdprep::c::Memory& of_bytes, const cdprep::c::Memory& of_index) noexcept
        : own(std::move(opened)),
          model(*own),
          object(of_object),
          bytes(of_bytes),
          index(of_index) {}
    explicit cdprep_model(const cdprep::LiveModel& of) noexcept : model(of.model()), live(&of) {}
    cdprep_model(const cdprep::Model& lent, const cdprep_window& by) noexcept
        : model(lent), window(&by) {}
    cdprep_model(const cdprep_model&) = delete;
    cdprep_model& operator=(const cdprep_model&) = delete;
    ~cdprep_model() = default;

    [[nodiscard]] bool can_tear() const noexcept {
        return live != nullptr && !model.bvh().lanes.empty();
    }
};

namespace cdprep::c {

template <>
struct Input<cdprep_open_options> {
    static const InputType type;
    static cdprep_open_options defaults() noexcept;
};

/// Returns the place of a triangle in the tree order, or CDPREP_NONE if there is no such triangle.
/// The model must serve Ask::corners.
[[nodiscard]] std::uint32_t place_of(const cdprep_model& model, std::uint32_t triangle) noexcept;

/// Refuses a model with triangles but without a BVH.
int check_bvh(Call& call, const Name& name, const Model& model) noexcept;

/// Refuses bits that this version does not know.
int check_asks(Call& call, const Name& name, std::uint32_t ask) noexcept;

/// Refuses queries that a model does not serve.
CDPREP_API int check_serves(Call& call, const Name& name, const Model& model, Ask asks);
inline int check_serves(Call& call, const Name& name, const cdprep_model& model, Ask asks) {
    return check_serves(call, name, model.model, asks);
}

/// Returns the bytes for the two index arrays, and fills them. `room` has index_size() bytes, or is
/// null where that is 0.
[[nodiscard]] std::size_t index_size(const Model& model) noexcept;
void make_index(cdprep_model& model, void* room) noexcept;

/// Returns the bytes of a section that is open, or none.
[[nodiscard]] std::span<const std::byte> section_bytes(const Model& model, SectionId id) noexcept;

}  // namespace cdprep::c
