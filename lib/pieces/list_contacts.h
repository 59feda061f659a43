// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cdprep/contacts.h"

namespace cdprep {

/// Contacts in the workspace, valid until its next query.
struct ListedContacts {
    std::span<const Contact> contacts;
    ContactsVerdict verdict;  ///< but for `count`
};

/// As contacts() with options.most above 0, for callers that have checked the models and set the
/// floating-point environment.
[[nodiscard]] ListedContacts list_contacts(const Pair& pair, Workspace& workspace,
                                           const ContactOptions& options) noexcept;

}  // namespace cdprep
