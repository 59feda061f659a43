// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/command.h"

#include "cli/command.h"
#include "command_line/command_line.h"

namespace cdprep::cli {

report::AnswerFormat parse_answer_format(const std::string& word) {
    if (word == "json") return report::AnswerFormat::json;
    return word == "ndjson" ? report::AnswerFormat::ndjson : report::AnswerFormat::text;
}

void add_answer_format(const Command& command, std::string& word) {
    command.add_option("--format", word, "Format of the answers")
        .type_name("FORMAT")
        .check(one_of({"text", "json", "ndjson"}))
        .show_default()
        .group("Report");
}

void add_query(const Command& app, Exit& exit) {
    const Command query = app.add_command("query", "Query baked files");
    query.require_command();
    add_pair_questions(query, exit);
    add_contacts(query, exit);
    add_point_questions(query, exit);
    add_inaccessible(query, exit);
}

}  // namespace cdprep::cli
