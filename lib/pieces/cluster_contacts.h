// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "cdprep/contacts.h"

namespace cdprep {

/// Joins contacts of a list, the deepest first, into clusters, and returns their number. Those that
/// remain are at the front: the deepest of each cluster, with at most four of its members' points.
/// `angle` is in radians. The list has at most kMostListedContacts.
[[nodiscard]] std::size_t cluster_contacts(std::span<Contact> contacts, double angle) noexcept;

}  // namespace cdprep
