// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cdprep::study {

/// The relation of a published figure to ours beside it.
enum class Mark : std::uint8_t {
    none,
    other_counts,    ///< the meshes have about the same number of triangles, not equal ones
    stand_in,        ///< ours is from a substitute mesh with the published counts
    erratum,         ///< the published figure cannot be right
    not_comparable,  ///< ours is from a mesh of the same name with other counts: no figure
};

/// The published content of a cell.
struct Published {
    std::optional<double> value{};  ///< in the column's unit
    std::string text{};             ///< a word instead of a number, such as "Not 2-manifold"
    Mark mark = Mark::none;
    std::string remark{};  ///< the meaning of the mark here
};

/// An additional number of a cell, such as its spread.
struct Detail {
    std::string name;
    double value;
};

/// One result: a number, a word, or the reason why there is neither.
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
    seconds,    ///< text shows them in ns, us, ms or s
    mebibytes,  ///< "MB" in the comparative study (study/published.h)
    share,      ///< 0 to 1
};

struct Column {
    std::string key;    ///< in JSON and CSV
    std::string title;  ///< in text
    Unit unit = Unit::none;
};

struct Row {
    std::string label;
    std::vector<Cell> cells;  ///< one per column
};

struct Table {
    std::string key;  ///< "1", "2", "2.bunny"
    std::string title;
    std::string label_title;  ///< the title of the rows' labels
    std::vector<Column> columns;
    std::vector<Row> rows;
    std::vector<std::string> notes{};  ///< sentences
};

/// The result of checking whether a published claim holds here too.
enum class Verdict : std::uint8_t { holds, fails, not_asked };

struct Check {
    std::string claim;     ///< a sentence
    std::string evidence;  ///< the result, with its numbers; the reason if it fails
    Verdict verdict = Verdict::not_asked;
    bool is_promise = false;  ///< a promise of this library; its failure is a bug
};

}  // namespace cdprep::study
