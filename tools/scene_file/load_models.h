// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/pipeline.h"
#include "cdprep/model.h"
#include "cli/program_threads.h"
#include "cli/progress.h"
#include "import/import_file.h"
#include "scene_file/compile_scene.h"
#include "scene_file/read_assembly.h"

namespace cdprep::scenes {

enum class ModelOrigin : std::uint8_t {
    unused,     ///< no pair of layers uses its objects: nothing was read
    baked,      ///< the scene names a baked file
    in_memory,  ///< a mesh file, baked into memory
    cached,     ///< a mesh file, whose bake is in the cache
};

/// A model of a scene. All objects that name its file share it.
struct SceneModel {
    ModelOrigin origin = ModelOrigin::unused;
    std::optional<cli::BakedImage> image;  ///< the bytes of a model in memory
    std::optional<Model> model;            ///< nothing if unused
    ModelNeeds needs;
    /// Of a mesh file that was baked now: nodes and groups that engines collide with and do not
    /// show. They are a part of the model.
    std::vector<std::string> colliders;
    std::vector<std::string> remarks;  ///< of the import of a mesh file that was baked now
};

struct LoadOptions {
    std::filesystem::path cache;  ///< the folder of baked meshes; empty: bake into memory
    import::ImportOptions import;
    const AssemblyScene* assembly = nullptr;  ///< whose models are loaded; null: models are files
    bool bakes = true;                        ///< false: the models of mesh files stay closed
    /// Called as a stage of a bake begins, with the number of models before and "FILE: STAGE".
    std::function<void(std::size_t done, const std::string& what)> begins =
        [](std::size_t /*done*/, const std::string& /*what*/) {};
};

/// Models in the order of SceneFile::models. Those with errors are closed.
struct LoadedModels {
    std::vector<SceneModel> models;
    std::vector<Error> errors;
};

/// Opens the models that serve something, with exactly the sections that are needed or used. The
/// needs are those of needs_of_models(). Mesh files are baked for these sections. A baked file may
/// lack some: model_refusals() tells. There is an error for each model that cannot be read, or
/// whose unit is not that of the scene. Any other error is the last: no model is opened after it.
[[nodiscard]] LoadedModels load_models(const SceneFile& scene, std::span<const ModelNeeds> needs,
                                       const LoadOptions& options, const cli::Threads& threads);

/// The same, and shows the progress.
[[nodiscard]] LoadedModels load_models(const SceneFile& scene, std::span<const ModelNeeds> needs,
                                       LoadOptions options, cli::ProgressStyle style,
                                       const cli::Threads& threads);

/// Returns lines about the mesh files that were baked now: a line for each remark of an import, and
/// one for each file that has colliders as a part of its model.
[[nodiscard]] std::vector<std::string> import_lines(const SceneFile& scene,
                                                    const std::vector<SceneModel>& models);

/// Returns what the enclosing parts of baked files certify, for a first compile_scene(). These uses
/// serve everything else. Reads the hulls of the files if a pair of layers permits an error of
/// solids; otherwise there are none. Files that cannot be read have no parts: load_models() tells.
[[nodiscard]] std::vector<ModelUse> uses_of_parts(const SceneFile& scene);

/// Returns the uses of the models that were opened, for compile_scene(). `names` gets the names
/// that they refer to.
[[nodiscard]] std::vector<ModelUse> uses_of(const SceneFile& scene,
                                            std::span<const SceneModel> models,
                                            std::vector<std::string>& names);

/// Returns what a model must serve, but does not. The mass of an unbalanced mesh does not count: no
/// bake of that mesh has it.
[[nodiscard]] Ask lacking_asks(const SceneModel& model);

/// Returns why models that were opened do not serve their layers: a sentence for each such model.
/// It names the layers, what they need, the missing sections and how to bake the file again.
[[nodiscard]] std::vector<std::string> model_refusals(const SceneFile& scene,
                                                      std::span<const SceneModel> models);

}  // namespace cdprep::scenes
