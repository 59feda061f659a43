// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

namespace cdprep::test {

enum class Promise : std::uint8_t {
    kept,      ///< must hold: the program fails if it does not
    measured,  ///< printed only
};

/// Of a number that no case limits.
inline constexpr double kNoBound = std::numeric_limits<double>::infinity();

/// A line of the table.
struct Row {
    std::string id;    ///< S01 and so on, of the catalogue
    std::string what;  ///< "drift in 5 s, metres"
    std::string engine;
    double value = 0;
    double bound = kNoBound;  ///< inclusive
    Promise promise = Promise::measured;
};

/// Prints rows as they come, and counts those that break a promise.
class Table {
public:
    void add(const Row& row);
    /// Prints where a case is tested that is not of this program.
    static void refer(const char* id, const char* what, const char* where);
    [[nodiscard]] std::size_t broken() const {
        return broken_;
    }

private:
    std::size_t broken_ = 0;
};

/// How much of a case is played.
struct Extent {
    bool is_full = false;  ///< the times of the catalogue, else seconds of them
    bool has_peers = true;
};

void play_stacks(Table& table, const Extent& extent);      ///< S01, S02
void play_impacts(Table& table, const Extent& extent);     ///< S03, S04, S05, S08, S09
void play_resting(Table& table, const Extent& extent);     ///< S06, S07, S10, S11, S16
void play_threads(Table& table, const Extent& extent);     ///< S15
void refer_elsewhere(Table& table, const Extent& extent);  ///< S12, S13, S14
/// Scanned models fall into a box.
void play_small_pile(Table& table, const Extent& extent);
void play_piles(Table& table, const Extent& extent);
void play_mixed_pile(Table& table, const Extent& extent);

}  // namespace cdprep::test
