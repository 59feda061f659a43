// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "cdprep/advanced/structure.h"
#include "cdprep/model.h"

namespace cdprep::cli {

/// Returns `why`, or for a mesh file an error that advises to bake it first.
[[nodiscard]] Error baked_first(const std::filesystem::path& path, Error why);

/// Opens a baked file with the sections that a query and its structure need or use, and no
/// others. Fails with bad_argument if the file was baked without a needed section; the message
/// states how to bake it.
[[nodiscard]] Result<Model> open_for(const std::filesystem::path& path, Ask asks,
                                     Structure through = Structure::bvh);

/// Returns the length of a model's unit in metres. Returns 0 if it is unknown, as it is after
/// --normalize.
[[nodiscard]] double unit_of(const Model& model);

/// Returns true if two units are known and differ by more than the rounding to floats. Some formats
/// store units in floats.
[[nodiscard]] bool are_unlike_units(double unit_a, double unit_b) noexcept;

/// Returns an error if the units of two meshes are unlike: poses do not scale. Units are in metres.
[[nodiscard]] std::optional<Error> find_unlike_units(const std::filesystem::path& path_a,
                                                     double unit_a,
                                                     const std::filesystem::path& path_b,
                                                     double unit_b);

/// As the overload for units, for two models.
[[nodiscard]] std::optional<Error> find_unlike_units(const std::filesystem::path& path_a,
                                                     const Model& a,
                                                     const std::filesystem::path& path_b,
                                                     const Model& b);

}  // namespace cdprep::cli
