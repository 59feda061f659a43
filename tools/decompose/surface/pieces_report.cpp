// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/surface/pieces_report.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "text/json_layout.h"
#include "text/number_text.h"
#include "text/printable.h"

namespace cdprep::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, convex::kEdgeKinds> kKindNames = {
    "convex", "flat", "reflex", "fold", "border", "non_manifold", "inconsistent", "no_area"};

std::size_t contained(const convex::SurfacePieces& pieces) {
    return static_cast<std::size_t>(
        std::count_if(pieces.pieces.begin(), pieces.pieces.end(),
                      [](const convex::SurfacePiece& piece) { return piece.contained; }));
}

double outer_error(const convex::SurfacePieces& pieces) {
    double most = 0;
    for (const convex::SurfacePiece& piece : pieces.pieces) {
        most = std::max(most, piece.outer_error);
    }
    return most;
}

std::size_t largest(const convex::SurfacePieces& pieces) {
    std::size_t most = 0;
    for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
        most = std::max(most, pieces.of(i).size());
    }
    return most;
}

std::string edge_line(const convex::SurfacePieces& pieces) {
    std::string line;
    for (std::size_t i = 0; i < convex::kEdgeKinds; ++i) {
        if (pieces.edges[i] == 0) continue;
        if (!line.empty()) line += ", ";
        line += std::to_string(pieces.edges[i]) + " ";
        line += kKindNames[i];
    }
    return line.empty() ? "no edges" : line;
}

Json table_json(const convex::SurfacePieces& pieces) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
        rows.push_back({{"piece", i},
                        {"triangles", pieces.of(i).size()},
                        {"first_triangle", pieces.of(i)[0]},
                        {"contained", pieces.pieces[i].contained},
                        {"outer_error", pieces.pieces[i].outer_error}});
    }
    return rows;
}

}  // namespace

const char* name_of(convex::PieceOrder order) {
    switch (order) {
        case convex::PieceOrder::depth_first:
            return "depth-first";
        case convex::PieceOrder::breadth_first:
            return "breadth-first";
        case convex::PieceOrder::cresting:
            return "cresting";
        case convex::PieceOrder::greedy:
            break;
    }
    return "greedy";
}

std::string pieces_text(const SurfacePiecesReport& report) {
    const convex::SurfacePieces& pieces = report.pieces;
    const std::size_t count = pieces.pieces.size();
    std::string text = printable(report.input) + ": " +
                       counted(count, "convex piece", "convex pieces") + " of " +
                       counted(pieces.triangles.size(), "triangle", "triangles") + " (" +
                       name_of(report.order) + ", " + printed(report.seconds, "%.3f") + " s)\n";
    text += "  largest " + counted(largest(pieces), "triangle", "triangles") + "; hulls of " +
            std::to_string(contained(pieces)) + " lie inside the solid; the others may not\n";
    text += report.tolerance == 0
                ? std::string("  exact: every triangle lies on its hull\n")
                : "  triangles lie at most " + at_most_in_six_digits(outer_error(pieces)) +
                      " below their hulls (tolerance " + at_most_in_six_digits(report.tolerance) +
                      ")\n";  // rounded alike, so that a bound within it looks so
    text += "  edges: " + edge_line(pieces) + "\n";
    if (!report.output.empty()) text += "  written to " + printable(report.output) + "\n";
    if (!report.has_table) return text;
    text += "  piece triangles first_triangle contained outer_error\n";
    for (std::size_t i = 0; i < count; ++i) {
        text += "  " + std::to_string(i) + " " + std::to_string(pieces.of(i).size()) + " " +
                std::to_string(pieces.of(i)[0]) + " " +
                (pieces.pieces[i].contained ? "yes" : "no") + " " +
                at_most_in_six_digits(pieces.pieces[i].outer_error) + "\n";
    }
    return text;
}

std::string pieces_json(const SurfacePiecesReport& report) {
    Json json = {{"input", report.input}, {"output", report.output}, {"exit", report.exit}};
    if (report.error) {
        json["error"] = *report.error;
    } else {
        const convex::SurfacePieces& pieces = report.pieces;
        json["method"] = "surface";
        json["order"] = name_of(report.order);
        json["tolerance"] = report.tolerance;
        json["triangles"] = pieces.triangles.size();
        json["pieces"] = pieces.pieces.size();
        json["outer_error"] = outer_error(pieces);
        json["inner_error"] = 0.0;  // hulls contain all vertices of their pieces
        json["contained"] = contained(pieces);
        json["largest"] = largest(pieces);
        json["seconds"] = report.seconds;
        for (std::size_t i = 0; i < convex::kEdgeKinds; ++i) {
            json["edges"][kKindNames[i]] = pieces.edges[i];
        }
        if (report.has_table) json["table"] = table_json(pieces);
    }
    return compact(json) + "\n";
}

}  // namespace cdprep::report
