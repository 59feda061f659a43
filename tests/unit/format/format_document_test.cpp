// SPDX-License-Identifier: MIT
// FORMAT.md says what a baked file is. The expected text comes from the section table and from the
// offsets that the compiler gave the structs.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "cdprep/format/sections.h"

namespace cdprep::format {
namespace {

std::string document() {
    std::ifstream file(CDPREP_FORMAT_DOCUMENT);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

std::string dataset_of(const Element& element) {
    if (!element.fields.empty()) return "N compound";
    return element.columns > 1 ? "N x " + std::to_string(element.columns) : "N";
}

std::string section_table() {
    std::string text =
        "| id | name | element | bytes | count | dataset | in a bake | for |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const SectionKind& kind : section_kinds()) {
        text += "| " + std::to_string(static_cast<std::uint32_t>(kind.id)) + " | " + kind.name +
                " | " + kind.element.name + " | " + std::to_string(kind.element.size) + " | " +
                kind.count + " | " + dataset_of(kind.element) + " | " + kind.when + " | " +
                kind.serves + " |\n";
    }
    return text;
}

TEST(FormatDocument, HoldsTheSectionTable) {
    EXPECT_NE(document().find("\n" + section_table()), std::string::npos)
        << "FORMAT.md must hold:\n"
        << section_table();
}

/// A line of a table of fields: "| 16 | 8 | u32 x 2 | first_block, point_count: ..."
struct Row {
    std::uint32_t offset;
    std::uint32_t size;
    std::string type;
    std::string fields;
};

/// The rows of the first table of fields behind `title`.
std::vector<Row> rows_behind(const std::string& text, const std::string& title) {
    std::vector<Row> rows;
    const std::size_t at = text.find(title);
    if (at == std::string::npos) return rows;
    const std::regex row(R"(\| (\d+) \| (\d+) \| ([^|]+) \| ([^|]+) \|)");
    for (const std::string& line : lines_of(text.substr(at))) {
        std::smatch match;
        if (std::regex_match(line, match, row)) {
            rows.push_back({static_cast<std::uint32_t>(std::stoul(match[1])),
                            static_cast<std::uint32_t>(std::stoul(match[2])), match[3], match[4]});
        } else if (!rows.empty()) {
            break;
        }
    }
    return rows;
}

/// "a, b: what" names a and b when both are fields; text may follow a comma too.
std::vector<const Field*> fields_in(const Row& row, const Element& element, std::size_t first) {
    std::vector<const Field*> fields;
    std::string rest = row.fields;
    std::uint32_t size = 0;
    while (first + fields.size() < element.fields.size() && size < row.size) {
        const Field& next = element.fields[first + fields.size()];
        if (!rest.starts_with(next.name)) break;
        fields.push_back(&next);
        size += next.count() * scalar_size(next.scalar);
        rest = rest.substr(std::string(next.name).size());
        if (rest.starts_with(", ")) rest = rest.substr(2);
    }
    return fields;
}

void expect_fields(const Element& element, const std::vector<Row>& rows) {
    std::size_t seen = 0;
    for (const Row& row : rows) {
        const std::vector<const Field*> fields = fields_in(row, element, seen);
        ASSERT_FALSE(fields.empty()) << element.name << ": no field '" << row.fields << "' here";
        EXPECT_EQ(fields.front()->offset, row.offset) << element.name << "." << row.fields;
        std::uint32_t size = 0;
        for (const Field* field : fields) {
            EXPECT_EQ(row.offset + size, field->offset) << element.name << "." << field->name;
            EXPECT_TRUE(row.type.starts_with(scalar_name(field->scalar)))
                << element.name << "." << field->name << " is " << row.type;
            size += field->count() * scalar_size(field->scalar);
        }
        EXPECT_EQ(size, row.size) << element.name << "." << row.fields;
        seen += fields.size();
    }
    EXPECT_EQ(seen, element.fields.size()) << element.name;
}

TEST(FormatDocument, GivesTheOffsetOfEveryFieldOfEveryElement) {
    const std::string text = document();
    std::map<std::string, Element> compounds;
    for (const SectionKind& kind : section_kinds()) {
        if (!kind.element.fields.empty()) compounds.emplace(kind.element.name, kind.element);
    }
    EXPECT_GT(compounds.size(), 20U);
    for (const auto& [name, element] : compounds) {
        const std::string title = name + ", " + std::to_string(element.size) + " bytes";
        const std::vector<Row> rows = rows_behind(text, title);
        ASSERT_FALSE(rows.empty()) << "no table behind '" << title << "'";
        expect_fields(element, rows);
    }
}

// Fields follow each other without gaps, so no byte of a file is without a meaning.
TEST(Elements, FieldsCoverEveryByteOnce) {
    for (const SectionKind& kind : section_kinds()) {
        std::uint32_t end = 0;
        for (const Field& field : kind.element.fields) {
            EXPECT_EQ(field.offset, end) << kind.element.name << "." << field.name;
            end = field.offset + field.count() * scalar_size(field.scalar);
        }
        if (kind.element.fields.empty()) {
            end = kind.element.columns * scalar_size(kind.element.scalar);
        }
        EXPECT_EQ(end, kind.element.size) << kind.name;
    }
}

TEST(SectionKinds, AreSortedAndNamedOnce) {
    std::uint32_t last = 0;
    std::map<std::string, int> names;
    for (const SectionKind& kind : section_kinds()) {
        EXPECT_GT(static_cast<std::uint32_t>(kind.id), last) << kind.name;
        last = static_cast<std::uint32_t>(kind.id);
        EXPECT_EQ(++names[kind.name], 1) << kind.name;
        EXPECT_EQ(find_section_kind(kind.id), &kind);
        EXPECT_EQ(element_size(kind.id), kind.element.size);
        EXPECT_STREQ(section_name(kind.id), kind.name);
    }
    EXPECT_EQ(find_section_kind(SectionId{last + 1}), nullptr);
    EXPECT_EQ(element_size(SectionId{last + 1}), 0U);
}

}  // namespace
}  // namespace cdprep::format
