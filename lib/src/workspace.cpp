// SPDX-License-Identifier: MIT
#include "cdprep/workspace.h"

#include "workspace_storage.h"

namespace cdprep {

Workspace::Workspace() : storage_(std::make_unique<Storage>()) {}
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;
Workspace::~Workspace() = default;

}  // namespace cdprep
