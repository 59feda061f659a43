// SPDX-License-Identifier: MIT
// The "Needs" lines of the public headers. The expected sets are those of c_questions() and
// questions(), which needs_matrix_test proves by asking.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "support/c_questions.h"
#include "support/cpp_questions.h"

namespace cdprep::test {
namespace {

using Names = std::set<std::string>;

std::string text_of(const std::string& header) {
    std::ifstream file(std::string(CDPREP_PUBLIC_HEADERS) + "/" + header);
    EXPECT_TRUE(file) << header;
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// All that `pattern` finds in `text`.
Names all_of(const std::string& text, const std::regex& pattern) {
    Names names;
    for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) {
        names.insert((*at)[1]);
    }
    return names;
}

/// A function of a header and what its comment says that it needs.
struct Documented {
    Names needs;       ///< always
    std::string rest;  ///< the end of the sentence: what variants need besides
    friend auto operator<=>(const Documented&, const Documented&) = default;
};

using Functions = std::map<std::string, Documented>;

constexpr const char* kOfSolids = "Ask::solid with Body::solid";

/// Names of the bits in a set, without "Ask::".
Names names_of(Ask asks) {
    static const std::map<Ask, std::string> kNames = {
        {Ask::collide, "collide"},   {Ask::overlap, "overlap"},
        {Ask::distance, "distance"}, {Ask::within, "within"},
        {Ask::contacts, "contacts"}, {Ask::response, "response"},
        {Ask::inside, "inside"},     {Ask::ray, "ray"},
        {Ask::closest, "closest"},   {Ask::touch, "touch"},
        {Ask::hulls, "hulls"},       {Ask::pieces, "pieces"},
        {Ask::corners, "corners"},   {Ask::tetra_tree, "tetra_tree"},
        {Ask::solid, "solid"}};
    Names names;
    for (const auto& [ask, name] : kNames) {
        if (contains(asks, ask)) names.insert(name);
    }
    return names;
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// Functions of a C++ header that have a "Needs" sentence. Comments are blocks of ///.
void read_cpp(const std::string& header, Functions& functions) {
    std::istringstream lines(text_of(header));
    const std::regex declared(
        R"(^(?:\[\[nodiscard\]\] )?(?:CDPREP_API )?[A-Za-z:_<>0-9]+ ([a-z_]+)\()");
    const std::regex needs(R"(Needs ((?:Ask|ask_of)(?:[^.]|\.(?=\w))*)\.)");
    const std::regex ask(R"(Ask::([a-z_]+))");
    std::string comment, line;
    while (std::getline(lines, line)) {
        std::smatch found, said;
        // A long type stands on a line of its own.
        const bool is_split = line.find("CDPREP_API") != std::string::npos;
        if (std::string rest; is_split && line.find('(') == std::string::npos) {
            std::getline(lines, rest);
            line += " " + rest;
        }
        if (line.starts_with("///")) {
            comment += line.substr(3);
            continue;
        }
        if (std::regex_search(line, found, declared)) {
            if (std::regex_search(comment, said, needs)) {
                const std::string sentence = said[1];
                const auto end = std::min(
                    {sentence.find(';'), sentence.find(kOfSolids), sentence.find("ask_of")});
                functions[found[1]] = {all_of(sentence.substr(0, end), ask),
                                       end < sentence.size() ? sentence.substr(end) : ""};
            } else {
                functions[found[1]] = {};
            }
        }
        comment.clear();
    }
}

/// Functions of a C header that have a "Needs" line.
void read_c(const std::string& header, Functions& functions) {
    const std::string text = text_of(header);
    const std::regex block(R"(Needs: ([^*]*) \*/\s*CDPREP_API int cdprep_([a-z_0-9]+)\()");
    const std::regex ask(R"(CDPREP_ASK_([A-Z_]+))");
    for (std::sregex_iterator at(text.begin(), text.end(), block), end; at != end; ++at) {
        std::string sentence = (*at)[1];
        if (sentence == "as cdprep_hull_find()") {
            functions[(*at)[2]] = functions.at("hull_find");
            continue;
        }
        const auto cut = std::min(sentence.find(';'), sentence.size());
        Documented documented = {{}, sentence.substr(cut)};
        for (const std::string& name : all_of(sentence.substr(0, cut), ask)) {
            documented.needs.insert(lower(name));
        }
        functions[(*at)[2]] = documented;
    }
}

/// The longest function whose name, in words, `row` begins with.
std::string function_of(const std::string& row, const Functions& functions, char between) {
    std::string best;
    for (const auto& [name, documented] : functions) {
        std::string words = name;
        if (between != '_') std::replace(words.begin(), words.end(), '_', between);
        const bool fits = row == words || row.starts_with(words + " ");
        if (fits && name.size() > best.size()) best = name;
    }
    return best;
}

TEST(NeedsLines, OfCppAreWhatTheQuestionsNeed) {
    Functions functions;
    for (const char* header :
         {"pairs.h", "bounded_distance.h", "points.h", "contacts.h", "hulls.h", "parallel.h",
          "self.h", "time_of_impact.h", "cells/level_of_detail.h", "cells/overlap_through.h"}) {
        read_cpp(header, functions);
    }
    Names asked;
    for (const Question& question : questions()) {
        const std::string row = question.name, name = function_of(row, functions, '_');
        ASSERT_NE(name, "") << row;
        asked.insert(name);
        const Documented& documented = functions.at(name);
        if (row == name) {
            EXPECT_EQ(documented.needs, names_of(question.needs)) << row;
        }
        if (row.find(" solid") != std::string::npos) {
            EXPECT_NE(documented.rest.find(kOfSolids), std::string::npos) << row;
        }
        if (row.find(" through ") != std::string::npos) {
            EXPECT_NE(documented.rest.find("ask_of("), std::string::npos) << row;
        }
    }
    functions.erase("ask_of");
    functions.erase("enclosing_parts");  // of any model
    for (const auto& [name, documented] : functions) EXPECT_TRUE(asked.contains(name)) << name;
}

TEST(NeedsLines, OfCAreWhatTheQuestionsNeed) {
    Functions functions;
    for (const char* header :
         {"c/model.h", "c/pairs.h", "c/contacts.h", "c/motion.h", "c/points.h", "c/draw.h"}) {
        read_c(header, functions);
    }
    Names asked;
    for (const CQuestion& question : c_questions()) {
        const std::string row = question.name, name = function_of(row, functions, ' ');
        ASSERT_NE(name, "") << row;
        asked.insert(name);
        const Documented& documented = functions.at(name);
        if (row.find(" of ") == std::string::npos && row.find(" solid") == std::string::npos &&
            row.find(" through ") == std::string::npos) {
            EXPECT_EQ(documented.needs, names_of(Ask{question.needs})) << row;
        }
        if (row.find(" solid") != std::string::npos) {
            EXPECT_NE(documented.rest.find("CDPREP_SOLID: also CDPREP_ASK_SOLID"),
                      std::string::npos)
                << row;
        }
        if (row.find(" of pieces") != std::string::npos) {
            EXPECT_NE(documented.rest.find("CDPREP_ASK_PIECES, CDPREP_ASK_CORNERS"),
                      std::string::npos)
                << row;
        }
    }
    for (const auto& [name, documented] : functions) EXPECT_TRUE(asked.contains(name)) << name;
}

}  // namespace
}  // namespace cdprep::test
