// SPDX-License-Identifier: MIT
#include "accuracy/scoreboard.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace cdprep::test {

void Tally::add(const Tally& other) {
    if (wrong == 0) first_wrong = other.first_wrong;
    asked += other.asked;
    wrong += other.wrong;
    missed += other.missed;
    widest = std::max(widest, other.widest);
}

Tally& Scoreboard::of(std::string_view id, const std::string& strategy) {
    return cells_[{std::string(id.substr(0, 3)), strategy, ""}];
}

Tally Scoreboard::total() const {
    Tally sum;
    for (const auto& [cell, tally] : cells_) sum.add(tally);
    return sum;
}

std::string Scoreboard::rows(const std::string& kernels) const {
    std::string text;
    for (const auto& [cell, tally] : cells_) {
        std::array<char, 96> numbers{};
        std::snprintf(numbers.data(), numbers.size(), ",%zu,%zu,%zu,%.3g,", tally.asked,
                      tally.wrong, tally.missed, tally.widest);
        text += cell.family + ',' + cell.strategy + ',' +
                (cell.kernels.empty() ? kernels : cell.kernels) + numbers.data() +
                tally.first_wrong + '\n';
    }
    return text;
}

bool Scoreboard::add_rows(const std::string& rows) {
    std::istringstream lines(rows);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream fields(line);
        std::array<std::string, 7> field;
        for (std::string& f : field) {
            if (!std::getline(fields, f, ',')) return false;
        }
        Tally tally;
        tally.asked = std::strtoull(field[3].c_str(), nullptr, 10);
        tally.wrong = std::strtoull(field[4].c_str(), nullptr, 10);
        tally.missed = std::strtoull(field[5].c_str(), nullptr, 10);
        tally.widest = std::strtod(field[6].c_str(), nullptr);
        std::getline(fields, tally.first_wrong);
        cells_[{field[0], field[1], field[2]}].add(tally);
    }
    return true;
}

}  // namespace cdprep::test
