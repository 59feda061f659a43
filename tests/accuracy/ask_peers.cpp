// SPDX-License-Identifier: MIT
#include "accuracy/ask_peers.h"

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "accuracy/families.h"

namespace cdprep::test {
namespace {

/// What may be wrong with contacts.
constexpr std::array<std::pair<const char*, std::size_t PeerTally::*>, 4> kWrongs = {
    {{" sign", &PeerTally::sign},
     {" ghost", &PeerTally::ghost},
     {" depth", &PeerTally::depth},
     {" none", &PeerTally::none}}};

/// A child and what it prints.
class Child {
public:
    Child(const std::string& program, const std::vector<std::string>& arguments) {
        std::array<int, 2> ends{};
        if (pipe(ends.data()) != 0) return;
        std::vector<char*> values = {const_cast<char*>(program.c_str())};
        for (const std::string& a : arguments) values.push_back(const_cast<char*>(a.c_str()));
        values.push_back(nullptr);
        id_ = fork();
        if (id_ == 0) {
            dup2(ends[1], STDOUT_FILENO);
            close(ends[0]);
            close(ends[1]);
            close(STDERR_FILENO);  // peers talk
            execv(program.c_str(), values.data());
            _exit(127);
        }
        close(ends[1]);
        output_ = ends[0];
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() {
        if (id_ > 0) {
            kill(id_, SIGKILL);
            waitpid(id_, nullptr, 0);
        }
        if (output_ >= 0) close(output_);
    }

    enum class Got : std::uint8_t { line, end, nothing };
    /// Waits for a line.
    Got read_line(std::string& line, double limit_s) {
        constexpr double kMilliseconds = 1000;
        for (;;) {
            if (const auto at = text_.find('\n'); at != std::string::npos) {
                line = text_.substr(0, at);
                text_.erase(0, at + 1);
                return Got::line;
            }
            pollfd waiting = {output_, POLLIN, 0};
            if (poll(&waiting, 1, static_cast<int>(limit_s * kMilliseconds)) <= 0) {
                return Got::nothing;
            }
            std::array<char, 4096> part{};
            const ssize_t count = read(output_, part.data(), part.size());
            if (count <= 0) return Got::end;
            text_.append(part.data(), static_cast<std::size_t>(count));
        }
    }

private:
    pid_t id_ = -1;
    int output_ = -1;
    std::string text_;
};

/// One peer's way through all cases.
class Way {
public:
    Way(const std::string& program, const std::string& peer, double limit_s,
        std::map<std::string, PeerTally>& families)
        : program_(program), peer_(peer), limit_s_(limit_s), families_(families) {}

    void go(std::size_t most_losses) {
        std::size_t losses = 0;
        while (!is_done_ && losses < most_losses) {
            go_on();
            losses += is_done_ ? 0 : 1;
        }
        for (const std::string& id : said_yes_) {
            if (said_no_.contains(id)) ++families_[id.substr(0, 3)].uneven;
        }
    }

private:
    /// Asks until a child is lost, or all is asked.
    void go_on() {
        Child child(program_, {peer_, std::to_string(next_)});
        std::string line, id;
        for (;;) {
            const Child::Got got = child.read_line(line, limit_s_);
            if (got != Child::Got::line) {
                if (got == Child::Got::end && id.empty()) {
                    is_done_ = true;
                    return;
                }
                if (!id.empty()) {
                    PeerTally& tally = families_[id.substr(0, 3)];
                    ++tally.asked;
                    ++(got == Child::Got::end ? tally.crashed : tally.hung);
                    ++next_;
                }
                return;
            }
            if (line.starts_with("ask ")) {
                id = line.substr(4);
                continue;
            }
            PeerTally& tally = families_[id.substr(0, 3)];
            ++tally.asked;
            tally.wrong += line.starts_with("wrong") ? 1 : 0;
            for (const auto& [word, count] : kWrongs) {
                tally.*count += line.find(word) != std::string::npos ? 1 : 0;
            }
            if (line == "yes") said_yes_.insert(id);
            if (line == "no") said_no_.insert(id);
            ++next_;
            id.clear();
        }
    }

    std::string program_;
    std::string peer_;
    double limit_s_;
    std::map<std::string, PeerTally>& families_;
    std::size_t next_ = 0;
    bool is_done_ = false;
    std::set<std::string> said_yes_;
    std::set<std::string> said_no_;
};

std::string padded(std::string text, std::size_t width) {
    text.resize(std::max(width, text.size()), ' ');
    return text;
}

std::string shown(const PeerTally& tally) {
    if (tally.asked == 0) return ".";
    std::string text = std::to_string(tally.wrong);
    text += '/';
    text += std::to_string(tally.asked);
    const auto append = [&](std::size_t count, char what) {
        if (count == 0) return;
        text += ' ';
        text += std::to_string(count);
        text += what;
    };
    append(tally.uneven, '~');
    append(tally.crashed, 'c');
    append(tally.hung, 'h');
    append(tally.sign, 's');
    append(tally.ghost, 'g');
    append(tally.depth, 'd');
    append(tally.none, 'n');
    return text;
}

void add(PeerTally& sum, const PeerTally& tally) {
    sum.asked += tally.asked;
    sum.wrong += tally.wrong;
    sum.crashed += tally.crashed;
    sum.hung += tally.hung;
    sum.uneven += tally.uneven;
    for (const auto& [word, count] : kWrongs) sum.*count += tally.*count;
}

}  // namespace

PeerBoard ask_peers(const std::string& program, double limit_s, std::size_t most_losses) {
    PeerBoard board;
    constexpr double kToStart = 60;
    std::string name;
    Child list(program, {"--list"});
    while (list.read_line(name, kToStart) == Child::Got::line) {
        Way(program, name, limit_s, board[name]).go(most_losses);
    }
    return board;
}

namespace {

/// The families of contacts, or the others.
std::string table_of(const PeerBoard& board, bool of_contacts) {
    constexpr std::size_t kWide = 30;
    const std::size_t narrow = of_contacts ? 31 : 16;
    const auto belongs = [&](std::string_view family) {
        return is_of_contacts(family) == of_contacts;
    };
    std::vector<std::pair<std::string, const std::map<std::string, PeerTally>*>> columns;
    for (const auto& [peer, families] : board) {
        if (std::any_of(families.begin(), families.end(),
                        [&](const auto& tally) { return belongs(tally.first); })) {
            columns.emplace_back(peer, &families);
        }
    }
    if (columns.empty()) return "";
    std::string text = padded(of_contacts ? "Peers, contacts" : "Peers", kWide);
    for (const auto& [peer, families] : columns) text += padded(peer, narrow);
    text += "\n";
    std::map<std::string, PeerTally> sums;
    for (const HardFamily& family : kHardFamilies) {
        if (!belongs(family.id)) continue;
        bool is_asked = false;
        std::string row = padded(std::string(family.id) + " " + std::string(family.what), kWide);
        for (const auto& [peer, families] : columns) {
            const auto found = families->find(std::string(family.id));
            const PeerTally tally = found == families->end() ? PeerTally() : found->second;
            is_asked = is_asked || tally.asked > 0;
            row += padded(shown(tally), narrow);
            add(sums[peer], tally);
        }
        if (is_asked) text += row + "\n";
    }
    text += padded("all", kWide);
    for (const auto& [peer, families] : columns) text += padded(shown(sums[peer]), narrow);
    return text + "\n";
}

}  // namespace

std::string as_text(const PeerBoard& board) {
    return table_of(board, false) + "\n" + table_of(board, true);
}

std::string as_rows(const PeerBoard& board) {
    std::string text;
    for (const auto& [peer, families] : board) {
        for (const auto& [family, tally] : families) {
            text += peer;
            text += ',';
            text += family;
            for (const std::size_t number :
                 {tally.asked, tally.wrong, tally.crashed, tally.hung, tally.uneven, tally.sign,
                  tally.ghost, tally.depth, tally.none}) {
                text += ',';
                text += std::to_string(number);
            }
            text += '\n';
        }
    }
    return text;
}

}  // namespace cdprep::test
