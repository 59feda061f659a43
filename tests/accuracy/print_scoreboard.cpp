// SPDX-License-Identifier: MIT
#include "accuracy/print_scoreboard.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

#include "accuracy/families.h"

namespace cdprep::test {
namespace {

struct Part {
    char letter;
    const char* title;
};
constexpr std::array kParts = {Part{'T', "Triangles against triangles"},
                               Part{'P', "Points in solids"},
                               Part{'G', "Convex hulls: distance and depth"},
                               Part{'B', "Trees and walks through them"},
                               Part{'C', "Hulls of points"},
                               Part{'D', "Pieces, parts, findings, repairs"},
                               Part{'X', "Distance and tolerance"},
                               Part{'S', "Deformed, torn and scanned"},
                               Part{'K', "Contacts of convex pieces"},
                               Part{'F', "Failures found since"}};

std::string column_of(const Cell& cell) {
    return cell.strategy.substr(0, cell.strategy.find('/'));
}

/// Of one family, or of all that begin so, in one column; or in all columns.
Tally sum_of(const Scoreboard& board, std::string_view family, const std::string& column = {}) {
    Tally sum;
    for (const auto& [cell, tally] : board.cells()) {
        if (!cell.family.starts_with(family)) continue;
        if (column.empty() || column_of(cell) == column) sum.add(tally);
    }
    return sum;
}

std::string padded(std::string text, std::size_t width) {
    text.resize(std::max(width, text.size()), ' ');
    return text;
}
std::string to_the_right(const std::string& text, std::size_t width) {
    return std::string(width - std::min(width, text.size()), ' ') + text;
}

std::string share(const Tally& tally) {
    if (tally.asked == 0) return ".";
    return std::to_string(tally.wrong) + "/" + std::to_string(tally.asked);
}

std::string widest(const Tally& tally) {
    if (tally.widest == 0) return "";
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "%.2g", tally.widest);
    return text.data();
}

std::vector<std::string> columns_of(const Scoreboard& board, char letter) {
    std::vector<std::string> columns;
    for (const auto& [cell, tally] : board.cells()) {
        if (cell.family[0] == letter) columns.push_back(column_of(cell));
    }
    std::sort(columns.begin(), columns.end());
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    return columns;
}

std::string table_of(const Scoreboard& board, const Part& part) {
    constexpr std::size_t kWide = 30, kNarrow = 13;
    const std::vector<std::string> columns = columns_of(board, part.letter);
    if (columns.empty()) return "";
    std::string text = std::string(part.title) + "\n" + padded("", kWide);
    for (const std::string& column : columns) text += to_the_right(column, kNarrow);
    text += to_the_right("widest", kNarrow) + "\n";
    const auto row = [&](const std::string& name, std::string_view families) {
        text += padded(name, kWide);
        for (const std::string& column : columns) {
            text += to_the_right(share(sum_of(board, families, column)), kNarrow);
        }
        text += to_the_right(widest(sum_of(board, families)), kNarrow) + "\n";
    };
    for (const HardFamily& family : kHardFamilies) {
        if (family.id[0] != part.letter || sum_of(board, family.id).asked == 0) continue;
        row(std::string(family.id) + " " + std::string(family.what), family.id);
    }
    row("all", std::string_view(&part.letter, 1));
    return text + "\n";
}

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result + "\"";
}

}  // namespace

std::string as_text(const Scoreboard& board) {
    std::string text;
    for (const Part& part : kParts) text += table_of(board, part);
    for (const auto& [cell, tally] : board.cells()) {
        if (tally.wrong == 0) continue;
        text += "WRONG " + cell.family + " " + cell.strategy + " " + cell.kernels + ": " +
                share(tally) + ", first " + tally.first_wrong + "\n";
    }
    const Tally total = board.total();
    text += "asked " + std::to_string(total.asked) + ", wrong " + std::to_string(total.wrong) +
            ", widest interval " + (total.widest == 0 ? "0" : widest(total)) +
            " of the promised one\n";
    return text;
}

std::string as_json(const Scoreboard& board) {
    std::string text = "{\"cells\": [";
    const char* separator = "\n";
    for (const auto& [cell, tally] : board.cells()) {
        std::array<char, 128> numbers{};
        std::snprintf(numbers.data(), numbers.size(),
                      ", \"asked\": %zu, \"wrong\": %zu, \"missed\": %zu, \"widest\": %.3g",
                      tally.asked, tally.wrong, tally.missed, tally.widest);
        text += separator;
        text += "  {\"family\": " + quoted(cell.family) +
                ", \"strategy\": " + quoted(cell.strategy) +
                ", \"kernels\": " + quoted(cell.kernels) + numbers.data() +
                ", \"first_wrong\": " + quoted(tally.first_wrong) + "}";
        separator = ",\n";
    }
    return text + "\n]}\n";
}

}  // namespace cdprep::test
