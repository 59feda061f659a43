// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cdprep::study {

/// How a published figure relates to the one beside which it stands.
enum class Mark : std::uint8_t {
    none,
    other_counts,    ///< of a mesh with about as many triangles, not the same number
    stand_in,        ///< ours is of a mesh made to the published counts
    erratum,         ///< the published figure cannot be right
    not_comparable,  ///< ours is of a mesh of the same name with counts of its own: no figure
};

/// What was published in a cell's place.
struct Published {
    std::optional<double> value{};  ///< in the column's unit
    std::string text{};             ///< a word in its place, such as "Not 2-manifold"
    Mark mark = Mark::none;
    std::string remark{};  ///< what the mark means here
};

/// A further number of a cell, such as its spread.
struct Detail {
    std::string name;
    double value;
};

/// One thing that was found out: a number, a word, or the reason why there is neither.
struct Cell {
    std::optional<double> value{};  ///< in the column's unit
    std::string text{};
    std::string reason{};
    std::vector<Detail> details{};
    std::optional<Published> published{};

    [[nodiscard]] bool is_filled() const noexcept {
        return value || !text.empty();
    }
};

enum class Unit : std::uint8_t {
    none,
    count,      ///< whole numbers
    seconds,    ///< people read them in ns, us, ms or s
    mebibytes,  ///< the papers' "MB"
    share,      ///< 0 to 1
};

struct Column {
    std::string key;    ///< in JSON and CSV
    std::string title;  ///< for people
    Unit unit = Unit::none;
};

struct Row {
    std::string label;
    std::vector<Cell> cells;  ///< one a column
};

struct Table {
    std::string key;  ///< "1", "2", "2.bunny"
    std::string title;
    std::string label_title;  ///< what the rows' labels are
    std::vector<Column> columns;
    std::vector<Row> rows;
    std::vector<std::string> notes{};  ///< sentences
};

/// Whether what was published holds here too.
enum class Verdict : std::uint8_t { holds, fails, not_asked };

struct Check {
    std::string claim;     ///< a sentence
    std::string evidence;  ///< what was found, with its numbers; why it fails
    Verdict verdict = Verdict::not_asked;
    bool is_promise = false;  ///< of this library: one that fails is a fault
};

}  // namespace cdprep::study
