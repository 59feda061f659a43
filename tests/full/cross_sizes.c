/* SPDX-License-Identifier: MIT */
/* Asks how much memory objects take at limits up to the largest ones. No sum may wrap, above all
 * with pointers of 32 bits: a size covers all items, or the call fails because no memory can be so
 * large. Prints how many limits were tried. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "cdprep/cdprep.h"

static unsigned tried, refused;

/* An allocator with room for one plan, while `has_room`. */
static size_t asked;
static int has_room;
static void* give(void* context, size_t size, size_t alignment) {
    static _Alignas(CDPREP_ALIGNMENT) char room[1 << 16];
    (void)context;
    asked = size;
    return has_room && size <= sizeof room && alignment <= CDPREP_ALIGNMENT ? room : NULL;
}
static void take(void* context, void* memory, size_t size) {
    (void)context, (void)memory, (void)size;
}
static const cdprep_allocator allocator = {give, take, NULL};

static void must(int holds, const char* what, uint64_t limit, uint64_t found) {
    if (holds) return;
    fprintf(stderr, "cross_sizes: %s: the limit is %llu, but %llu was found.\n", what,
            (unsigned long long)limit, (unsigned long long)found);
    exit(1);
}

/* Checks a size that must be at least `least` and at most 2 * `least` + 32 MiB. */
static void check(const char* what, int code, int refusal, size_t size, uint64_t least) {
    const uint64_t most = 2 * least + ((uint64_t)32 << 20);
    ++tried;
    if (code == CDPREP_OK) {
        must(size >= least, what, least, size);
        must(size <= most, what, most, size);
        must(size <= PTRDIFF_MAX, what, PTRDIFF_MAX, size);
    } else {
        ++refused;
        must(code == refusal, what, (uint64_t)refusal, (uint64_t)code);
        must(size == 0, what, 0, size);
        must(most > PTRDIFF_MAX, what, PTRDIFF_MAX, most);
    }
}

static void try_broad_phase(uint32_t boxes, uint32_t pairs, uint32_t lanes) {
    cdprep_broad_phase_options options;
    cdprep_broad_phase* made = NULL;
    size_t size = 77;
    cdprep_broad_phase_options_init(&options, sizeof options);
    options.max_boxes = boxes;
    options.max_pairs = pairs;
    options.lanes = lanes;
    const int code = cdprep_broad_phase_size(&options, &size, NULL);
    const uint64_t least =
        (uint64_t)160 * boxes + (uint64_t)24 * pairs + ((uint64_t)lanes - 1) * 4 * boxes;
    check("broad phase", code, CDPREP_OVER_BUDGET, size, least);
    options.allocator = &allocator;
    asked = 0;
    must(cdprep_broad_phase_make(&options, NULL, 0, &made, NULL) == CDPREP_OVER_BUDGET && !made,
         "broad phase without memory", least, 0);
    must(asked == size, "memory asked for", size, asked);
}

static void try_scene(uint32_t objects, uint32_t pairs, uint32_t items) {
    cdprep_layer_pair layers;
    cdprep_plan_options options;
    cdprep_plan* plan = NULL;
    cdprep_scene* made = NULL;
    cdprep_error error;
    size_t size = 77;
    cdprep_layer_pair_init(&layers, sizeof layers);
    layers.effects = CDPREP_ASK_COLLIDE | CDPREP_ASK_OVERLAP;
    if (items > 0) layers.effects |= CDPREP_ASK_CONTACTS;
    cdprep_plan_options_init(&options, sizeof options);
    options.layer_pairs = &layers;
    options.layer_pair_count = 1;
    options.max_objects = objects;
    options.max_pairs = pairs;
    options.max_triangle_pairs = items;
    options.max_contacts = items;
    options.allocator = &allocator;
    has_room = 1;
    if (cdprep_plan_compile(&options, NULL, NULL, &plan, &error)) {
        fprintf(stderr, "cross_sizes: %s\n", error.message);
        exit(1);
    }
    has_room = 0;
    const int code = cdprep_scene_size(plan, &size, NULL);
    const uint64_t least = (uint64_t)400 * objects + (uint64_t)480 * pairs + (uint64_t)1400 * items;
    check("scene", code, CDPREP_OVER_BUDGET, size, least);
    asked = 0;
    must(cdprep_scene_make(plan, NULL, 0, &made, NULL) == CDPREP_OVER_BUDGET && !made,
         "scene without memory", least, 0);
    must(asked == size, "memory asked for", size, asked);
    cdprep_plan_end(plan);
}

#if SIZE_MAX == UINT32_MAX
/* These functions take as much memory as they compute, so only sizes that no memory holds are asked
 * for. */
static void try_live(const cdprep_model* triangle, uint32_t triangles) {
    cdprep_live_options options;
    size_t size = 77;
    cdprep_live_options_init(&options, sizeof options);
    options.model = triangle;
    options.max_triangles = triangles;
    const int code = cdprep_live_size(&options, &size, NULL);
    check("live model", code, CDPREP_BAD_ARGUMENT, size, (uint64_t)100 * triangles);
}

static void try_window(uint32_t leaves) {
    cdprep_window_options options;
    size_t size = 77;
    cdprep_window_options_init(&options, sizeof options);
    options.max_leaves = leaves;
    const int code = cdprep_window_size(&options, &size, NULL);
    check("window", code, CDPREP_BAD_ARGUMENT, size, (uint64_t)900 * leaves);
}

static void try_models(void) {
    const double positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t corners[3] = {0, 1, 2};
    cdprep_workspace* workspace = NULL;
    cdprep_model* triangle = NULL;
    cdprep_build_options options;
    cdprep_build_options_init(&options, sizeof options);
    options.positions = positions;
    options.triangles = corners;
    options.vertex_count = 3;
    options.triangle_count = 1;
    must(!cdprep_workspace_make(NULL, NULL, 0, &workspace, NULL) &&
             !cdprep_model_build(&options, NULL, 0, workspace, &triangle, NULL),
         "triangle", 0, 0);
    for (uint32_t bits = 26; bits < 31; ++bits) try_live(triangle, (uint32_t)1 << bits);
    for (uint32_t bits = 22; bits < 27; ++bits) try_window((uint32_t)1 << bits);
    try_live(triangle, 1000);
    try_window(10);
    cdprep_model_close(triangle);
    cdprep_workspace_end(workspace);
}
#endif

int main(void) {
    static const uint32_t kBoxes[] = {0, 1000, 1U << 22, 1U << 24, 1U << 25, 1U << 28, 1U << 29};
    static const uint32_t kItems[] = {0, 1000, 1U << 22, 1U << 27, 1U << 29, 1U << 31, UINT32_MAX};
    for (size_t i = 0; i < sizeof kBoxes / sizeof *kBoxes; ++i) {
        for (size_t k = 0; k < sizeof kItems / sizeof *kItems; ++k) {
            try_broad_phase(kBoxes[i], kItems[k], 1);
            try_broad_phase(kBoxes[i], kItems[k], 256);
            try_scene(kBoxes[i], kItems[k], 0);
            try_scene(kBoxes[i], 1000, kItems[k]);
        }
    }
#if SIZE_MAX == UINT32_MAX
    try_models();
    must(refused > 0, "refused sizes", 1, refused);
#else
    must(refused == 0, "refused sizes", 0, refused);
#endif
    printf("%u limits have sizes that cover them, or none\n", tried);
    return 0;
}
