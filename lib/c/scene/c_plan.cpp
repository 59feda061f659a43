// SPDX-License-Identifier: MIT
#include "c/scene/c_plan.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "c/c_contacts.h"
#include "c/c_model.h"
#include "c/c_workspace.h"
#include "cdprep/format/float_environment.h"
#include "core/layer_names.h"

namespace cdprep::c {

template <>
struct Input<cdprep_layer_pair> {
    static const InputType type;
    static cdprep_layer_pair defaults() noexcept {
        cdprep_layer_pair pair{};
        pair.impact_steps = ImpactOptions{}.most_steps;
        return pair;
    }
};

template <>
struct Input<cdprep_model_use> {
    static const InputType type;
    static cdprep_model_use defaults() noexcept {
        return {};
    }
};

template <>
struct Input<cdprep_plan_options> {
    static const InputType type;
    static cdprep_plan_options defaults() noexcept {
        cdprep_plan_options options{};
        options.lanes = 1;
        return options;
    }
};

namespace {

constexpr std::array kPairFields = {
    Field{"a", offsetof(cdprep_layer_pair, a), Holds::choice, kLayers - 1},
    Field{"b", offsetof(cdprep_layer_pair, b), Holds::choice, kLayers - 1},
    Field{"body", offsetof(cdprep_layer_pair, body), Holds::choice, CDPREP_SOLID},
    Field{"overlap", offsetof(cdprep_layer_pair, overlap), Holds::choice, CDPREP_PROPER},
    Field{"lists_stays", offsetof(cdprep_layer_pair, lists_stays), Holds::choice, CDPREP_YES},
    Field{"tolerance", offsetof(cdprep_layer_pair, tolerance), Holds::length},
    Field{"max_distance", offsetof(cdprep_layer_pair, max_distance), Holds::length},
    Field{"max_error", offsetof(cdprep_layer_pair, max_error), Holds::length},
    Field{"impact_tolerance", offsetof(cdprep_layer_pair, impact_tolerance), Holds::length},
    Field{"reserved", offsetof(cdprep_layer_pair, reserved), Holds::reserved},
};

constexpr std::array kUseFields = {
    Field{"reserved", offsetof(cdprep_model_use, reserved), Holds::reserved},
    Field{"part_error", offsetof(cdprep_model_use, part_error), Holds::length},
};

constexpr std::array kOptionsFields = {
    Field{"layer_pair_count", offsetof(cdprep_plan_options, layer_pair_count), Holds::choice,
          kMostLayerPairs},
    Field{"layer_name_count", offsetof(cdprep_plan_options, layer_name_count), Holds::choice,
          kLayers},
    Field{"max_objects", offsetof(cdprep_plan_options, max_objects), Holds::choice,
          kMostWorldBoxes},
    Field{"lanes", offsetof(cdprep_plan_options, lanes), Holds::choice, kMostLanes},
    Field{"origin", offsetof(cdprep_plan_options, origin), Holds::number, 0, 3},
};

constexpr Name kOptions = {"options"};

static_assert(CDPREP_LAYERS == kLayers && kMostLayerPairs <= UINT16_MAX);
static_assert(alignof(cdprep_plan) <= CDPREP_ALIGNMENT);

/// Tells the caller every reason why there is no plan. The error of the call states the first.
class Refusals {
public:
    Refusals(Call& call, cdprep_text_visitor visit, void* context) noexcept
        : call_(call), visit_(visit), context_(context) {}

    /// Runs `check(call)` with a call of its own. Returns whether it accepts.
    template <class Check>
    bool accept(Check&& check) {
        cdprep_error error;
        Call one(&error);
        if (check(one) == CDPREP_OK) return true;
        if (code_ == CDPREP_OK) {
            code_ = call_.refuse_with(error.why, {error.argument}, error.message);
        }
        if (visit_ != nullptr && visit_(context_, error.message) == 0) visit_ = nullptr;
        return false;
    }
    [[nodiscard]] int code() const noexcept {
        return code_;
    }

private:
    Call& call_;
    cdprep_text_visitor visit_;
    void* context_;
    int code_ = CDPREP_OK;
};

/// Checks an array of input structs: calls `check(call, name, element)` for each. An invalid first
/// element ends the checks, because the size in its head is the stride.
template <class T, class Check>
void check_array(Refusals& refusals, const char* argument, const T* first, std::size_t count,
                 Check&& check) {
    for (std::size_t i = 0; i < count; ++i) {
        const T* const given = element(first, i);
        const bool has_head = refusals.accept([&](Call& call) -> int {
            const Name name = {argument, i};
            if (const int code = check_head(call, name, Input<T>::type, given)) return code;
            return check_stride(call, name, first, given);
        });
        if (!has_head && i == 0) return;
        if (!has_head) continue;
        refusals.accept([&](Call& call) { return check(call, {argument, i}, given); });
    }
}

/// The options of a plan, as C++ types.
struct Asked {
    cdprep_plan_options options{};
    cdprep_allocator allocator{};
    std::vector<LayerPair> pairs;
    std::vector<std::string_view> layer_names;
    std::vector<std::uint16_t> given_as;  ///< of each pair
    /// [a][b]: 1 more than the index of the pair that was given for two layers.
    std::array<std::uint16_t, std::size_t{kLayers} * kLayers> given{};

    [[nodiscard]] std::uint16_t& given_for(std::uint32_t a, std::uint32_t b) noexcept {
        return given[std::size_t{std::min(a, b)} * kLayers + std::max(a, b)];
    }
};

constexpr std::uint32_t kEffects = [] {
    auto all = static_cast<std::uint32_t>(kSceneChanges);
    for (const Ask one : kSceneEffects) all |= static_cast<std::uint32_t>(one);
    return all;
}();
constexpr std::uint32_t kReadBody =
    CDPREP_ASK_COLLIDE | CDPREP_ASK_DISTANCE | CDPREP_ASK_CONTACTS | CDPREP_ASK_CONTINUOUS;

int refuse_unused(Call& call, const Name& name, const char* effects) noexcept {
    return call.refuse(CDPREP_WHY_NO_MEANING, name,
                       "is set, but only %s uses it; leave it at its default.", effects);
}

int refuse_together(Call& call, const Name& name, const char* why) noexcept {
    return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name, "%s", why);
}

/// Refuses effects that are not built together, and options without which an effect does nothing.
int check_together(Call& call, const Name& name, const cdprep_layer_pair& pair) noexcept {
    const auto has = [&](std::uint32_t asks) { return (pair.effects & asks) != 0; };
    const Name effects = name.of("effects");
    if (has(CDPREP_ASK_DEFORM | CDPREP_ASK_TEAR) &&
        has(CDPREP_ASK_CONTACTS | CDPREP_ASK_CONTINUOUS)) {
        return refuse_together(call, effects,
                               "has CDPREP_ASK_CONTACTS or _CONTINUOUS with _DEFORM or _TEAR, "
                               "which is not supported. Use _OVERLAP, _WITHIN or _DISTANCE.");
    }
    if (has(CDPREP_ASK_SELF) && pair.a != pair.b) {
        return refuse_together(
            call, effects,
            "has CDPREP_ASK_SELF, which tests single objects: a and b must be the same layer.");
    }
    if (has(CDPREP_ASK_CONTINUOUS) && pair.impact_steps == 0) {
        return refuse_together(call, name.of("impact_steps"), "is 0; it must be at least 1.");
    }
    if (!has(CDPREP_ASK_HAPTIC)) return CDPREP_OK;
    if (has(CDPREP_ASK_DISTANCE) || pair.body == CDPREP_SOLID) {
        return refuse_together(call, effects,
                               "has CDPREP_ASK_HAPTIC, which supports surfaces only, and not "
                               "together with _DISTANCE.");
    }
    if (pair.work == 0) {
        return refuse_together(call, name.of("work"), "is 0; CDPREP_ASK_HAPTIC needs at least 1.");
    }
    return CDPREP_OK;
}

/// Refuses fields that no effect of the pair uses.
int check_meaning(Call& call, const Name& name, const cdprep_layer_pair& pair) noexcept {
    const auto has = [&](std::uint32_t asks) { return (pair.effects & asks) != 0; };
    if (pair.body != CDPREP_SURFACE && !has(kReadBody)) {
        return refuse_unused(call, name.of("body"),
                             "CDPREP_ASK_COLLIDE, _DISTANCE, _CONTACTS or _CONTINUOUS");
    }
    if (pair.overlap != CDPREP_CLOSED && !has(CDPREP_ASK_COLLIDE | CDPREP_ASK_OVERLAP)) {
        return refuse_unused(call, name.of("overlap"), "CDPREP_ASK_COLLIDE or _OVERLAP");
    }
    if (pair.tolerance > 0 && !has(CDPREP_ASK_WITHIN)) {
        return refuse_unused(call, name.of("tolerance"), "CDPREP_ASK_WITHIN");
    }
    if (pair.max_distance > 0 && !has(CDPREP_ASK_DISTANCE | CDPREP_ASK_HAPTIC)) {
        return refuse_unused(call, name.of("max_distance"), "CDPREP_ASK_DISTANCE or _HAPTIC");
    }
    if (pair.max_error > 0 && !has(CDPREP_ASK_DISTANCE)) {
        return refuse_unused(call, name.of("max_error"), "CDPREP_ASK_DISTANCE");
    }
    if (pair.impact_tolerance > 0 && !has(CDPREP_ASK_CONTINUOUS)) {
        return refuse_unused(call, name.of("impact_tolerance"), "CDPREP_ASK_CONTINUOUS");
    }
    if (pair.impact_steps != ImpactOptions{}.most_steps && !has(CDPREP_ASK_CONTINUOUS)) {
        return refuse_unused(call, name.of("impact_steps"), "CDPREP_ASK_CONTINUOUS");
    }
    if (pair.work > 0 && !has(CDPREP_ASK_HAPTIC)) {
        return refuse_unused(call, name.of("work"), "CDPREP_ASK_HAPTIC");
    }
    if (pair.contacts != nullptr && !has(CDPREP_ASK_CONTACTS)) {
        return refuse_unused(call, name.of("contacts"), "CDPREP_ASK_CONTACTS");
    }
    return CDPREP_OK;
}

/// Reads the options of contacts of a pair.
int read_contacts(Call& call, const Name& name, const cdprep_layer_pair& pair,
                  ContactOptions& contacts) noexcept {
    contacts = LayerPair().contacts;
    if (pair.contacts == nullptr) return CDPREP_OK;
    cdprep_contact_options given;
    const auto text = spelt(name.of("contacts"));
    if (const int code = read_contact_options(call, {text.data()}, pair.contacts, given)) {
        return code;
    }
    contacts = in_cpp(given);
    return CDPREP_OK;
}

LayerPair in_cpp(const cdprep_layer_pair& pair, const ContactOptions& contacts) noexcept {
    return {.a = pair.a,
            .b = pair.b,
            .effects = static_cast<Ask>(pair.effects),
            .tolerance = pair.tolerance,
            .max_distance = pair.max_distance,
            .max_error = pair.max_error,
            .body = pair.body == CDPREP_SOLID ? Body::solid : Body::surface,
            .overlap = pair.overlap == CDPREP_PROPER ? Overlap::proper : Overlap::closed,
            .contacts = contacts,
            .impact = {.tolerance = pair.impact_tolerance, .most_steps = pair.impact_steps},
            .work = pair.work,
            .lists_stays = pair.lists_stays == CDPREP_YES};
}

int read_layer_pair(Call& call, const Name& name, const cdprep_layer_pair* from, Asked& asked) {
    const format::FloatEnvironment environment;
    cdprep_layer_pair pair;
    if (const int code = read_input(call, name, from, pair)) return code;
    if ((pair.effects & ~kEffects) != 0) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name.of("effects"),
                           "is 0x%x; a scene computes only the bits 0x%x.", pair.effects, kEffects);
    }
    if (const int code = check_meaning(call, name, pair)) return code;
    if (const int code = check_together(call, name, pair)) return code;
    ContactOptions contacts;
    if (const int code = read_contacts(call, name, pair, contacts)) return code;
    std::uint16_t& given = asked.given_for(pair.a, pair.b);
    if (given != 0) {
        return call.refuse(CDPREP_WHY_NO_MEANING, name,
                           "has the layers %s, like options.layer_pairs[%u].",
                           layers_text(asked.layer_names, pair.a, pair.b).c_str(), given - 1U);
    }
    given = static_cast<std::uint16_t>(name.index + 1);
    if (pair.effects == 0) return CDPREP_OK;
    asked.pairs.push_back(in_cpp(pair, contacts));
    asked.given_as.push_back(static_cast<std::uint16_t>(name.index));
    return CDPREP_OK;
}

int read_model_use(Call& call, const Name& name, const cdprep_model_use* from,
                   cdprep_model_use& use) noexcept {
    const format::FloatEnvironment environment;
    if (const int code = read_input(call, name, from, use)) return code;
    if (const int code = check_asks(call, name.of("serves"), use.serves)) return code;
    if (use.part_count == 0 && use.part_error > 0) {
        return call.refuse(CDPREP_WHY_NO_MEANING, name.of("part_error"),
                           "is set, but part_count is 0.");
    }
    if (use.model == nullptr) return CDPREP_OK;
    if (use.part_count != 0 || use.part_error > 0) {
        return call.refuse(CDPREP_WHY_NO_MEANING,
                           name.of(use.part_count != 0 ? "part_count" : "part_error"),
                           "is set, but the model is given; leave it at 0.");
    }
    if (use.serves != 0) {
        return call.refuse(CDPREP_WHY_NO_MEANING, name.of("serves"),
                           "is 0x%x, but the model is given; leave it at 0.", use.serves);
    }
    if (use.name == nullptr) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_NO_MEANING, name.of("name"),
                       "is set, but the model has a name; leave it at null.");
}

/// Refuses a model that does not serve what its layers ask for.
int check_model_use(Call& call, const Name& name, const cdprep_model_use* from, const Plan& plan) {
    cdprep_model_use use;
    if (const int code = read_model_use(call, name, from, use)) return code;
    Ask asks = Ask::nothing;
    for (std::uint32_t layers = use.layers; layers != 0; layers &= layers - 1) {
        asks = asks | plan.asks_of(static_cast<std::uint32_t>(std::countr_zero(layers)));
    }
    if (use.model != nullptr) return check_serves(call, name.of("model"), *use.model, asks);
    const Ask lacking = without(asks, static_cast<Ask>(use.serves));
    for (const Needs& row : needs()) {
        if (!contains(lacking, row.ask)) continue;
        return call.refuse(CDPREP_WHY_NOT_BAKED, name.of("serves"),
                           "is 0x%x, but its layers request %s. Bake %s with %s.", use.serves,
                           row.name, use.name != nullptr ? use.name : "the model", row.bake_option);
    }
    return CDPREP_OK;
}

int read_layer_names(Call& call, Asked& asked) {
    const cdprep_plan_options& options = asked.options;
    if (options.layer_name_count == 0) return CDPREP_OK;
    if (const int code = call.need(options.layer_names, kOptions.of("layer_names"))) return code;
    for (std::uint32_t i = 0; i < options.layer_name_count; ++i) {
        const char* const name = options.layer_names[i];
        if (const int code = call.need(name, kOptions.of("layer_names", i))) return code;
        asked.layer_names.emplace_back(name);
    }
    return CDPREP_OK;
}

int read(Call& call, const cdprep_plan_options* given, Asked& asked) {
    if (const int code = read_input(call, kOptions, given, asked.options)) return code;
    const cdprep_plan_options& options = asked.options;
    if (options.lanes == 0) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, kOptions.of("lanes"),
                           "is 0; it must be 1 to %u.", kMostLanes);
    }
    if (options.layer_pair_count > 0) {
        if (const int code = call.need(options.layer_pairs, kOptions.of("layer_pairs")))
            return code;
    }
    if (options.model_count > 0) {
        if (const int code = call.need(options.models, kOptions.of("models"))) return code;
    }
    if (const int code = read_layer_names(call, asked)) return code;
    return read_allocator(call, kOptions.of("allocator"), options.allocator, asked.allocator);
}

/// Returns what the plan learns of the models: their layers and parts. Whether they serve their
/// layers is checked afterwards, and invalid elements are refused then.
std::vector<ModelUse> model_uses(const cdprep_plan_options& options) {
    std::vector<ModelUse> uses;
    for (std::size_t i = 0; i < options.model_count; ++i) {
        cdprep_error error;
        Call call(&error);
        const Name name = {"options.models", i};
        if (i == 0 && check_head(call, name, Input<cdprep_model_use>::type, options.models)) break;
        const cdprep_model_use* const given = element(options.models, i);
        cdprep_model_use use;
        if (check_head(call, name, Input<cdprep_model_use>::type, given) ||
            check_stride(call, name, options.models, given) ||
            read_model_use(call, name, given, use)) {
            continue;
        }
        Ask serves = static_cast<Ask>(use.serves);
        EnclosingParts parts{.count = use.part_count, .error = use.part_error};
        if (use.model != nullptr) {
            serves = use.model->model.asks();
            parts = enclosing_parts(use.model->model);
        }
        const Ask checked_later = without(known_asks(), Ask::hulls);
        uses.push_back({"", serves | checked_later, use.layers, parts});
    }
    return uses;
}

/// Compiles the pairs of layers. What the checks above do not know is refused with the sentence of
/// the plan.
std::optional<Plan> compiled(Refusals& refusals, const Asked& asked) {
    const cdprep_plan_options& options = asked.options;
    const std::vector<ModelUse> uses = model_uses(options);
    Plan::Compiled compiled =
        Plan::compile({.pairs = asked.pairs,
                       .models = uses,
                       .limits = {.objects = options.max_objects,
                                  .pairs = options.max_pairs,
                                  .threads = options.lanes,
                                  .triangle_pairs = options.max_triangle_pairs,
                                  .contacts = options.max_contacts},
                       .origin = {options.origin[0], options.origin[1], options.origin[2]},
                       .layer_names = asked.layer_names});
    for (const std::string& refusal : compiled.refusals) {
        refusals.accept([&](Call& call) {
            return call.refuse_with(CDPREP_WHY_OUT_OF_RANGE, kOptions, refusal);
        });
    }
    return std::move(compiled.plan);
}

int make_plan(Call& call, const Asked& asked, Plan&& plan, cdprep_plan** to) {
    OwnedMemory own;
    if (const int code = own.allocate(call, asked.allocator, sizeof(cdprep_plan))) return code;
    void* const start = own.get().start;
    *to = new (start) cdprep_plan{std::move(plan), {}, asked.allocator, own.take()};
    std::copy(asked.given_as.begin(), asked.given_as.end(), (*to)->given_as.begin());
    return CDPREP_OK;
}

int compile(Call& call, Refusals& refusals, const cdprep_plan_options* options, cdprep_plan** to) {
    Asked asked;
    if (const int code = read(call, options, asked)) return code;
    check_array(refusals, "options.layer_pairs", asked.options.layer_pairs,
                asked.options.layer_pair_count,
                [&](Call& one, const Name& name, const cdprep_layer_pair* given) {
                    return read_layer_pair(one, name, given, asked);
                });
    std::optional<Plan> plan = compiled(refusals, asked);
    if (!plan) return refusals.code();
    check_array(refusals, "options.models", asked.options.models, asked.options.model_count,
                [&](Call& one, const Name& name, const cdprep_model_use* given) {
                    return check_model_use(one, name, given, *plan);
                });
    if (refusals.code() != CDPREP_OK) return refusals.code();
    return make_plan(call, asked, std::move(*plan), to);
}

}  // namespace

const InputType Input<cdprep_layer_pair>::type = {"cdprep_layer_pair", 0xcd50000bU,
                                                  sizeof(cdprep_layer_pair),
                                                  sizeof(cdprep_layer_pair), kPairFields};

const InputType Input<cdprep_model_use>::type = {"cdprep_model_use", 0xcd50000cU,
                                                 sizeof(cdprep_model_use), sizeof(cdprep_model_use),
                                                 kUseFields};

const InputType Input<cdprep_plan_options>::type = {"cdprep_plan_options", 0xcd50000dU,
                                                    sizeof(cdprep_plan_options),
                                                    sizeof(cdprep_plan_options), kOptionsFields};

}  // namespace cdprep::c

using cdprep::c::Call;
using cdprep::c::guarded;

void cdprep_layer_pair_init(cdprep_layer_pair* pair, size_t size) {
    cdprep::c::initialise(pair, size);
}

void cdprep_model_use_init(cdprep_model_use* use, size_t size) {
    cdprep::c::initialise(use, size);
}

void cdprep_plan_options_init(cdprep_plan_options* options, size_t size) {
    cdprep::c::initialise(options, size);
}

int cdprep_plan_compile(const cdprep_plan_options* options, cdprep_text_visitor refusals,
                        void* context, cdprep_plan** plan, cdprep_error* error) {
    if (plan != nullptr) *plan = nullptr;
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(options, {"options"})) return code;
        if (const int code = call.need(plan, {"plan"})) return code;
        cdprep::c::Refusals all(call, refusals, context);
        return cdprep::c::compile(call, all, options, plan);
    });
}

int cdprep_plan_ask(const cdprep_plan* plan, uint32_t layer, uint32_t* ask, cdprep_error* error) {
    Call call(error);
    if (ask != nullptr) *ask = 0;
    if (const int code = call.need(plan, {"plan"})) return code;
    if (const int code = call.need(ask, {"ask"})) return code;
    if (const int code = cdprep::c::check_layer(call, layer)) return code;
    *ask = static_cast<std::uint32_t>(plan->plan.asks_of(layer));
    return CDPREP_OK;
}

int cdprep_plan_layer(const cdprep_plan* plan, uint32_t layer, cdprep_layer_info* info,
                      cdprep_error* error) {
    Call call(error);
    if (info != nullptr) *info = {};
    if (const int code = call.need(plan, {"plan"})) return code;
    if (const int code = call.need(info, {"info"})) return code;
    if (const int code = cdprep::c::check_layer(call, layer)) return code;
    const cdprep::format::FloatEnvironment environment;
    const cdprep::BoxFilter filter = plan->plan.filter_of(layer);
    *info = {static_cast<std::uint32_t>(plan->plan.asks_of(layer)),
             {filter.layers, filter.accepts},
             0,
             plan->plan.reach_of(layer)};
    return CDPREP_OK;
}

void cdprep_plan_end(cdprep_plan* plan) {
    if (plan == nullptr || plan->users.fetch_sub(1, std::memory_order_acq_rel) > 1) return;
    const cdprep::c::Memory memory = plan->memory;
    std::destroy_at(plan);
    release(memory);
}
