// SPDX-License-Identifier: MIT
#include "c_face.h"

#include <new>
#include <utility>

namespace cdprep {
namespace {

/// What a workspace's scratch takes where another one's follows.
std::size_t scratch_bytes() noexcept {
    return (Workspace::size() + Workspace::alignment() - 1) / Workspace::alignment() *
           Workspace::alignment();
}

/// Beside its scratch, the object itself.
std::size_t workspace_bytes() noexcept {
    return scratch_bytes() + sizeof(Workspace);
}

constexpr std::size_t kWorkspacesObject = sizeof(cdprep_workspaces);
static_assert(alignof(cdprep_workspaces) <= alignof(Workspace));

}  // namespace
}  // namespace cdprep

using cdprep::Workspace;

// The workspace's own object lies behind its scratch.
size_t cdprep_workspace_size(void) {
    return Workspace::size() + Workspace::alignment() + sizeof(cdprep_workspace);
}

size_t cdprep_workspace_alignment(void) {
    return Workspace::alignment();
}

cdprep_workspace* cdprep_make_workspace(void* memory, size_t size) {
    if (memory == nullptr || size < cdprep_workspace_size()) return nullptr;
    const std::span<std::byte> bytes(static_cast<std::byte*>(memory), size);
    std::optional<Workspace> workspace = Workspace::in(bytes);
    if (!workspace) return nullptr;
    return new (bytes.data() + cdprep::scratch_bytes()) cdprep_workspace{std::move(*workspace)};
}

size_t cdprep_workspaces_size(size_t count) {
    if (count > (SIZE_MAX - cdprep::kWorkspacesObject) / cdprep::workspace_bytes()) {
        return SIZE_MAX;
    }
    return count * cdprep::workspace_bytes() + cdprep::kWorkspacesObject;
}

// First every one's scratch, then their own objects, then what knows where those are.
cdprep_workspaces* cdprep_make_workspaces(void* memory, size_t size, size_t count) {
    if (memory == nullptr || count == 0 || size < cdprep_workspaces_size(count)) return nullptr;
    auto* const bytes = static_cast<std::byte*>(memory);
    auto* const objects = reinterpret_cast<Workspace*>(bytes + count * cdprep::scratch_bytes());
    for (size_t i = 0; i < count; ++i) {
        const std::size_t at = i * cdprep::scratch_bytes();
        std::optional<Workspace> workspace = Workspace::in({bytes + at, Workspace::size()});
        if (!workspace) return nullptr;
        new (objects + i) Workspace(std::move(*workspace));
    }
    return new (objects + count) cdprep_workspaces{{std::launder(objects), count}};
}
