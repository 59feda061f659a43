// SPDX-License-Identifier: MIT
#include "cdprep/plan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "cdprep/format/float_environment.h"
#include "cdprep/format/sections.h"
#include "cdprep/scene.h"
#include "core/layer_names.h"
#include "core/number_text.h"
#include "scene/scene_records.h"

namespace cdprep {
namespace {

bool has(Ask asks, Ask one) noexcept {
    return contains(asks, one);
}

bool has_any(Ask asks, Ask some) noexcept {
    return (asks & some) != Ask::nothing;
}

constexpr Ask kReadsBody = Ask::collide | Ask::distance | Ask::contacts | Ask::continuous;
constexpr Ask kReadsOverlap = Ask::collide | Ask::overlap;
constexpr Ask kReadsMaxDistance = Ask::distance | Ask::haptic;

/// The name of an effect, or its bit if it has none.
std::string name_of(Ask one) {
    const Needs* needs = find_needs(one);
    if (needs != nullptr) return needs->name;
    return "effect bit " + std::to_string(std::countr_zero(static_cast<std::uint32_t>(one)));
}

/// Words as a sentence lists them: "collide, overlap and within".
std::string list_of(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const char* before = i + 1 < words.size() ? ", " : " and ";
        text += (i == 0 ? "" : before) + words[i];
    }
    return text;
}

/// The layers of a set, bit i for layer i.
template <class Names>
std::vector<std::string> names_in(const Names& names, std::uint32_t layers) {
    std::vector<std::string> texts;
    for (std::uint32_t layer = 0; layer < kLayers; ++layer) {
        if ((layers >> layer & 1) != 0) texts.push_back(layer_text(names, layer));
    }
    return texts;
}

/// Returns the reason why an effect is refused: it is not built. Lists the built ones.
std::string unbuilt_effect(Ask one) {
    std::vector<std::string> built;
    built.reserve(std::size(kSceneEffects));
    for (const Ask effect : kSceneEffects) built.push_back(name_of(effect));
    for (const Ask change : {Ask::deform, Ask::tear}) built.push_back(name_of(change));
    return name_of(one) + " is not supported in a scene. Supported effects: " + list_of(built) +
           ".";
}

/// Calls `visit` with each bit.
template <class Visit>
void for_each_bit(Ask asks, const Visit& visit) {
    for (auto bits = static_cast<std::uint32_t>(asks); bits != 0; bits &= bits - 1) {
        visit(static_cast<Ask>(bits & (~bits + 1)));
    }
}

/// Returns all that a pair of layers may ask for.
Ask built_effects() noexcept {
    Ask built = kSceneChanges;
    for (const Ask effect : kSceneEffects) built = built | effect;
    return built;
}

/// The features that models must serve: "collide and solid".
std::string asks_text(Ask asks) {
    std::vector<std::string> names;
    for (const Needs& row : needs()) {
        if (has(asks, row.ask)) names.emplace_back(row.name);
    }
    return list_of(names);
}

/// The option of `cdprep bake` for effects of a scene: "--effects within,contacts".
std::string bake_option(Ask effects) {
    std::string option;
    for (const Needs& row : needs()) {
        const Ask named = row.ask == Ask::solid ? Ask::collide : row.ask;
        if (!has(effects, row.ask) || (named != row.ask && has(effects, named))) continue;
        option += (option.empty() ? "--effects " : ",") + name_of(named);
    }
    return option;
}

/// What a pair of layers asks of the models: its effects, and Ask::solid for solid bodies. Not all
/// models of a layer whose models may change do change.
Ask asks_of_models(const LayerPair& pair) noexcept {
    const Ask effects = without(pair.effects, kSceneChanges);
    const bool is_solid = pair.body == Body::solid && has_any(effects, kReadsBody);
    return is_solid ? effects | Ask::solid : effects;
}

/// Collects the reasons why there is no plan.
class Refusals {
public:
    explicit Refusals(const PlanOptions& options) : options_(options) {
        check_limits();
        for (std::size_t i = 0; i < options.pairs.size(); ++i) check_pair(i);
        for (const ModelUse& model : options.models) check_model(model);
    }
    [[nodiscard]] std::vector<std::string> take() noexcept {
        return std::move(sentences_);
    }

private:
    void add(std::string sentence) {
        sentences_.push_back(std::move(sentence));
    }

    void check_limits() {
        if (options_.limits.objects > kMostWorldBoxes) {
            add("limits.objects is " + std::to_string(options_.limits.objects) +
                "; at most 536870912 are possible.");
        }
        if (options_.limits.threads == 0) add("limits.threads is 0; at least 1 is needed.");
        for (const double x : {options_.origin.x, options_.origin.y, options_.origin.z}) {
            if (std::abs(x) <= format::kMaxCoordinate) continue;
            add("origin holds " + number_text(x) + "; it must be finite, and at most 2^1000.");
        }
    }

    /// The start of a sentence about a pair of layers.
    [[nodiscard]] std::string place_of(std::size_t number) const {
        const LayerPair& pair = options_.pairs[number];
        const auto& names = options_.layer_names;
        return "Pair " + std::to_string(number) + " of layers" +
               (names.empty() ? "" : ", " + layers_text(names, pair.a, pair.b)) + ": ";
    }

    void check_pair(std::size_t number) {
        const LayerPair& pair = options_.pairs[number];
        const std::string place = place_of(number);
        for (const std::uint32_t layer : {pair.a, pair.b}) {
            if (layer < kLayers) continue;
            add(place + "layer " + std::to_string(layer) + " does not exist; there are 0 to 31.");
        }
        for (std::size_t other = 0; other < number; ++other) {
            const LayerPair& before = options_.pairs[other];
            if (std::minmax(pair.a, pair.b) != std::minmax(before.a, before.b)) continue;
            add(place + "layers " + layers_text(options_.layer_names, pair.a, pair.b) +
                " are also those of pair " + std::to_string(other) + ".");
        }
        const Ask unbuilt = without(pair.effects, built_effects());
        for_each_bit(unbuilt, [&](Ask one) { add(place + unbuilt_effect(one)); });
        check_together(place, pair);
        // The options may be those of the effect that is not built.
        if (unbuilt == Ask::nothing) check_options(place, pair);
    }

    void check_options(const std::string& place, const LayerPair& pair) {
        check_number(place, "tolerance", pair.tolerance, has(pair.effects, Ask::within), "within");
        check_number(place, "max_distance", pair.max_distance,
                     has_any(pair.effects, kReadsMaxDistance), "distance or haptic");
        check_number(place, "max_error", pair.max_error, has(pair.effects, Ask::distance),
                     "distance");
        if (pair.body != Body::surface && !has_any(pair.effects, kReadsBody)) {
            add(place + "body has no meaning without collide, distance, contacts or continuous.");
        }
        if (pair.overlap != Overlap::closed && !has_any(pair.effects, kReadsOverlap)) {
            add(place + "overlap has no meaning without collide or overlap.");
        }
        check_contacts(place, pair);
        check_impact(place, pair);
        check_work(place, pair);
    }

    /// Refuses effects that are not built together.
    void check_together(const std::string& place, const LayerPair& pair) {
        if (has_any(pair.effects, kSceneChanges)) {
            if (has(pair.effects, Ask::contacts)) {
                add(place +
                    "contacts is not supported for models that deform or tear: pieces do not "
                    "follow the surface. Use overlap, within or distance.");
            }
            if (has(pair.effects, Ask::continuous)) {
                add(place +
                    "continuous is not supported for models that deform or tear. Use within or a "
                    "Sweep.");
            }
        }
        if (has(pair.effects, Ask::self) && pair.a != pair.b) {
            add(place +
                "self tests single objects. Request it for a pair of one layer with itself.");
        }
        if (!has(pair.effects, Ask::haptic)) return;
        if (!are_built_together(effects_between(pair))) {
            add(place +
                "haptic is a distance within a limit of work. Request haptic or distance, not "
                "both.");
        }
        if (pair.body == Body::solid) {
            add(place + "haptic supports surfaces only. Use distance for solids.");
        }
    }

    void check_impact(const std::string& place, const LayerPair& pair) {
        const bool is_read = has(pair.effects, Ask::continuous);
        check_number(place, "impact.tolerance", pair.impact.tolerance, is_read, "continuous");
        if (is_read && pair.impact.most_steps == 0) {
            add(place + "impact.most_steps is 0; it must be at least 1.");
        }
        if (!is_read && pair.impact.most_steps != ImpactOptions().most_steps) {
            add(place + "impact.most_steps has no meaning without continuous.");
        }
    }

    void check_work(const std::string& place, const LayerPair& pair) {
        const bool is_read = has(pair.effects, Ask::haptic);
        if (is_read && pair.work == 0) add(place + "work is 0; haptic needs at least 1.");
        if (!is_read && pair.work != 0) add(place + "work has no meaning without haptic.");
    }

    void check_contacts(const std::string& place, const LayerPair& pair) {
        const ContactOptions& options = pair.contacts;
        const ContactOptions unused = LayerPair().contacts;
        const bool is_read = has(pair.effects, Ask::contacts);
        check_number(place, "contacts.tolerance", options.tolerance, is_read, "contacts");
        check_number(place, "contacts.cluster_angle", options.cluster_angle, is_read, "contacts");
        if (is_read && (options.most == 0 || options.most > kMostListedContacts)) {
            add(place + "contacts.most is " + std::to_string(options.most) + "; it must be 1 to " +
                std::to_string(kMostListedContacts) + ".");
        }
        const bool is_default = options.most == unused.most && options.work == unused.work &&
                                options.manifold == unused.manifold;
        if (!is_read && !is_default)
            add(place + "contacts has no meaning without the effect contacts.");
    }

    void check_number(const std::string& place, const char* name, double value, bool is_read,
                      const char* effect) {
        if (!std::isfinite(value) || value < 0) {
            add(place + name + " is " + number_text(value) + "; it must be finite and at least 0.");
        } else if (value != 0 && !is_read) {
            add(place + name + " has no meaning without " + effect + ".");
        }
    }

    void check_model(const ModelUse& model) {
        Ask lacking = Ask::nothing;
        for (const LayerPair& pair : options_.pairs) {
            if (std::max(pair.a, pair.b) >= kLayers) continue;
            const std::uint32_t layers = 1U << pair.a | 1U << pair.b;
            if ((model.layers & layers) == 0) continue;
            lacking = lacking | without(asks_of_models(pair), model.serves);
        }
        // Effects that are not built are refused above.
        lacking = lacking & (built_effects() | Ask::solid);
        if (lacking == Ask::nothing) return;
        add(std::string(model.name) + ": " + layers_that_ask(model, lacking) + " " +
            asks_text(lacking) + ", which the model does not serve. Bake it with " +
            bake_option(lacking) + ".");
    }

    /// "its layers request", or by name: "its layer 'crates' requests".
    [[nodiscard]] std::string layers_that_ask(const ModelUse& model, Ask some) const {
        if (options_.layer_names.empty()) return "its layers request";
        std::uint32_t asking = 0;
        for (const LayerPair& pair : options_.pairs) {
            if (std::max(pair.a, pair.b) >= kLayers) continue;
            if (!has_any(asks_of_models(pair), some)) continue;
            asking |= (1U << pair.a | 1U << pair.b) & model.layers;
        }
        const std::vector<std::string> names = names_in(options_.layer_names, asking);
        return (names.size() == 1 ? "its layer " : "its layers ") + list_of(names) +
               (names.size() == 1 ? " requests" : " request");
    }

    const PlanOptions& options_;
    std::vector<std::string> sentences_;
};

/// What the parts of all models of a layer certify.
struct LayerParts {
    std::uint32_t count = 0;  ///< the most parts of a model; 0: some model has none
    double error = 0;         ///< the largest
};

LayerParts parts_of_layer(std::span<const ModelUse> models, std::uint32_t layer) noexcept {
    LayerParts all;
    for (const ModelUse& model : models) {
        if ((model.layers >> layer & 1) == 0) continue;
        const bool has_parts = model.parts.count > 0 && has(model.serves, Ask::hulls);
        if (!has_parts || !(model.parts.error >= 0)) return {};
        all.count = std::max(all.count, model.parts.count);
        all.error = std::max(all.error, model.parts.error);
    }
    return all;
}

/// Chooses the rung of a pair. Parts do not follow models that change.
PairRung rung_for(const LayerPair& pair, const PlanOptions& options,
                  std::uint32_t changing_layers) noexcept {
    PairRung walk;
    if (has(pair.effects, Ask::distance)) walk.error = pair.max_error;
    const bool changes = ((changing_layers >> pair.a | changing_layers >> pair.b) & 1) != 0;
    if (walk.error == 0 || pair.body != Body::solid || changes) return walk;
    const LayerParts a = parts_of_layer(options.models, pair.a);
    const LayerParts b = parts_of_layer(options.models, pair.b);
    const std::uint64_t pairs = std::uint64_t{a.count} * b.count;
    const double error = a.error + b.error;
    if (pairs == 0 || pairs > kMostPartPairs || !(error <= pair.max_error)) return walk;
    return {Rung::parts, error, a.count, b.count};
}

std::string rung_text(const LayerPair& pair, const PairRung& rung) {
    if (pair.max_error == 0) return {};
    std::string text = "; max_error " + number_text(pair.max_error) + ": by ";
    if (rung.rung == Rung::parts) {
        text += "enclosing parts, at most " + std::to_string(rung.parts_a) + " and " +
                std::to_string(rung.parts_b);
    } else {
        text += "BVH traversal";
    }
    return text + ", error at most " + number_text(rung.error);
}

/// The query from which the answer of collide() follows: see PairQueries.
const char* source_of(const LayerPair& pair, const PairRung& rung) {
    const bool is_solid = pair.body == Body::solid;
    const bool is_by_parts = rung.rung == Rung::parts;
    if (has(pair.effects, Ask::overlap)) {
        if (is_by_parts) return " (from overlap, otherwise from distance)";
        return is_solid ? " (from overlap if any triangles overlap)" : " (from overlap)";
    }
    if (is_by_parts && pair.overlap == Overlap::closed) return " (from distance)";
    if (is_by_parts) return " (mostly from distance)";
    const bool is_told =
        has(pair.effects, Ask::distance) && !is_solid && pair.overlap == Overlap::closed;
    return is_told ? " (mostly from distance)" : "";
}

/// What a pair of layers computes: "collide, distance up to 2".
std::string effects_text(const LayerPair& pair, const PairRung& rung) {
    std::string effects;
    const auto add = [&](const std::string& text) {
        effects += (effects.empty() ? "" : ", ") + text;
    };
    const std::string solid = pair.body == Body::solid ? " of solids" : "";
    const std::string proper = pair.overlap == Overlap::proper ? ", proper" : "";
    const bool has_overlap = has(pair.effects, Ask::overlap);
    const bool has_distance = has(pair.effects, Ask::distance);
    if (has(pair.effects, Ask::tear)) {
        add("models may tear" +
            std::string(solid.empty() ? "" : ", and whether solids touch may then be unknown"));
    } else if (has(pair.effects, Ask::deform)) {
        add("models may deform");
    }
    if (has(pair.effects, Ask::self)) add("self (each object)");
    if (has(pair.effects, Ask::collide)) {
        add("collide" + solid + proper + source_of(pair, rung));
    }
    if (has_overlap) add("overlap" + proper);
    if (has(pair.effects, Ask::within)) {
        add("within " + number_text(pair.tolerance) +
            (has_distance ? " (mostly from distance)" : ""));
    }
    if (has_distance) add("distance" + solid + " up to " + number_text(pair.max_distance));
    if (has(pair.effects, Ask::contacts)) {
        add("contacts" + solid + " within " + number_text(pair.contacts.tolerance) + ", at most " +
            std::to_string(pair.contacts.most) +
            (pair.contacts.work == 0 ? "" : ", work " + std::to_string(pair.contacts.work)) +
            (pair.contacts.manifold == Manifold::four ? ", with manifolds" : "") +
            (pair.contacts.cluster_angle == 0
                 ? ""
                 : ", clusters of " + number_text(pair.contacts.cluster_angle) + " radians"));
    }
    if (has(pair.effects, Ask::continuous)) {
        add("continuous" + solid + " with tolerance " + number_text(pair.impact.tolerance));
    }
    if (has(pair.effects, Ask::haptic)) {
        add("haptic up to " + number_text(pair.max_distance) + ", work " +
            std::to_string(pair.work));
    }
    if (pair.lists_stays) add("an event in each step while an effect goes on");
    return effects + rung_text(pair, rung);
}

std::string sections_text(format::SectionSet sections) {
    std::vector<std::string> names;
    for (const format::SectionKind& kind : format::section_kinds()) {
        if (sections.contains(kind.id)) names.emplace_back(kind.name);
    }
    return list_of(names);
}

std::string counted(std::uint64_t count, const char* noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// The bytes of a scene, and what they have room for.
std::string size_text(const Plan& plan) {
    const SceneLimits& limits = plan.limits();
    std::string text = "the state of a scene: " + counted(Scene::size(plan), "byte") + " for " +
                       counted(limits.objects, "object") + ", " + counted(limits.pairs, "pair") +
                       " of boxes and " + counted(limits.threads, "thread");
    if (has_any(plan.effects(), Ask::overlap | Ask::self)) {
        text += ", " + counted(limits.triangle_pairs, "listed triangle pair");
    }
    if (has(plan.effects(), Ask::contacts)) {
        text += ", " + counted(limits.contacts, "listed contact");
    }
    return text + "\n";
}

}  // namespace

Plan::Plan(const PlanOptions& options)
    : limits_(options.limits),
      origin_(options.origin),
      layer_names_(options.layer_names.begin(), options.layer_names.end()) {
    for (std::uint32_t i = 0; i < std::min<std::size_t>(layer_names_.size(), kLayers); ++i) {
        layers_ |= 1U << i;
    }
    for (const ModelUse& model : options.models) layers_ |= model.layers;
    for (const LayerPair& pair : options.pairs) {
        layers_ |= 1U << pair.a | 1U << pair.b;
        if (pair.effects == Ask::nothing) continue;
        pairs_.push_back(pair);
        const auto number = static_cast<std::uint16_t>(pairs_.size());
        number_[pair.a * kLayers + pair.b] = number_[pair.b * kLayers + pair.a] = number;
    }
    const std::uint32_t changing = layers_of(kSceneChanges);
    for (const LayerPair& pair : pairs_) rungs_.push_back(rung_for(pair, options, changing));
}

Plan::Compiled Plan::compile(const PlanOptions& options) {
    const format::FloatEnvironment environment;
    Compiled compiled;
    compiled.refusals = Refusals(options).take();
    if (compiled.refusals.empty()) compiled.plan = Plan(options);
    return compiled;
}

std::optional<std::uint32_t> Plan::find_pair(std::uint32_t a, std::uint32_t b) const noexcept {
    if (a >= kLayers || b >= kLayers) return std::nullopt;
    const std::uint32_t number = number_[a * kLayers + b];
    return number == 0 ? std::nullopt : std::optional(number - 1);
}

Ask Plan::asks_of(std::uint32_t layer) const noexcept {
    Ask asks = Ask::nothing;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        const LayerPair& pair = pairs_[i];
        if (pair.a != layer && pair.b != layer) continue;
        asks = asks | asks_of_models(pair);
        if (rungs_[i].rung == Rung::parts) asks = asks | Ask::hulls;
    }
    return asks;
}

BoxFilter Plan::filter_of(std::uint32_t layer) const noexcept {
    BoxFilter filter = {.layers = layer < kLayers ? 1U << layer : 0, .accepts = 0};
    for (std::uint32_t other = 0; other < kLayers; ++other) {
        const auto pair = find_pair(layer, other);
        if (pair && effects_between(pairs_[*pair]) != Ask::nothing) filter.accepts |= 1U << other;
    }
    return filter;
}

std::uint32_t Plan::layers_of(Ask effects) const noexcept {
    std::uint32_t layers = 0;
    for (const LayerPair& pair : pairs_) {
        if (has_any(pair.effects, effects)) layers |= 1U << pair.a | 1U << pair.b;
    }
    return layers;
}

// Two boxes that each reach half the distance beyond their objects meet if the objects are near. No
// two points of moved models are farther apart than the bound.
double Plan::reach_of(std::uint32_t layer) const noexcept {
    const format::FloatEnvironment environment;
    double most = 0;
    for (const LayerPair& pair : pairs_) {
        if (pair.a == layer || pair.b == layer) {
            most = std::max({most, pair.tolerance, pair.max_distance, pair.contacts.tolerance,
                             pair.impact.tolerance});
        }
    }
    return std::min(most / 2, 16 * format::kMaxCoordinate);
}

Ask Plan::effects() const noexcept {
    Ask all = Ask::nothing;
    for (const LayerPair& pair : pairs_) all = all | pair.effects;
    return all;
}

std::string Plan::describe() const {
    const format::FloatEnvironment environment;
    std::string text;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        text += "layers " + layers_text(layer_names_, pairs_[i].a, pairs_[i].b) + ": " +
                effects_text(pairs_[i], rungs_[i]) + "\n";
    }
    std::string rest;
    for (const Ask one : kSceneEffects) {
        if (!has(effects(), one)) rest += (rest.empty() ? "" : ", ") + name_of(one);
    }
    if (!rest.empty()) text += "not requested by any pair of layers: " + rest + "\n";
    return text + unpaired_text() + models_text() + size_text(*this);
}

/// The layers that are not tested against each other, and those that are not tested at all.
std::string Plan::unpaired_text() const {
    const std::uint32_t paired = layers_of(static_cast<Ask>(~0U));
    std::string apart;
    for (std::uint32_t a = 0; a < kLayers; ++a) {
        for (std::uint32_t b = a; b < kLayers; ++b) {
            if ((paired >> a & paired >> b & 1) == 0) continue;
            if ((filter_of(a).accepts >> b & 1) != 0) continue;
            apart += (apart.empty() ? "" : ", ") + layers_text(layer_names_, a, b);
        }
    }
    std::string text;
    if (!apart.empty()) text = "layers never tested against each other: " + apart + "\n";
    const std::vector<std::string> alone = names_in(layer_names_, layers_ & ~paired);
    if (alone.empty()) return text;
    return text + "layers in no pair, whose objects are never tested: " + list_of(alone) + "\n";
}

/// What the models of each layer must serve, and what is read of them. Layers with equal needs
/// share a line.
std::string Plan::models_text() const {
    std::string text;
    std::uint32_t told = 0;
    for (std::uint32_t layer = 0; layer < kLayers; ++layer) {
        const Ask asks = asks_of(layer);
        if (asks == Ask::nothing || (told >> layer & 1) != 0) continue;
        std::uint32_t alike = 0;
        for (std::uint32_t other = layer; other < kLayers; ++other) {
            if (asks_of(other) == asks) alike |= 1U << other;
        }
        told |= alike;
        const std::vector<std::string> names = names_in(layer_names_, alike);
        text += (names.size() == 1 ? "models of layer " : "models of layers ") + list_of(names) +
                " must serve " + asks_text(asks) +
                "; only these sections are read: " + sections_text(sections_for(asks)) +
                ((layers_of(kSceneChanges) & alike) == 0
                     ? "\n"
                     : "; models that deform or tear must also serve deform or tear\n");
    }
    return text;
}

}  // namespace cdprep
