// SPDX-License-Identifier: MIT
#pragma once

#include "c/input.h"
#include "cdprep/c/contacts.h"
#include "cdprep/contacts.h"

// Contacts of pairs and of scenes.

namespace cdprep::c {

template <>
struct Input<cdprep_contact_options> {
    static const InputType type;
    static cdprep_contact_options defaults() noexcept;
};

/// Reads and checks options of contacts. Null gives the defaults.
int read_contact_options(Call& call, const Name& name, const cdprep_contact_options* given,
                         cdprep_contact_options& options) noexcept;

[[nodiscard]] ContactOptions in_cpp(const cdprep_contact_options& options) noexcept;
[[nodiscard]] cdprep_contact in_c(const Contact& contact) noexcept;

}  // namespace cdprep::c
