// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace cdprep::test {

/// What a peer said of one family.
struct PeerTally {
    std::size_t asked = 0;
    std::size_t wrong = 0;
    std::size_t crashed = 0;
    std::size_t hung = 0;  ///< no answer within the limit
    /// Of cases that touch and no more both answers are right, by one's own convention; but one
    /// case in two guises has one.
    std::size_t uneven = 0;  ///< cases that got both
    // Of contacts, what was wrong; a case may count twice.
    std::size_t sign = 0;   ///< a normal points the wrong way
    std::size_t ghost = 0;  ///< one is more than 10 degrees off
    std::size_t depth = 0;  ///< the deepest is off by a factor of 2
    std::size_t none = 0;   ///< no contact of bodies that overlap
};

/// By peer, then by family.
using PeerBoard = std::map<std::string, std::map<std::string, PeerTally>>;

/// Asks all cases of every peer that `program` (hard_peers) has, in children that may crash: a
/// case that ends its child, or takes longer than the limit, counts as such, and another child
/// goes on after it. After `most_losses` such cases a peer is left alone. Returns nothing but
/// what was said; an empty board where the program cannot be run.
[[nodiscard]] PeerBoard ask_peers(const std::string& program, double limit_s,
                                  std::size_t most_losses = 40);

/// To look at: families by peers, "3/32" for three wrong answers of 32; c and h for cases that
/// crashed or hung; ~ for cases that touch and were told both to, in different guises. Contacts
/// follow in a table of their own.
[[nodiscard]] std::string as_text(const PeerBoard& board);

/// A line a family and peer: peer, family, asked, wrong, crashed, hung, uneven, sign, ghost, depth,
/// none.
[[nodiscard]] std::string as_rows(const PeerBoard& board);

}  // namespace cdprep::test
