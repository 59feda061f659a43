// SPDX-License-Identifier: MIT
// The cases of stability of rigid bodies: S01 to S16 of the catalogue, and piles of scanned models.
// Prints a line for each number: the case, the engine, the value, the bound, the verdict. Fails if
// a number that is promised exceeds its bound.
//
// Usage: simulation_cases [--full] [--no-peers] [CASES...]
//   --full      the times of the catalogue: 60 s, 10^6 steps
//   --no-peers  leaves out Bullet's own shapes
//   CASES       resting, stacks, impacts, threads, pile, elsewhere; with --full also piles and
//   mixed, which
//               take minutes. Only those that are named, if any are
#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "accuracy/simulation/table.h"

namespace cdprep::test {

void Table::add(const Row& row) {
    const bool holds = row.value <= row.bound;
    const bool promised = row.promise == Promise::kept;
    const char* verdict = holds ? "holds" : promised ? "BROKEN" : "exceeds";
    if (row.bound == kNoBound) verdict = "measured";
    if (!holds && promised) ++broken_;
    std::printf("%-5s | %-66s | %-16s | %9.3g | ", row.id.c_str(), row.what.c_str(),
                row.engine.c_str(), row.value);
    if (row.bound == kNoBound) {
        std::printf("%8s | %s\n", "-", verdict);
    } else {
        std::printf("%8.3g | %s\n", row.bound, verdict);
    }
    std::fflush(stdout);
}

void Table::refer(const char* id, const char* what, const char* where) {
    std::printf("%-5s | %-66s | %-16s | %9s | %8s | see %s\n", id, what, "cdprep", "-", "-", where);
    std::fflush(stdout);
}

void refer_elsewhere(Table& /*table*/, const Extent& /*extent*/) {
    Table::refer("S12", "a mesh that deforms: answers, and refit", "LiveCases, deform_bench");
    Table::refer("S13", "a mesh that tears: answers, and memory", "LiveCases");
    Table::refer("S14", "haptics: answers, and the rate", "Window, WindowMemory, haptic_bench");
}

}  // namespace cdprep::test

int main(int count, char** arguments) {
    using namespace cdprep::test;
    std::vector<std::string> asked(arguments + 1, arguments + count);
    const auto take = [&](const char* option) { return std::erase(asked, option) > 0; };
    Extent extent;
    extent.is_full = take("--full");
    extent.has_peers = !take("--no-peers");
    struct Group {
        const char* name;
        void (*play)(Table&, const Extent&);
        bool is_default;
    };
    const std::array groups = {Group{"resting", play_resting, true},
                               Group{"stacks", play_stacks, true},
                               Group{"impacts", play_impacts, true},
                               Group{"threads", play_threads, true},
                               Group{"pile", play_small_pile, true},
                               Group{"piles", play_piles, extent.is_full},
                               Group{"mixed", play_mixed_pile, extent.is_full},
                               Group{"elsewhere", refer_elsewhere, true}};
    for (const std::string& word : asked) {
        if (std::ranges::any_of(groups, [&](const Group& group) { return word == group.name; })) {
            continue;
        }
        std::fprintf(stderr, "simulation_cases: '%s' is no option and no group.\n", word.c_str());
        return 2;
    }
    Table table;
    for (const Group& group : groups) {
        const bool is_named = std::find(asked.begin(), asked.end(), group.name) != asked.end();
        if (asked.empty() ? group.is_default : is_named) group.play(table, extent);
    }
    return table.broken() == 0 ? 0 : 1;
}
