// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_model.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <utility>
#include <vector>

#include "cdprep/hulls.h"
#include "cdprep/model.h"
#include "cli/open_for.h"
#include "cli/output_path.h"
#include "cli/signals.h"
#include "command_line/exit_codes.h"
#include "decompose/enclose/body_mass.h"
#include "decompose/enclose/drop_points.h"
#include "decompose/enclose/hull_error.h"
#include "decompose/enclose/windings.h"
#include "export/colliders_json.h"
#include "mesh/mass_properties.h"
#include "mesh/turn_up.h"
#include "mesh/vectors.h"

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using convex::ConvexHull;
using format::Double3;

/// The rounding of the floats that engines take, as a share of a part's diagonal. A part may always
/// grow by so little.
constexpr double kFloatRounding = 0x1p-24;

/// The content of a baked file that is exported. Model units and axes at first.
struct Body {
    std::vector<ConvexHull> parts;
    std::vector<double> errors;  ///< of the parts, as stored
    mesh::Mesh mesh;             ///< in source order
    bool is_balanced = false;
};

ConvexHull stored_hull(const Model& model, std::uint32_t number) {
    const format::Hull& stored = model.hulls().hulls[number];
    const ConvexPoints points = convex_points(model, number);
    ConvexHull hull;
    hull.dimension = stored.dimension;
    for (std::uint32_t i = 0; i < points.count; ++i) hull.points.push_back(points.point(i));
    for (const format::HullFacet& facet :
         model.hulls().facets.subspan(stored.first_facet, stored.facet_count)) {
        hull.facets.push_back(facet.point);
    }
    hull.groups.clear();
    for (const format::HullGroup& group :
         model.hulls().groups.subspan(stored.first_group, stored.group_count)) {
        hull.groups.push_back(group.first_facet);
    }
    hull.groups.push_back(stored.facet_count);
    return hull;
}

/// Adds the parts of a model, or else the hull of the whole. Parts without a volume are left out.
void add_parts(const Model& model, Body& body, report::ExportReport& report) {
    const auto first = find_hull(model, format::HullScope::part, 0);
    const auto whole = find_hull(model, format::HullScope::whole);
    report.is_of_whole = !first;
    const std::uint32_t begin = first ? *first : whole.value_or(0);
    const auto end = static_cast<std::uint32_t>(first   ? model.hulls().hulls.size()
                                                : whole ? begin + 1
                                                        : begin);
    for (std::uint32_t i = begin; i < end; ++i) {
        ConvexHull hull = stored_hull(model, i);
        if (hull.dimension < 3) {
            ++report.left_out;
            continue;
        }
        report.stored_points += hull.points.size();
        body.parts.push_back(std::move(hull));
        body.errors.push_back(model.hulls().hulls[i].distance);
    }
}

mesh::Mesh source_mesh(const Model& model) {
    const MeshView& stored = model.mesh();
    mesh::Mesh mesh;
    mesh.positions.assign(stored.positions_f64.begin(), stored.positions_f64.end());
    for (const Float3& p : stored.positions_f32) mesh.positions.push_back({p.x, p.y, p.z});
    mesh.single_precision = stored.positions_f64.empty();
    const auto numbers = model.source().triangle;
    std::vector<std::uint32_t> order(stored.triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return numbers[a] < numbers[b]; });
    for (const std::uint32_t i : order) mesh.triangles.push_back(stored.triangles[i]);
    return mesh;
}

double diagonal_of(std::span<const Double3> points) {
    mesh::Box box;
    for (const Double3& p : points) box.add(p);
    return box.diagonal();
}

/// Drops points that the engine ignores, and sums up what was found.
void drop_low_points(Body& body, const EngineForm& form, bool keeps_points, const Threads& threads,
                     report::ExportReport& report) {
    const double least_size =
        form.least_size / (report.metres_per_unit > 0 ? report.metres_per_unit : 1);
    const double stated = *std::max_element(body.errors.begin(), body.errors.end());
    std::vector<convex::DroppedPoints> dropped(body.parts.size());
    threads.parallel_for()(body.parts.size(), [&](std::size_t i) {
        const ConvexHull& part = body.parts[i];
        convex::DropOptions how;
        how.height = convex::ignored_height(part.points, least_size);
        how.growth = keeps_points ? 0 : std::max(stated, kFloatRounding * diagonal_of(part.points));
        dropped[i] = convex::drop_points(part, how);
    });
    for (std::size_t i = 0; i < dropped.size(); ++i) {
        body.parts[i] = std::move(dropped[i].hull);
        const std::size_t points = body.parts[i].points.size();
        report.points += points;
        report.most_points = std::max(report.most_points, points);
        report.low_points += dropped[i].low;
        report.growth = std::max(report.growth, dropped[i].growth);
        report.outer_error = std::max(report.outer_error, body.errors[i] + dropped[i].growth);
    }
}

/// Measures how far the hull of the whole sticks out: a file states only how far it is from the
/// exact hull.
void measure_whole(const Body& body, const Threads& threads, report::ExportReport& report) {
    report.outer_error = convex::find_hull_error(body.parts.front(), body.mesh,
                                                 convex::Reference::solid, threads.parallel_for())
                             .upper;
}

/// Turns the body to the up axis of the file. Measures its size along the axes.
void turn(Body& body, report::ExportReport& report) {
    mesh::turn_up(body.mesh.positions, report.up_axis, report.written_up);
    for (ConvexHull& part : body.parts) {
        mesh::turn_up(part.points, report.up_axis, report.written_up);
    }
    mesh::Box box;
    for (const Double3& p : body.mesh.positions) box.add(p);
    report.size = {box.upper.x - box.lower.x, box.upper.y - box.lower.y, box.upper.z - box.lower.z};
}

void scale(std::vector<Double3>& points, double factor) {
    for (Double3& p : points) p = mesh::scaled(p, factor);
}

/// Returns true if MuJoCo can read the mesh as a geom, for which it needs a volume.
bool is_for_mujoco(const Body& body) {
    if (!body.is_balanced || !convex::has_known_volume(body.mesh)) return false;
    const auto found = convex::find_mass_properties(body.mesh);
    return found && found->volume > 0;
}

Result<Done> write_for_engine(Body& body, const EngineForm& form, const ExportOptions& options,
                              const std::string& name, const Threads& threads,
                              report::ExportReport& report) {
    write::HullsFileOptions how;
    how.metres_per_unit = report.metres_per_unit;
    how.is_floating = options.is_floating;
    how.package = options.package;
    how.hulls_node = form.parts_node;
    how.stores_hulls_large = form.stores_parts_large;
    if (form.has_mass) {
        const auto weighed = weigh(body.mesh, body.parts,
                                   {.is_balanced = body.is_balanced,
                                    .density = options.density,
                                    .metres_per_unit = report.metres_per_unit,
                                    .parallel_for = threads.parallel_for()});
        if (weighed) {
            how.mass = weighed->body;
            report.mass = weighed->body.mass;
            report.mass_of = weighed->of;
        }
    }
    report.has_visual = options.has_visual;
    if (form.engine == Engine::mujoco && options.has_visual && !is_for_mujoco(body)) {
        report.has_visual = false;
        report.is_visual_refused = true;
    }
    if (form.format == write::HullsFormat::glb && report.metres_per_unit > 0) {
        scale(body.mesh.positions, report.metres_per_unit);
        for (ConvexHull& part : body.parts) scale(part.points, report.metres_per_unit);
    }
    if (report.has_visual) {
        how.visual = {body.mesh.positions, body.mesh.triangles, body.mesh.single_precision};
    }
    std::vector<write::HullArrays> hulls;
    for (std::size_t i = 0; i < body.parts.size(); ++i) {
        const ConvexHull& part = body.parts[i];
        hulls.push_back({part_name(form, name, i, body.parts.size()), part.points, part.facets,
                         part.dimension});
    }
    const Result<write::WrittenHulls> written =
        write::write_hulls(options.output, *form.format, hulls, how);
    if (!written) return written.error();
    // In model units, rounded up.
    report.rounding =
        written->rounding / (report.metres_per_unit > 0 ? report.metres_per_unit : 1) * (1 + 1e-15);
    report.outer_error += report.rounding;
    return Done{};
}

Result<Done> write_json(const Body& body, const EngineForm& form, const ExportOptions& options,
                        const std::string& name, const Threads& threads,
                        const report::ExportReport& report) {
    report::Colliders colliders;
    colliders.name = name;
    colliders.metres_per_unit = report.metres_per_unit;
    colliders.error = report.outer_error;
    const auto weighed =
        weigh(body.mesh, body.parts,
              {.is_balanced = body.is_balanced, .parallel_for = threads.parallel_for()});
    if (weighed) {
        colliders.mass = weighed->body;
        colliders.is_of_solid = weighed->of == MassOf::solid;
    }
    for (std::size_t i = 0; i < body.parts.size(); ++i) {
        colliders.parts.push_back({part_name(form, name, i, body.parts.size()), &body.parts[i]});
    }
    return write_bytes(options.output, report::colliders_json(colliders));
}

/// Returns an error if the file lacks something that the form needs.
std::optional<Error> find_lack(const Body& body, const EngineForm& form,
                               const report::ExportReport& report) {
    if (!body.parts.empty()) return std::nullopt;
    return Error{ErrorCode::bad_argument, report.input + ": has no " +
                                              (report.is_of_whole ? "convex hull" : "convex part") +
                                              " with a volume, which " + form.name + " needs."};
}

}  // namespace

Result<report::ExportReport> export_model(const fs::path& input, const EngineForm& form,
                                          const ExportOptions& options, const Threads& threads) {
    const Clock::time_point begin = Clock::now();
    const Result<Model> opened = Model::open(input, Ask::hulls | Ask::corners);
    if (!opened) return baked_first(input, opened.error());
    const Model& model = opened.value();
    const format::FileHeader& header = model.header();
    report::ExportReport report;
    report.input = input.string();
    report.output = options.output.string();
    report.engine = form.name;
    report.is_in_metres = is_in_metres(form);
    report.is_normalized = (header.flags & format::model_normalized) != 0;
    report.metres_per_unit = report.is_normalized ? 0 : header.metres_per_unit;
    report.up_axis = header.up_axis;
    const bool is_turned = header.up_axis != format::UpAxis::unknown && report.is_in_metres;
    report.written_up = is_turned ? form.up_axis : header.up_axis;
    Body body;
    add_parts(model, body, report);
    if (const auto lack = find_lack(body, form, report)) return *lack;
    body.mesh = source_mesh(model);
    body.is_balanced = model.is_balanced();
    report.parts = body.parts.size();
    if (options.strict && report.is_in_metres && !(report.metres_per_unit > 0)) {
        report.exit = static_cast<int>(Exit::findings);
        report.error = report::unknown_unit(report);
        return report;
    }
    drop_low_points(body, form, options.keeps_points, threads, report);
    if (report.is_of_whole) measure_whole(body, threads, report);
    if (is_interrupted()) return interrupted(input);
    turn(body, report);
    const std::string name = exported_name(input, options.output);
    const Result<Done> written = form.format
                                     ? write_for_engine(body, form, options, name, threads, report)
                                     : write_json(body, form, options, name, threads, report);
    if (!written) return written.error();
    report.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    return report;
}

}  // namespace cdprep::cli
