// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>

namespace cdprep::test {

/// What one way to answer said of one family of cases.
struct Tally {
    std::size_t asked = 0;
    std::size_t wrong = 0;
    /// What a way to answer that says it is approximate left out, as it may.
    std::size_t missed = 0;
    /// The widest interval by what is promised: at most 1, or it is wrong. 0 where no
    /// interval was asked for.
    double widest = 0;
    std::string first_wrong{};  ///< what was asked when it was wrong for the first time

    /// `what()` says what was asked, and is called once.
    template <class What>
    void expect(bool is_right, What&& what) {
        ++asked;
        if (is_right) return;
        if (wrong++ == 0) first_wrong = what();
    }
    /// The width of an interval, and the width that is promised.
    template <class What>
    void expect_narrow(double width, double promised, What&& what) {
        const double share = width == 0 ? 0 : width / promised;
        if (share > widest) widest = share;
        expect(share <= 1, what);
    }
    void add(const Tally& other);
};

/// Which family was asked, and how.
struct Cell {
    std::string family;    ///< T01 ... of the catalogue
    std::string strategy;  ///< "octree/boxes": before the slash what the printed table has
    std::string kernels;   ///< the instruction set; empty where it does not matter
    friend auto operator<=>(const Cell&, const Cell&) = default;
};

/// All that was asked.
class Scoreboard {
public:
    /// `id` begins with the family.
    [[nodiscard]] Tally& of(std::string_view id, const std::string& strategy);
    [[nodiscard]] const std::map<Cell, Tally>& cells() const {
        return cells_;
    }
    [[nodiscard]] Tally total() const;

    /// A line a cell: family, strategy, kernels, asked, wrong, missed, widest, first wrong.
    [[nodiscard]] std::string rows(const std::string& kernels) const;
    /// Takes such lines. Returns false when one is none.
    bool add_rows(const std::string& rows);

private:
    std::map<Cell, Tally> cells_;
};

/// What the lines of rows() are.
inline constexpr const char* kScoreboardHeader =
    "family,strategy,kernels,asked,wrong,missed,widest,first_wrong";

}  // namespace cdprep::test
