// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/command.h"

#include "cli/command.h"
#include "cli/usage.h"

namespace cdprep::cli {

report::AnswerFormat parse_answer_format(const std::string& word) {
    if (word == "json") return report::AnswerFormat::json;
    return word == "ndjson" ? report::AnswerFormat::ndjson : report::AnswerFormat::text;
}

void add_answer_format(CLI::App& command, std::string& word) {
    command.add_option("--format", word, "Format of the answers")
        ->type_name("FORMAT")
        ->check(one_of({"text", "json", "ndjson"}))
        ->capture_default_str()
        ->group("Report");
}

void add_query(CLI::App& app, Exit& exit) {
    CLI::App* query = app.add_subcommand("query", "Query baked files");
    query->require_subcommand(1);
    add_pair_questions(*query, exit);
    add_contacts(*query, exit);
    add_point_questions(*query, exit);
    add_inaccessible(*query, exit);
}

}  // namespace cdprep::cli
