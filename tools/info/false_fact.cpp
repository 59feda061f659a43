// SPDX-License-Identifier: GPL-3.0-or-later
#include "info/false_fact.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <tuple>
#include <vector>

#include "cdprep/format/sections.h"
#include "info/mass_error.h"
#include "mesh/component_numbers.h"
#include "mesh/degenerate.h"
#include "mesh/find_bounds.h"
#include "mesh/mass_properties.h"
#include "mesh/topology.h"
#include "mesh/vectors.h"
#include "study/memory_model.h"
#include "text/verdict_words.h"
#include "validate/defects/find_defects.h"

namespace cdprep::cli {
namespace {

using mesh::largest_of;

using Found = std::optional<FalseFact>;
using mesh::Double3;

std::string text_of(double value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    return {digits.data(), end};
}
template <class Integer>
std::string text_of(Integer value) {
    return std::to_string(value);
}
std::string text_of(bool value) {
    return value ? "1" : "0";
}

std::string field_of(SectionId section, std::size_t element, const std::string& field) {
    return "section " + std::string(format::section_name(section)) + ", element " +
           std::to_string(element) + ", field " + field;
}

std::string flag_field(const std::string& flag) {
    return "the user block, field flags, flag " + flag;
}

template <class Value>
Found differ(const std::string& field, Value found, Value expected) {
    if (found == expected) return std::nullopt;
    return FalseFact{field, text_of(found), text_of(expected)};
}

/// Compares two rounded numbers. An error that is NaN allows every difference.
Found differ_by(const std::string& field, double found, double expected, double error) {
    if (!(std::fabs(found - expected) > error)) return std::nullopt;
    return FalseFact{field, text_of(found), text_of(expected)};
}

/// Returns the first fact that a check finds. The checks after it do not run.
template <class... Checks>
Found first_of(const Checks&... checks) {
    Found found;
    static_cast<void>(((found = checks()).has_value() || ...));
    return found;
}

double coordinate(const Double3& p, std::size_t axis) {
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

constexpr std::array<const char*, 3> kAxisName = {"x", "y", "z"};

/// Returns the words of a set of bits, followed by the bits without a word.
std::string words_text(const std::vector<std::string>& words, std::uint32_t unknown) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
    for (int bit = 0; bit < 32 && unknown >> bit != 0; ++bit) {
        if ((unknown >> bit & 1) != 0)
            text += (text.empty() ? "bit " : " bit ") + std::to_string(bit);
    }
    return text.empty() ? "none" : text;
}

std::string facts_text(const format::Verdict& verdict) {
    constexpr std::uint32_t kKnown = 2 * std::uint32_t{format::verdict_self_crossing} - 1;
    return words_text(report::fact_words(verdict), verdict.facts & ~kKnown);
}

std::string promises_text(const format::Verdict& verdict) {
    constexpr std::uint32_t kKnown = 2 * std::uint32_t{format::promise_contained_pieces} - 1;
    return words_text(report::promise_words(verdict), verdict.promises & ~kKnown);
}

/// Returns the soup from which an import would give this mesh.
mesh::TriangleSoup soup_of(const mesh::Mesh& mesh) {
    mesh::TriangleSoup soup;
    soup.positions = mesh.positions;
    soup.triangles = mesh.triangles;
    soup.single_precision = mesh.single_precision;
    return soup;
}

class FactCheck {
public:
    FactCheck(const Model& model, ParallelFor parallel_for)
        : model_(model),
          parallel_for_(parallel_for),
          mesh_(study::mesh_of(model)),
          has_source_(!model.source().triangle.empty()) {}

    Found find() {
        if (model_.triangle_count() > 0 && model_.mesh().triangles.empty()) return std::nullopt;
        if (model_.vertex_count() > 0 && mesh_.positions.empty()) return std::nullopt;
        topology_ = mesh::find_topology(mesh_);
        error_ = convex::find_mass_error(mesh_);
        return first_of(
            [&] { return find_false_flag(); }, [&] { return find_vertex_out_of_order(); },
            [&] { return find_false_degenerate(); }, [&] { return find_false_bounds(); },
            [&] { return find_false_components(); }, [&] { return find_false_mass(); },
            [&] { return find_false_verdicts(); });
    }

private:
    /// Checks the flags `balanced` and `normalized`. The other flags tell how to read sections, and
    /// the checks of these sections include them.
    [[nodiscard]] Found find_false_flag() const {
        const std::uint32_t flags = model_.header().flags;
        if (Found found = differ(flag_field("balanced"), (flags & format::model_balanced) != 0,
                                 topology_.balanced)) {
            return found;
        }
        const bool normalized = (flags & format::model_normalized) != 0;
        return normalized ? find_not_normalized() : find_false_normalization();
    }

    /// The bounding box of a normalized model has diagonal 1. So no coordinate exceeds half of it,
    /// up to one rounding to float. Its lengths have no unit.
    [[nodiscard]] Found find_not_normalized() const {
        constexpr double kMost = 0.5 * (1 + 0x1p-22);
        for (const Double3& p : mesh_.positions) {
            if (largest_of(p) > kMost) return FalseFact{flag_field("normalized"), "1", "0"};
        }
        const double unit = model_.header().metres_per_unit;
        if (unit != 0) {
            return FalseFact{"the user block, field metres_per_unit", text_of(unit),
                             "0, because the model is normalized"};
        }
        const double factor = model_.header().normalize_factor;
        if (factor > 0 || model_.triangle_count() == 0) return std::nullopt;
        return FalseFact{"the user block, field normalize_factor", text_of(factor),
                         "more than 0, because the model is normalized"};
    }

    [[nodiscard]] Found find_false_normalization() const {
        const format::FileHeader& header = model_.header();
        const double offset = largest_of(header.normalize_offset);
        return first_of(
            [&] {
                return differ("the user block, field normalize_factor", header.normalize_factor,
                              0.0);
            },
            [&] { return differ("the user block, field normalize_offset", offset, 0.0); });
    }

    /// The vertices must be in the order of their first use.
    [[nodiscard]] Found find_vertex_out_of_order() const {
        std::uint32_t next = 0;
        const auto triangles = model_.mesh().triangles;
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            for (const std::uint32_t vertex : triangles[i].vertex) {
                if (vertex > next)
                    return differ(field_of(SectionId::triangles, i, "vertex"), vertex, next);
                if (vertex == next) ++next;
            }
        }
        return differ("the user block, field vertex_count", model_.vertex_count(), next);
    }

    /// The section is absent if no triangle is degenerate, so absent words count as zeros.
    [[nodiscard]] Found find_false_degenerate() const {
        mesh::Mesh ordered;
        ordered.positions = mesh_.positions;
        ordered.triangles.assign(model_.mesh().triangles.begin(), model_.mesh().triangles.end());
        const std::vector<std::uint64_t> expected = mesh::find_degenerate(ordered, parallel_for_);
        const auto found = model_.mesh().degenerate_bits;
        for (std::size_t i = 0; i < std::max(found.size(), expected.size()); ++i) {
            const std::uint64_t is = i < found.size() ? found[i] : 0;
            const std::uint64_t must_be = i < expected.size() ? expected[i] : 0;
            if (is == must_be) continue;
            const auto bit = static_cast<std::size_t>(std::countr_zero(is ^ must_be));
            return FalseFact{"section " +
                                 std::string(format::section_name(SectionId::degenerate_bits)) +
                                 ", bit " + std::to_string(64 * i + bit),
                             text_of((is >> bit & 1) != 0), text_of((must_be >> bit & 1) != 0)};
        }
        return std::nullopt;
    }

    [[nodiscard]] Found find_false_bounds() const {
        if (model_.record().bounds == nullptr) return std::nullopt;
        const format::Bounds& found = *model_.record().bounds;
        const format::Bounds expected = convex::find_bounds(mesh_);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto differs = [&](const char* field, const Double3& is, const Double3& must_be) {
                return differ(
                    field_of(SectionId::bounds, 0, std::string(field) + "." + kAxisName[axis]),
                    coordinate(is, axis), coordinate(must_be, axis));
            };
            if (Found fact = differs("lower", found.lower, expected.lower)) return fact;
            if (Found fact = differs("upper", found.upper, expected.upper)) return fact;
        }
        return first_of([&] { return find_crooked_axes(found); },
                        [&] { return find_vertex_outside(found); },
                        [&] { return find_large_box(found); });
    }

    /// The axes must have unit length, be perpendicular and form a right-handed system.
    static Found find_crooked_axes(const format::Bounds& bounds) {
        constexpr double kTolerance = 0x1p-44;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k <= i; ++k) {
                const double product = mesh::dot(bounds.axis[i], bounds.axis[k]);
                if (std::fabs(product - (i == k ? 1 : 0)) <= kTolerance) continue;
                return FalseFact{field_of(SectionId::bounds, 0, "axis"),
                                 "the dot product " + text_of(product) + " of axes " + text_of(i) +
                                     " and " + text_of(k),
                                 i == k ? "1" : "0"};
            }
        }
        const double turn = mesh::dot(mesh::cross(bounds.axis[0], bounds.axis[1]), bounds.axis[2]);
        if (turn > 0 || bounds.half_extent == Double3{0, 0, 0}) return std::nullopt;
        return FalseFact{field_of(SectionId::bounds, 0, "axis"), "a left-handed system",
                         "a right-handed one"};
    }

    /// The rounding error of a coordinate along an axis is a few units in the last place of the
    /// vertex's distance from the centre.
    [[nodiscard]] Found find_vertex_outside(const format::Bounds& bounds) const {
        constexpr double kRounding = 0x1p-46;
        for (const Double3& p : mesh_.positions) {
            const Double3 from = mesh::minus(p, bounds.oriented_centre);
            const double slack = kRounding * largest_of(from) + 0x1p-1070;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double along = std::fabs(mesh::dot(from, bounds.axis[axis]));
                if (!(along > coordinate(bounds.half_extent, axis) + slack)) continue;
                return FalseFact{
                    field_of(SectionId::bounds, 0, std::string("half_extent.") + kAxisName[axis]),
                    text_of(coordinate(bounds.half_extent, axis)), "at least " + text_of(along)};
            }
        }
        return std::nullopt;
    }

    /// A bake stores the box along the axes as the oriented box if it finds no smaller one. The
    /// comparison allows for the widening of the oriented box.
    static Found find_large_box(const format::Bounds& bounds) {
        const Double3 size = mesh::minus(bounds.upper, bounds.lower);
        const double scale = largest_of(size);
        if (!(scale > 0) || !std::isfinite(scale)) return std::nullopt;
        const double widened =
            0x1p-40 + 0x1p-46 * largest_of(bounds.oriented_centre) / scale + 0x1p-1060 / scale;
        double oriented = 1;
        double aligned = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            oriented *= 2 * coordinate(bounds.half_extent, axis) / scale;
            aligned *= coordinate(size, axis) / scale + widened;
        }
        constexpr double kTolerance = 0x1p-30;
        if (!(oriented > aligned * (1 + kTolerance))) return std::nullopt;
        return FalseFact{field_of(SectionId::bounds, 0, "half_extent"),
                         text_of(oriented / aligned) + " times the volume of the axis-aligned box",
                         "at most 1 times"};
    }

    [[nodiscard]] Found find_false_components() const {
        if (!model_.sections().contains(SectionId::components)) return std::nullopt;
        const auto found = model_.record().components;
        const std::vector<format::Component>& expected = topology_.components;
        if (Found fact = differ<std::size_t>("section components, number of elements", found.size(),
                                             expected.size())) {
            return fact;
        }
        const mesh::ComponentNumbers numbers = mesh::number_components(mesh_);
        std::vector<bool> seen(expected.size(), false);
        for (std::size_t i = 0; i < found.size(); ++i) {
            const std::size_t number = numbers.of_vertex[found[i].vertex];
            if (seen[number] || (has_source_ && number != i)) {
                return FalseFact{field_of(SectionId::components, i, "vertex"),
                                 text_of(found[i].vertex), "a vertex of this component"};
            }
            seen[number] = true;
            if (Found fact = compare(i, found[i], expected[number])) return fact;
        }
        return std::nullopt;
    }

    [[nodiscard]] Found compare(std::size_t i, const format::Component& found,
                                const format::Component& expected) const {
        const auto field = [i](const char* name) {
            return field_of(SectionId::components, i, name);
        };
        return first_of(
            [&] {
                return differ(field("triangle_count"), found.triangle_count,
                              expected.triangle_count);
            },
            [&] { return differ(field("flags"), found.flags, expected.flags); },
            [&] {
                return differ_by(field("signed_volume"), found.signed_volume,
                                 expected.signed_volume, volume_error());
            });
    }

    /// A sum in the order of the source triangles is the same in every run.
    [[nodiscard]] double volume_error() const {
        return has_source_ ? 0 : error_.volume_about_any;
    }
    [[nodiscard]] double area_error() const {
        return has_source_ ? 0 : error_.area;
    }

    [[nodiscard]] Found find_false_mass() const {
        if (model_.record().mass == nullptr) return std::nullopt;
        if (!topology_.balanced) {
            return FalseFact{"section mass_properties, number of elements", "1",
                             "0, because the mesh is not balanced"};
        }
        const format::MassProperties& found = *model_.record().mass;
        const auto field = [](const char* name) {
            return field_of(SectionId::mass_properties, 0, name);
        };
        const auto expected = convex::find_mass_properties(mesh_);
        if (!expected) return differ_by(field("volume"), found.volume, 0, error_.volume);
        if (Found fact =
                differ_by(field("volume"), found.volume, expected->volume, error_.volume)) {
            return fact;
        }
        if (Found fact = differ_by(field("surface_area"), found.surface_area,
                                   expected->surface_area, error_.area)) {
            return fact;
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (Found fact = differ_by(field("centre") + "." + kAxisName[axis],
                                       coordinate(found.centre, axis),
                                       coordinate(expected->centre, axis), error_.centre)) {
                return fact;
            }
        }
        constexpr std::array<const char*, 6> kEntry = {"xx", "yy", "zz", "xy", "yz", "zx"};
        for (std::size_t i = 0; i < kEntry.size(); ++i) {
            if (Found fact = differ_by(field("inertia") + "." + kEntry[i], found.inertia[i],
                                       expected->inertia[i], error_.inertia)) {
                return fact;
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] Found find_false_verdicts() const {
        if (!model_.sections().contains(SectionId::verdicts)) return std::nullopt;
        std::vector<format::Verdict> found(model_.record().verdicts.begin(),
                                           model_.record().verdicts.end());
        std::vector<format::Verdict> expected = find_verdicts(found);
        if (Found fact = differ<std::size_t>("section verdicts, number of elements", found.size(),
                                             expected.size())) {
            return fact;
        }
        leave_open(found, expected);
        if (!has_source_) {
            sort_components(found);
            sort_components(expected);
        }
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (Found fact = compare(i, found[i], expected[i])) return fact;
        }
        return std::nullopt;
    }

    /// Returns the verdicts on the mesh, with the limits of a bake: its search for crossings may
    /// have ended at the same pair. Searches without limits if the file's verdicts examine more.
    [[nodiscard]] std::vector<format::Verdict> find_verdicts(
        const std::vector<format::Verdict>& found) const {
        mesh::DefectOptions options;
        options.max_places = 0;
        options.parallel_for = parallel_for_;
        const mesh::TriangleSoup soup = soup_of(mesh_);
        mesh::DefectReport report = mesh::find_defects(soup, options);
        const auto examined = [](const std::vector<format::Verdict>& verdicts) {
            return std::count_if(verdicts.begin(), verdicts.end(), is_examined);
        };
        if (report.crossings_complete || examined(found) <= examined(report.verdicts)) {
            return std::move(report.verdicts);
        }
        options.max_pairs = options.max_steps = mesh::SearchLimits::kNone;
        return mesh::find_defects(soup, options).verdicts;
    }

    static bool is_examined(const format::Verdict& verdict) {
        return (verdict.facts & format::verdict_crossings_examined) != 0;
    }

    static bool is_free(const format::Verdict& verdict) {
        return is_examined(verdict) && (verdict.facts & format::verdict_self_crossing) == 0;
    }

    /// Removes the facts about crossings from verdicts that leave crossings open. Such a verdict
    /// claims nothing about crossings that could be false, and must not promise a simple solid. If
    /// the order of components is unknown, one open component leaves all components open.
    void leave_open(std::vector<format::Verdict>& found,
                    std::vector<format::Verdict>& expected) const {
        constexpr std::uint32_t kCrossing =
            format::verdict_crossings_examined | format::verdict_self_crossing;
        // A verdict without crossings shows that all pairs were examined.
        if (std::any_of(found.begin(), found.end(), is_free)) return;
        const bool all_known = std::all_of(found.begin() + 1, found.end(), is_examined);
        for (std::size_t i = 0; i < found.size(); ++i) {
            const bool is_open = !is_examined(found[i]);
            if (!is_open && (has_source_ || i == 0 || all_known)) continue;
            if (!is_open) found[i].promises &= ~std::uint32_t{format::promise_simple_solid};
            expected[i].promises &= ~std::uint32_t{format::promise_simple_solid};
            found[i].facts &= ~kCrossing;
            expected[i].facts &= ~kCrossing;
        }
    }

    /// Sorts the verdicts of components whose order is unknown: by all exact fields together, and
    /// each sum by itself. If two lists agree within an error, so do their sorted lists.
    static void sort_components(std::vector<format::Verdict>& verdicts) {
        std::vector<double> areas;
        std::vector<double> volumes;
        for (std::size_t i = 1; i < verdicts.size(); ++i) {
            areas.push_back(verdicts[i].area);
            volumes.push_back(verdicts[i].volume);
        }
        std::sort(areas.begin(), areas.end());
        std::sort(volumes.begin(), volumes.end());
        std::sort(verdicts.begin() + 1, verdicts.end(),
                  [](const format::Verdict& a, const format::Verdict& b) {
                      const auto key = [](const format::Verdict& v) {
                          return std::tie(v.facts, v.promises, v.triangle_count, v.boundary_loops,
                                          v.euler, v.genus);
                      };
                      return key(a) < key(b);
                  });
        for (std::size_t i = 1; i < verdicts.size(); ++i) {
            verdicts[i].area = areas[i - 1];
            verdicts[i].volume = volumes[i - 1];
        }
    }

    [[nodiscard]] Found compare(std::size_t i, const format::Verdict& found,
                                const format::Verdict& expected) const {
        const auto field = [&](const char* name) {
            const std::string of_component = "section verdicts, of a component, field ";
            return has_source_ || i == 0 ? field_of(SectionId::verdicts, i, name)
                                         : of_component + name;
        };
        if (found.facts != expected.facts) {
            return FalseFact{field("facts"), facts_text(found), facts_text(expected)};
        }
        if (found.promises != expected.promises) {
            return FalseFact{field("promises"), promises_text(found), promises_text(expected)};
        }
        return first_of(
            [&] {
                return differ(field("triangle_count"), found.triangle_count,
                              expected.triangle_count);
            },
            [&] {
                return has_source_ ? differ(field("first_triangle"), found.first_triangle,
                                            expected.first_triangle)
                                   : Found{};
            },
            [&] {
                return differ(field("boundary_loops"), found.boundary_loops,
                              expected.boundary_loops);
            },
            [&] { return differ(field("euler"), found.euler, expected.euler); },
            [&] { return differ(field("genus"), found.genus, expected.genus); },
            [&] { return differ_by(field("area"), found.area, expected.area, area_error()); },
            [&] {
                return differ_by(field("volume"), found.volume, expected.volume, volume_error());
            });
    }

    const Model& model_;
    ParallelFor parallel_for_;
    mesh::Mesh mesh_;  ///< in source order if it is known; else in tree order
    bool has_source_;
    mesh::Topology topology_;
    convex::MassError error_;
};

}  // namespace

std::optional<FalseFact> find_false_fact(const Model& model, ParallelFor parallel_for) {
    return FactCheck(model, parallel_for).find();
}

std::string false_fact_sentence(const std::string& file, const FalseFact& fact) {
    return file + ": " + fact.field + " does not match the mesh: found " + fact.found +
           ", expected " + fact.expected + ". Copy the file again, or bake it again.";
}

}  // namespace cdprep::cli
