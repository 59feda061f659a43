// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/load_models.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <utility>

#include "cdprep/format/file_header.h"
#include "cdprep/format/sections.h"
#include "cdprep/hulls.h"
#include "cli/colliders.h"
#include "cli/open_for.h"
#include "scene_file/bake_cache.h"
#include "text/number_text.h"
#include "text/printable.h"
#include "text/space_name.h"

namespace cdprep::scenes {
namespace {

namespace fs = std::filesystem;

/// Returns whether a file begins like a baked one.
bool is_baked_file(const fs::path& path) {
    std::array<char, format::kMagic.size()> magic{};
    std::ifstream(path, std::ios::binary).read(magic.data(), magic.size());
    return magic == format::kMagic;
}

/// Returns the options to bake a mesh for exactly these queries.
Result<cli::BakeOptions> bake_options_for(Ask asks, const import::ImportOptions& import) {
    constexpr std::string_view kOption = "--effects ";
    std::string list;
    for (const Needs& row : needs()) {
        const std::string_view option = row.bake_option;
        if ((asks & row.ask) == Ask::nothing || !option.starts_with(kOption)) continue;
        if (!list.empty()) list += ",";
        list += option.substr(kOption.size());
    }
    Result<cli::Effects> effects = cli::parse_effects(list);
    if (!effects) return effects.error();
    cli::BakeOptions options;
    options.bounds = cli::bounds_for(*effects);
    options.effects = std::move(effects).value();
    options.import = import;
    return options;
}

/// Makes a bake read a model of an assembly. Equal words name equal models of one file.
void read_model(const AssemblyScene& assembly, const AssemblyModel& model, cli::BakeOptions& bake) {
    std::vector<import::PlacedNode> nodes;
    for (const AssemblyNode& placed : model) {
        const import::MeshNode& node = assembly.file.nodes()[placed.node];
        nodes.push_back({&node, placed.model_from_mesh});
        bake.part += bake.part.empty() ? "meshes" : " meshes";
        for (const std::uint32_t mesh : node.meshes) bake.part += " " + std::to_string(mesh);
        bake.part += " transform";
        for (const double x : placed.model_from_mesh) bake.part += " " + report::number_text(x);
    }
    bake.read = [&assembly, nodes](const fs::path& /*input*/,
                                   const import::ImportOptions& /*options*/) {
        return assembly.file.triangles(nodes);
    };
}

/// Returns all sections of the file of a model, also those that were not opened.
format::SectionSet sections_of_file(const Model& model) {
    format::SectionSet sections;
    for (const format::SectionKind& kind : format::section_kinds()) {
        if (format::find_section(model.bytes(), kind.id)) sections.insert(kind.id);
    }
    return sections;
}

bool has_exact_leaves(const Model& model) {
    return (model.header().flags & format::model_exact_leaves) != 0 && model.triangle_count() > 0;
}

Ask served_by_file(const Model& model) {
    return served_by(sections_of_file(model), has_exact_leaves(model));
}

/// Returns the sections that a file lacks for these queries.
format::SectionSet missing_of(const Model& model, Ask asks) {
    const format::SectionSet sections = sections_of_file(model);
    format::SectionSet missing;
    for (const Needs& row : needs()) {
        if (!contains(asks, row.ask)) continue;
        missing.insert(missing_sections(row.ask, sections, has_exact_leaves(model)));
    }
    return missing;
}

std::vector<std::string> names_of(Ask asks) {
    std::vector<std::string> names;
    for (const Needs& row : needs()) {
        if (contains(asks, row.ask)) names.emplace_back(row.name);
    }
    return names;
}

/// Either kind of positions is enough, so one name covers both.
std::vector<std::string> names_of(format::SectionSet sections) {
    std::vector<std::string> names;
    for (const format::SectionKind& kind : format::section_kinds()) {
        if (!sections.contains(kind.id)) continue;
        const bool is_positions = kind.id == format::SectionId::positions_f32;
        names.emplace_back(is_positions ? "positions" : kind.name);
    }
    return names;
}

/// Words as a sentence lists them: "a, b and c".
std::string listed(const std::vector<std::string>& words, const char* last = " and ") {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        text += (i == 0 ? "" : i + 1 < words.size() ? ", " : last) + words[i];
    }
    return text;
}

std::vector<std::string> layers_that_need(const SceneFile& scene, const ModelNeeds& needs,
                                          Ask lacking) {
    std::vector<std::string> names;
    for (std::size_t layer = 0; layer < scene.layers.size(); ++layer) {
        if ((needs.asks_of_layers[layer] & lacking) == Ask::nothing) continue;
        names.push_back("'" + report::printable(scene.layers[layer]) + "'");
    }
    return names;
}

/// Returns whether the next model may still be opened after such an error.
bool is_of_one_model(ErrorCode code) {
    return code == ErrorCode::unreadable || code == ErrorCode::bad_argument;
}

/// Loads the models of one scene.
class Loader {
public:
    Loader(const SceneFile& scene, const LoadOptions& options, const cli::Threads& threads)
        : scene_(scene), options_(options), threads_(threads), cache_(options.cache) {}

    Result<SceneModel> load(std::size_t number, const ModelNeeds& needs) {
        const fs::path& path = scene_.models[number];
        done_ = number;
        SceneModel loaded;
        loaded.needs = needs;
        if (needs.asks == Ask::nothing) return loaded;
        if (const auto error = open(path, loaded)) return *error;
        if (!loaded.model) return loaded;
        if (const auto error = find_other_unit(path, *loaded.model)) return *error;
        return loaded;
    }

private:
    std::optional<Error> open(const fs::path& path, SceneModel& loaded) {
        const AssemblyScene* const assembly = options_.assembly;
        if (assembly == nullptr && is_baked_file(path)) {
            loaded.origin = ModelOrigin::baked;
            return open_sections(path, loaded);
        }
        if (!options_.bakes) return std::nullopt;
        Result<cli::BakeOptions> bake = bake_options_for(loaded.needs.wanted(), options_.import);
        if (!bake) return bake.error();
        if (assembly != nullptr) {
            read_model(*assembly, assembly->models[done_], *bake);
        } else {
            bake->read = [&loaded](const fs::path& file, const import::ImportOptions& limits) {
                Result<mesh::TriangleSoup> soup = import::import_file(file, limits);
                if (!soup) return soup;
                loaded.colliders = cli::find_colliders(*soup);
                loaded.remarks = soup->remarks;
                return soup;
            };
        }
        const auto begins = [&](const char* stage) {
            options_.begins(done_, path.filename().string() + ": " + stage);
        };
        if (options_.cache.empty()) {
            loaded.origin = ModelOrigin::in_memory;
            Result<cli::BakedImage> image = cli::bake_image(path, *bake, threads_, begins);
            if (!image) return image.error();
            loaded.image.emplace(std::move(image).value());
            const std::string name = path.string();
            return keep(
                Model::open(loaded.image->bytes(),
                            {.sections = sections_for(loaded.needs.wanted()), .name = name}),
                loaded);
        }
        loaded.origin = ModelOrigin::cached;
        const Result<fs::path> cached = cache_.find_or_bake(
            assembly == nullptr ? path : fs::path(scene_.name), *bake, threads_, begins);
        if (!cached) return cached.error();
        return open_sections(*cached, loaded);
    }

    static std::optional<Error> open_sections(const fs::path& path, SceneModel& loaded) {
        return keep(Model::open(path, sections_for(loaded.needs.wanted())), loaded);
    }

    static std::optional<Error> keep(Result<Model> opened, SceneModel& loaded) {
        if (!opened) return opened.error();
        loaded.model.emplace(std::move(opened).value());
        return std::nullopt;
    }

    /// A scene moves models, but does not scale them.
    [[nodiscard]] std::optional<Error> find_other_unit(const fs::path& path, const Model& model) {
        const double unit = cli::unit_of(model);
        if (unit == 0) return std::nullopt;
        if (scene_.metres_per_unit == 0) return find_unlike_first(path, unit);
        if (!cli::are_unlike_units(unit, scene_.metres_per_unit)) return std::nullopt;
        return Error{ErrorCode::bad_argument, scene_.name + ": " + path.string() + " is in " +
                                                  report::unit_name(unit) +
                                                  ", but the unit of the scene is " +
                                                  report::unit_name(scene_.metres_per_unit) +
                                                  ". Convert the mesh, or change metres_per_unit."};
    }

    /// For a scene without a unit: the models must share one.
    [[nodiscard]] std::optional<Error> find_unlike_first(const fs::path& path, double unit) {
        if (unit_ == 0) {
            unit_ = unit;
            first_with_unit_ = path;
        }
        std::optional<Error> error = cli::find_unlike_units(first_with_unit_, unit_, path, unit);
        if (error) error->message = scene_.name + ": " + error->message;
        return error;
    }

    const SceneFile& scene_;
    const LoadOptions& options_;
    const cli::Threads& threads_;
    BakeCache cache_;
    std::size_t done_ = 0;  ///< models before the current one
    double unit_ = 0;       ///< of the first model with one
    fs::path first_with_unit_;
};

}  // namespace

LoadedModels load_models(const SceneFile& scene, std::span<const ModelNeeds> needs,
                         const LoadOptions& options, const cli::Threads& threads) {
    Loader loader(scene, options, threads);
    LoadedModels all;
    all.models.resize(scene.models.size());
    for (std::size_t i = 0; i < scene.models.size(); ++i) {
        Result<SceneModel> loaded = loader.load(i, needs[i]);
        if (loaded) {
            all.models[i] = std::move(loaded).value();
            continue;
        }
        all.errors.push_back(loaded.error());
        if (!is_of_one_model(loaded.error().code)) break;
    }
    return all;
}

LoadedModels load_models(const SceneFile& scene, std::span<const ModelNeeds> needs,
                         LoadOptions options, cli::ProgressStyle style,
                         const cli::Threads& threads) {
    cli::Progress progress(style, scene.models.size());
    options.begins = [&](std::size_t done, const std::string& what) { progress.show(done, what); };
    LoadedModels loaded = load_models(scene, needs, options, threads);
    progress.clear();
    return loaded;
}

std::vector<std::string> import_lines(const SceneFile& scene,
                                      const std::vector<SceneModel>& models) {
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < models.size(); ++i) {
        for (const std::string& remark : models[i].remarks) {
            lines.push_back(scene.models[i].string() + ": " + remark);
        }
        if (models[i].colliders.empty()) continue;
        lines.push_back(scene.models[i].string() + ": " +
                        cli::kept_text(models[i].colliders, "by naming a baked file"));
    }
    return lines;
}

std::vector<ModelUse> uses_of_parts(const SceneFile& scene) {
    const bool permits_error = std::ranges::any_of(scene.pairs, [](const AskedPair& pair) {
        return pair.asked.max_error > 0 && pair.asked.body == Body::solid;
    });
    if (!permits_error) return {};
    std::vector<ModelUse> uses(scene.models.size(), {"", known_asks(), 0});
    for (const FileObject& object : scene.objects) uses[object.model].layers |= 1U << object.layer;
    SectionSet sections = sections_for(Ask::hulls);
    sections.insert(SectionId::components);
    for (std::size_t i = 0; i < uses.size(); ++i) {
        if (uses[i].layers == 0 || !is_baked_file(scene.models[i])) continue;
        const Result<Model> model = Model::open(scene.models[i], sections);
        if (model) uses[i].parts = enclosing_parts(*model);
    }
    return uses;
}

std::vector<ModelUse> uses_of(const SceneFile& scene, std::span<const SceneModel> models,
                              std::vector<std::string>& names) {
    names.clear();
    for (const fs::path& path : scene.models) names.push_back(path.string());
    std::vector<ModelUse> uses;
    for (std::size_t i = 0; i < models.size(); ++i) {
        if (!models[i].model) continue;
        const Model& model = *models[i].model;
        uses.push_back({names[i], model.asks(), models[i].needs.layers, enclosing_parts(model)});
    }
    return uses;
}

Ask lacking_asks(const SceneModel& model) {
    if (!model.model) return Ask::nothing;
    const Ask lacking = without(model.needs.asks, model.model->asks());
    const bool lacks_mass = contains(lacking, Ask::response);
    if (!lacks_mass || model.model->is_balanced()) return lacking;
    const format::SectionSet missing = missing_of(*model.model, Ask::response);
    const bool is_all = missing == format::SectionSet{format::SectionId::mass_properties};
    return is_all ? without(lacking, Ask::response) : lacking;
}

std::vector<std::string> model_refusals(const SceneFile& scene,
                                        std::span<const SceneModel> models) {
    std::vector<std::string> refusals;
    for (std::size_t i = 0; i < models.size(); ++i) {
        const Ask lacking = lacking_asks(models[i]);
        if (lacking == Ask::nothing) continue;
        const format::SectionSet missing = missing_of(*models[i].model, lacking);
        const std::vector<std::string> layers = layers_that_need(scene, models[i].needs, lacking);
        const bool is_one = layers.size() == 1;
        refusals.push_back(
            scene.name + ": " + report::printable(scene.models[i].string()) +
            (is_one ? ": its layer " : ": its layers ") + listed(layers) +
            (is_one ? " needs " : " need ") + listed(names_of(lacking)) + ", but the file has no " +
            listed(names_of(missing), " or ") + ". Bake it again with " +
            cli::options_to_bake(models[i].needs.asks, served_by_file(*models[i].model),
                                 sections_of_file(*models[i].model)) +
            ".");
    }
    return refusals;
}

}  // namespace cdprep::scenes
