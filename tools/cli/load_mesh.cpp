// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/load_mesh.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "cdprep/format/limits.h"
#include "cli/colliders.h"
#include "mesh/point_tree.h"
#include "mesh/weld.h"
#include "text/number_text.h"

namespace cdprep::cli {
namespace {

/// Returns the error for the first number that a mesh may not hold.
Error refused(const std::filesystem::path& input, const mesh::TriangleSoup& soup) {
    const mesh::BadNumber& bad = soup.bad_numbers.front();
    std::string message = input.string() + ": ";
    if (bad.kind == mesh::BadNumber::Kind::not_finite) {
        message += "vertex " + std::to_string(bad.vertex) +
                   " has a coordinate that is not finite; all must be finite";
    } else if (bad.found >= 0 && bad.found < bad.first) {
        message += "triangle " + std::to_string(bad.triangle) + " uses vertex " +
                   std::to_string(bad.found) + ", but the file numbers its vertices from " +
                   std::to_string(bad.first) + " to " + std::to_string(bad.first + bad.limit - 1);
    } else {
        message += "triangle " + std::to_string(bad.triangle) + " uses vertex " +
                   std::to_string(bad.found) + ", but the file has " +
                   report::counted(static_cast<std::uint64_t>(bad.limit), "vertex", "vertices");
    }
    if (soup.bad_number_count > 1) {
        message += " (" + std::to_string(soup.bad_number_count) + " such places in all)";
    }
    return {ErrorCode::unreadable, message + "."};
}

/// Returns the error for the first coordinate above format::kMaxCoordinate, or nothing.
std::optional<Error> find_too_large(const std::filesystem::path& input,
                                    const mesh::TriangleSoup& soup) {
    for (const format::Triangle& triangle : soup.triangles) {
        for (const std::uint32_t vertex : triangle.vertex) {
            const format::Double3& p = soup.positions[vertex];
            const double largest = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
            if (largest <= format::kMaxCoordinate) continue;
            std::ostringstream message;
            message << input.string() << ": vertex " << vertex << " has a coordinate of size "
                    << largest << "; the largest allowed is 2^1000, about "
                    << format::kMaxCoordinate << '.';
            return Error{ErrorCode::unreadable, message.str()};
        }
    }
    return std::nullopt;
}

/// Leaves colliders out, or tells that they stay.
void heed_colliders(mesh::TriangleSoup& soup, const LoadOptions& options) {
    if (options.without_colliders) {
        static_cast<void>(leave_out_colliders(soup));
        return;
    }
    const std::vector<std::string> kept = find_colliders(soup);
    if (!kept.empty() && options.tell) options.tell(kept_text(kept, "with --without-colliders"));
}

}  // namespace

std::optional<Error> find_refusal(const std::filesystem::path& input,
                                  const mesh::TriangleSoup& soup) {
    if (soup.bad_number_count > 0) return refused(input, soup);
    return find_too_large(input, soup);
}

std::optional<Error> find_wide_weld(const std::filesystem::path& input,
                                    const mesh::TriangleSoup& soup, double distance) {
    mesh::Box box;
    for (const format::Double3& p : soup.positions) box.add(p);
    const double diagonal = soup.positions.empty() ? 0 : box.diagonal();
    if (!(diagonal > 0) || distance < diagonal) return std::nullopt;
    return Error{ErrorCode::bad_argument,
                 input.string() + ": --weld " + report::in_six_digits(distance) +
                     " would join the whole mesh, whose diagonal is " +
                     report::in_six_digits(diagonal) + ". Give a smaller distance."};
}

Result<mesh::TriangleSoup> load_soup(const std::filesystem::path& input,
                                     const LoadOptions& options) {
    Result<mesh::TriangleSoup> imported = import::import_file(input, options.import);
    if (!imported) return imported.error();
    mesh::TriangleSoup soup = std::move(imported).value();
    if (const auto error = find_refusal(input, soup)) return *error;
    if (options.tell) std::for_each(soup.remarks.begin(), soup.remarks.end(), options.tell);
    heed_colliders(soup, options);
    if (options.normalize) mesh::normalize(soup);
    if (const auto error = find_wide_weld(input, soup, options.weld_distance)) return *error;
    return soup;
}

Result<mesh::Mesh> load_mesh(const std::filesystem::path& input, const LoadOptions& options) {
    const Result<mesh::TriangleSoup> soup = load_soup(input, options);
    if (!soup) return soup.error();
    return mesh::weld(soup.value(), {options.weld_distance}).mesh;
}

}  // namespace cdprep::cli
