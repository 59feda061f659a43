// SPDX-License-Identifier: GPL-3.0-or-later
#include "write/hulls_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "write/hulls_text.h"
#include "write/mesh_bytes.h"
#include "write/output_file.h"
#include "write/own_file.h"

namespace cdprep::write {
namespace {

namespace fs = std::filesystem;
using format::Double3;

void append_object(std::string& text, const HullArrays& hull, std::uint64_t& first) {
    text += "o " + hull.name + "\n";
    for (const Double3& p : hull.points) {
        text += "v ";
        append_point_text(text, p);
        text += '\n';
    }
    for (const auto& f : hull.facets) append_triangle(text, {f}, "f ", first);
    first += hull.points.size();
}

std::string obj_text(std::span<const HullArrays> hulls) {
    std::string text;
    std::uint64_t first = 1;
    for (const HullArrays& hull : hulls) append_object(text, hull, first);
    return text;
}

std::string scale_text(double scale) {
    std::string text;
    for (int i = 0; i < 3; ++i) {
        if (i > 0) text += ' ';
        append_number(text, scale);
    }
    return text;
}

/// Returns the common prefix of the mesh names. Files in one folder have different prefixes, unless
/// their names differ only in the extension.
std::string mesh_stem(const fs::path& path) {
    std::string name = model_name(path);
    const std::string stem = path.stem().string();
    if (name == stem) return name;
    std::uint32_t hash = 2166136261U;  // FNV-1a
    for (const char letter : stem) {
        hash = (hash ^ static_cast<unsigned char>(letter)) * 16777619U;
    }
    return name + "_" + std::to_string(hash);
}

std::string text_in(HullsFormat format, const RobotFile& file) {
    switch (format) {
        case HullsFormat::obj:
            return obj_text(file.hulls);
        case HullsFormat::glb:
            return glb_bytes(file);
        case HullsFormat::urdf:
            return urdf_text(file);
        case HullsFormat::sdf:
            return sdf_text(file);
        case HullsFormat::mjcf:
            return mjcf_text(file);
    }
    return {};
}

std::string own(std::string text) {
    return text.insert(0, kOwnLine);
}

/// Returns the mesh files to which a URDF, SDF or MJCF refers.
std::vector<FileBytes> mesh_files(const fs::path& folder, HullsFormat format,
                                  const RobotFile& file) {
    std::vector<FileBytes> files;
    if (has_mesh_files(format)) {
        for (const HullArrays& hull : file.hulls) {
            files.push_back({folder / mesh_name(file, hull.name), own(obj_text({&hull, 1}))});
        }
    }
    if (has_mass(format) && file.options.visual) {
        files.push_back({folder / mesh_name(file, kVisual),
                         own(bytes_of(MeshFormat::obj, *file.options.visual))});
    }
    return files;
}

template <class Visit>
void each_point(const RobotFile& file, const Visit& visit) {
    for (const HullArrays& hull : file.hulls) std::ranges::for_each(hull.points, visit);
    if (file.options.visual) std::ranges::for_each(file.options.visual->positions, visit);
}

/// Returns the largest coordinate in size.
double largest_coordinate(const RobotFile& file) {
    double largest = 0;
    each_point(file, [&](const Double3& p) {
        largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    });
    return largest;
}

/// Returns an upper bound of how far a point moves when floats round it. Scaling by a power of two
/// does not change it.
double rounding_of(const RobotFile& file) {
    constexpr double kUp = 1 + 1e-12;  // above the rounding of the sums
    double most = 0;
    each_point(file, [&](const Double3& p) {
        const auto moved = [](double x) { return x - static_cast<double>(static_cast<float>(x)); };
        most = std::max(most, kUp * std::hypot(moved(p.x), moved(p.y), moved(p.z)));
    });
    return most;
}

/// Returns the diagonal of the box around all points.
double size_of(const RobotFile& file) {
    std::optional<Double3> lower, upper;
    each_point(file, [&](const Double3& p) {
        if (!lower) lower = upper = p;
        lower = {std::min(lower->x, p.x), std::min(lower->y, p.y), std::min(lower->z, p.z)};
        upper = {std::max(upper->x, p.x), std::max(upper->y, p.y), std::max(upper->z, p.z)};
    });
    if (!lower) return 0;
    return std::hypot(upper->x - lower->x, upper->y - lower->y, upper->z - lower->z);
}

/// Returns the bytes of the arrays in a GLB, which counts them in 32 bits.
std::uint64_t array_bytes(const RobotFile& file) {
    std::uint64_t elements = 0;
    for (const HullArrays& hull : file.hulls) elements += hull.points.size() + hull.facets.size();
    if (file.options.visual) {
        elements += file.options.visual->positions.size() + file.options.visual->triangles.size();
    }
    return 12 * elements;
}

/// Returns an error for what a GLB cannot hold.
std::optional<Error> find_beyond_glb(const fs::path& path, const RobotFile& file) {
    constexpr std::uint64_t kMostBytes = 0xf0000000U;  // leaves room for the document
    if (array_bytes(file) > kMostBytes) {
        return Error{ErrorCode::bad_argument,
                     path.string() + ": would have " + std::to_string(array_bytes(file)) +
                         " bytes of corners, but a GLB has at most 4 GiB."};
    }
    constexpr double kMost = std::numeric_limits<float>::max();
    const double largest = largest_coordinate(file);
    std::string sentence = path.string() + ": GLB stores floats only, ";
    if (largest > kMost) {
        sentence += "and a coordinate is ";
        append_number(sentence, largest);
        sentence += " in size; the largest float is ";
        append_number(sentence, kMost);
        return Error{ErrorCode::bad_argument, sentence + ". Write OBJ."};
    }
    constexpr double kMostRounding = 1e-3;
    const double rounding = rounding_of(file);
    const double allowed = kMostRounding * size_of(file);
    if (rounding <= allowed || allowed == 0) return std::nullopt;  // a point keeps its shape
    sentence += "which would move a corner by ";
    append_number(sentence, rounding);
    sentence += "; at most ";
    append_number(sentence, allowed);
    return Error{ErrorCode::bad_argument,
                 sentence +
                     " is allowed, a thousandth of the size. Move the model to the origin, "
                     "or scale it if it is tiny."};
}

}  // namespace

std::string model_name(const fs::path& path) {
    std::string name = path.stem().string();
    for (char& letter : name) {
        const bool is_plain =
            (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
            (letter >= '0' && letter <= '9') || letter == '_' || letter == '-' || letter == '.';
        if (!is_plain) letter = '_';
    }
    return name;
}

std::string mesh_name(const RobotFile& file, const std::string& hull) {
    return file.mesh_stem + "_" + hull + ".obj";
}

std::optional<HullsFormat> hulls_format_of(const fs::path& path) {
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending == ".obj") return HullsFormat::obj;
    if (ending == ".glb") return HullsFormat::glb;
    if (ending == ".urdf") return HullsFormat::urdf;
    if (ending == ".sdf") return HullsFormat::sdf;
    if (ending == ".mjcf" || ending == ".xml") return HullsFormat::mjcf;
    return std::nullopt;
}

bool may_replace(const fs::path& path, HullsFormat format, const fs::path& file) {
    if (!has_mesh_files(format)) return false;
    const auto folder_of = [](const fs::path& of) {
        std::error_code unknown;
        return fs::weakly_canonical(fs::absolute(of).parent_path(), unknown);
    };
    const std::string name = file.filename().string();
    return folder_of(path) == folder_of(file) && name.starts_with(mesh_stem(path) + "_") &&
           name.ends_with(".obj");
}

std::optional<Error> find_foreign_mesh(const fs::path& path, HullsFormat format,
                                       const std::string& hull) {
    if (!has_mesh_files(format)) return std::nullopt;
    return find_foreign(path.parent_path() / (mesh_stem(path) + "_" + hull + ".obj"));
}

Result<WrittenHulls> write_hulls(const fs::path& path, HullsFormat format,
                                 std::span<const HullArrays> hulls,
                                 const HullsFileOptions& options) {
    std::vector<HullArrays> written(hulls.begin(), hulls.end());
    const int least_dimension = has_mass(format) ? 3 : 0;
    std::erase_if(written, [&](const HullArrays& hull) {
        return hull.dimension < least_dimension || hull.points.empty();
    });
    const RobotFile file = {model_name(path), mesh_stem(path), written, options,
                            scale_text(options.metres_per_unit > 0 ? options.metres_per_unit : 1)};
    if (format == HullsFormat::glb) {
        if (const auto error = find_beyond_glb(path, file)) return *error;
    }
    std::vector<FileBytes> files = mesh_files(path.parent_path(), format, file);
    for (const FileBytes& mesh : files) {
        if (const auto error = find_foreign(mesh.path)) return *error;
    }
    files.push_back({path, text_in(format, file)});
    const Result<Done> done = write_all(files);
    if (!done) return done.error();
    return WrittenHulls{hulls.size() - written.size(),
                        format == HullsFormat::glb ? rounding_of(file) : 0};
}

}  // namespace cdprep::write
