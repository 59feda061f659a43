// SPDX-License-Identifier: MIT
// The scoreboard of numerically hard cases: every family of the catalogue that a feature
// reaches, each case on every structure, kind of bounds and instruction set that claims to
// answer it, relabelled, swapped, turned, scaled and shifted where that loses no bit. Truths
// are known by hand, or from exact numbers that ask nothing of the library.
//
// Usage: hard_cases [--full] [--family F] [--float-mode M] [--csv FILE] [--json FILE]
//                   [--peers PROGRAM] [--peer-csv FILE] [--limit SECONDS]
// --full: cases as large as the catalogue has them. --family: those whose names begin so.
// --peers: the same families on other libraries, asked by PROGRAM (hard_peers), a case that
// takes longer than the limit (10) counts as one that hangs. --float-mode: the floating-point
// environment of whoever asks: default, flush_to_zero, downwards, upwards, towards_zero, trapping.
//
// Exits with 1 when an answer was wrong, or a family was not reached; with 2 when asked wrongly.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/ask_peers.h"
#include "accuracy/families.h"
#include "accuracy/hard_cases.h"
#include "accuracy/in_mode.h"
#include "accuracy/print_scoreboard.h"
#include "kernels/kernels.h"
#include "support/rounds.h"

namespace cdprep::test {
namespace {

struct Arguments {
    HardCaseOptions cases;
    bool only_rows = false;  ///< a child, which asks with its kernels alone
    std::string float_mode = "default";
    std::string csv;
    std::string json;
    std::string peers;  ///< the program that asks them
    std::string peer_csv;
    double limit_s = 10;  ///< for each case of a peer
};

std::optional<Arguments> read(int count, char** values) {
    Arguments arguments;
    for (int i = 1; i < count; ++i) {
        const std::string name = values[i];
        const auto value = [&](std::string& into) {
            if (i + 1 >= count) return false;
            into = values[++i];
            return true;
        };
        if (name == "--full") {
            arguments.cases.size = CaseSize::full;
        } else if (name == "--rows") {
            arguments.only_rows = true;
        } else if (name == "--family") {
            if (!value(arguments.cases.family)) return std::nullopt;
        } else if (name == "--float-mode") {
            if (!value(arguments.float_mode)) return std::nullopt;
            if (!set_mode_of_questions(arguments.float_mode)) return std::nullopt;
        } else if (name == "--csv") {
            if (!value(arguments.csv)) return std::nullopt;
        } else if (name == "--json") {
            if (!value(arguments.json)) return std::nullopt;
        } else if (name == "--peers") {
            if (!value(arguments.peers)) return std::nullopt;
        } else if (name == "--peer-csv") {
            if (!value(arguments.peer_csv)) return std::nullopt;
        } else if (name == "--limit") {
            std::string seconds;
            if (!value(seconds)) return std::nullopt;
            arguments.limit_s = std::strtod(seconds.c_str(), nullptr);
            if (!(arguments.limit_s > 0)) return std::nullopt;
        } else {
            return std::nullopt;
        }
    }
    return arguments;
}

/// What every instruction set is asked.
void score_with_kernels(const HardCaseOptions& options, Scoreboard& board) {
    score_overlaps(options, board);
    score_inclusion(options, board);
    score_hulls(options, board);
    score_distances(options, board);
    score_frames(options, board);
#ifdef CDPREP_HAVE_TOOLS
    score_contacts(options, board);
#endif
}

/// What knows no instruction sets.
void score_once(const HardCaseOptions& options, Scoreboard& board) {
    score_predicates(options, board);
    score_refusals(options, board);
#ifdef CDPREP_HAVE_TOOLS
    score_point_sets(options, board);
    score_surfaces(options, board);
#endif
}

/// Runs this program again with other kernels.
class Child {
public:
    Child(const std::string& program, const Arguments& arguments, const char* kernels) {
        std::string command = std::string("CDPREP_KERNELS=") + kernels + " '" + program +
                              "' --rows --family '" + arguments.cases.family + "' --float-mode " +
                              arguments.float_mode;
        if (arguments.cases.size == CaseSize::full) command += " --full";
        output_ = popen(command.c_str(), "r");  // NOLINT(cert-env33-c): our own program
    }
    /// What it printed; nothing when it failed.
    [[nodiscard]] std::optional<std::string> rows() {
        if (output_ == nullptr) return std::nullopt;
        std::string text;
        std::array<char, 4096> part{};
        while (const std::size_t read = std::fread(part.data(), 1, part.size(), output_)) {
            text.append(part.data(), read);
        }
        if (pclose(output_) != 0) return std::nullopt;
        return text;
    }

private:
    std::FILE* output_ = nullptr;
};

/// The instruction sets of this processor; in a slow program, the reference and the best one.
std::vector<const char*> asked_kernels() {
    const kernels::Available tables = kernels::available();
    std::vector<const char*> names;
    for (std::size_t i = 0; i < tables.count; ++i) {
        const bool is_between = i > 0 && i + 1 < tables.count;
        if (kSlowdown == 1 || !is_between) names.push_back(tables.table[i]->name);
    }
    return names;
}

bool score(const std::string& program, const Arguments& arguments, Scoreboard& board) {
    const std::vector<const char*> names = asked_kernels();
    std::vector<Child> children;
    children.reserve(names.size());
    for (const char* name : names) children.emplace_back(program, arguments, name);
    score_once(arguments.cases, board);
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto rows = children[i].rows();
        if (rows && board.add_rows(*rows)) continue;
        // A crash is the worst of wrong answers.
        std::printf("the cases with kernels %s came to no end\n", names[i]);
        return false;
    }
    return true;
}

bool is_asked(const Scoreboard& board, std::string_view family) {
    return std::any_of(board.cells().begin(), board.cells().end(), [&](const auto& cell) {
        return cell.first.family == family && cell.second.asked > 0;
    });
}

/// What of the catalogue is not asked here, by the reason.
void print_left_out() {
    std::vector<std::array<std::string, 2>> left;  // reason, families
    for (const HardFamily& family : kHardFamilies) {
        if (family.less.empty()) continue;
        const auto same = std::find_if(left.begin(), left.end(),
                                       [&](const auto& l) { return l[0] == family.less; });
        if (same == left.end()) {
            left.push_back({std::string(family.less), std::string(family.id)});
        } else {
            (*same)[1] += ", " + std::string(family.id);
        }
    }
    for (const auto& [reason, families] : left) {
        std::printf("%s: %s\n", families.c_str(), reason.c_str());
    }
}

/// Whether all families were asked that belong here. Says which were not.
bool is_complete(const Scoreboard& board) {
    bool complete = true;
    for (const HardFamily& family : kHardFamilies) {
#ifndef CDPREP_HAVE_TOOLS
        if (needs_tools(family.id)) continue;
#endif
        if (is_asked_elsewhere(family) || is_asked(board, family.id)) continue;
        std::printf("%s was not reached\n", std::string(family.id).c_str());
        complete = false;
    }
    return complete;
}

bool write(const std::string& path, const std::string& text) {
    if (path.empty()) return true;
    std::ofstream file(path);
    file << text;
    return static_cast<bool>(file.flush());
}

int run(const std::string& program, const Arguments& arguments) {
    Scoreboard board;
    if (arguments.only_rows) {
        score_with_kernels(arguments.cases, board);
        std::fputs(board.rows(kernels::active().name).c_str(), stdout);
        return 0;
    }
    bool right = score(program, arguments, board);
    std::fputs(as_text(board).c_str(), stdout);
    if (arguments.cases.family.empty()) {
        print_left_out();
        right = is_complete(board) && right;
    }
    PeerBoard peers;
    if (!arguments.peers.empty()) {
        peers = ask_peers(arguments.peers, arguments.limit_s);
        std::printf("\n%s", as_text(peers).c_str());
    }
    const std::string csv = std::string(kScoreboardHeader) + "\n" + board.rows("");
    const std::string peer_csv =
        "peer,family,asked,wrong,crashed,hung,uneven,sign,ghost,depth,none\n" + as_rows(peers);
    if (!write(arguments.csv, csv) || !write(arguments.json, as_json(board)) ||
        !write(arguments.peer_csv, peer_csv)) {
        std::fprintf(stderr, "hard_cases: a result could not be written\n");
        return 2;
    }
    return right && board.total().wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace cdprep::test

int main(int count, char** values) {
    const auto arguments = cdprep::test::read(count, values);
    if (!arguments) {
        std::fprintf(stderr,
                     "usage: hard_cases [--full] [--family F] [--float-mode M] [--csv FILE] "
                     "[--json FILE] [--peers PROGRAM] [--peer-csv FILE] [--limit SECONDS]\n");
        return 2;
    }
    std::error_code none;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", none);
    return cdprep::test::run(none ? values[0] : self.string(), *arguments);
}
