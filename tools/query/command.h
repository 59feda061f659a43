// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cli/command.h"
#include "query/answer_report.h"

namespace cdprep::cli {

/// Adds the queries about two models: collide, overlap, distance, within.
void add_pair_questions(const Command& query, Exit& exit);

/// Adds the query for the contacts of two models: contacts.
void add_contacts(const Command& query, Exit& exit);

/// Adds the queries about one model: inside, closest, ray.
void add_point_questions(const Command& query, Exit& exit);

/// Adds the query for the inaccessible triangles of a model: inaccessible.
void add_inaccessible(const Command& query, Exit& exit);

/// Adds --format, which every query has.
void add_answer_format(const Command& command, std::string& word);
[[nodiscard]] report::AnswerFormat parse_answer_format(const std::string& word);

}  // namespace cdprep::cli
