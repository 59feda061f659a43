/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "c_api.h"
#include "c_asking.h"

enum { JOBS = 150, ROOM = 100, WORDS = 256 };

/* Every job's answers, with room for them. */
typedef struct answers {
    cdprep_collision collisions[JOBS];
    cdprep_nearest distances[JOBS];
    uint32_t within[JOBS];
    cdprep_overlap_list overlaps[JOBS];
    cdprep_marks marked[JOBS];
    cdprep_overlap pairs[JOBS][ROOM];
    uint64_t bits[JOBS][2][WORDS];
} answers;

/* The pairs of every question: each uses other fields. */
typedef struct questions {
    cdprep_pair solid[JOBS];
    cdprep_pair surface[JOBS];
    cdprep_pair proper[JOBS];
    cdprep_distance_options near_by;
} questions;

static void give_room(answers* to) {
    for (int i = 0; i < JOBS; ++i) {
        const cdprep_overlap_list overlap = {to->pairs[i], ROOM, 0};
        const cdprep_marks marked = {to->bits[i][0], to->bits[i][1], WORDS, WORDS, 0};
        to->overlaps[i] = overlap;
        to->marked[i] = marked;
    }
}

/* A about z, B away from it: from deep inside to far. Of every second one both move. */
static cdprep_pair placed(const cdprep_model* a, const cdprep_model* b, int i) {
    cdprep_pair pair = moved_by(a, b, 0.02 * (i - i % 2));
    if (i % 2 == 0) return pair;
    const double angle = 0.1 * i;
    pair.moving = CDPREP_MOVE_BOTH;
    pair.pose_a.rows[0] = pair.pose_a.rows[4] = cos(angle);
    pair.pose_a.rows[3] = sin(angle);
    pair.pose_a.rows[1] = -pair.pose_a.rows[3];
    return pair;
}

/* `caches` may be null; every third pair has one. */
static void make_questions(const cdprep_model* a, const cdprep_model* b, cdprep_cache* caches,
                           questions* to) {
    for (int i = 0; i < JOBS; ++i) {
        to->surface[i] = placed(a, b, i);
        if (caches != NULL && i % 3 == 0) to->surface[i].cache = &caches[i];
        to->solid[i] = to->proper[i] = to->surface[i];
        to->solid[i].body = CDPREP_SOLID;
        to->proper[i].overlap = CDPREP_PROPER;
        to->proper[i].degenerate = CDPREP_SKIP_DEGENERATE;
    }
    cdprep_distance_options_init(&to->near_by, sizeof to->near_by);
    to->near_by.max_distance = 1;
}

/* Asks them one by one. */
static const char* ask_alone(const questions* of, cdprep_workspace* scratch, answers* to) {
    give_room(to);
    for (int i = 0; i < JOBS; ++i) {
        MUST(cdprep_collide(&of->solid[i], scratch, &to->collisions[i], NULL) == CDPREP_OK);
        if (to->collisions[i].containment == CDPREP_YES || to->collisions[i].hit == CDPREP_NO) {
            cdprep_collision inside;
            MUST(cdprep_containment(&of->surface[i], scratch, &inside, NULL) == CDPREP_OK);
            MUST(inside.containment == to->collisions[i].containment);
            MUST(inside.hit == inside.containment && inside.a_inside_b == CDPREP_NO);
            MUST(inside.winding == (inside.containment == CDPREP_YES ? 1 : 0));
        }
        MUST(cdprep_distance(&of->surface[i], &of->near_by, scratch, &to->distances[i], NULL) ==
             CDPREP_OK);
        MUST(cdprep_within(&of->surface[i], 0.25, scratch, &to->within[i], NULL) == CDPREP_OK);
        MUST(cdprep_overlaps(&of->proper[i], scratch, &to->overlaps[i], NULL) == CDPREP_OK);
        MUST(cdprep_overlaps_mark(&of->surface[i], scratch, &to->marked[i], NULL) == CDPREP_OK);
    }
    return NULL;
}

/* Asks them all at once. */
static const char* ask_at_once(const questions* of, cdprep_workspace* lanes, answers* to) {
    give_room(to);
    MUST(cdprep_collide_many(of->solid, JOBS, lanes, to->collisions, NULL) == CDPREP_OK);
    MUST(cdprep_distance_many(of->surface, JOBS, &of->near_by, lanes, to->distances, NULL) ==
         CDPREP_OK);
    MUST(cdprep_within_many(of->surface, JOBS, 0.25, lanes, to->within, NULL) == CDPREP_OK);
    MUST(cdprep_overlaps_many(of->proper, JOBS, lanes, to->overlaps, NULL) == CDPREP_OK);
    MUST(cdprep_overlaps_mark_many(of->surface, JOBS, lanes, to->marked, NULL) == CDPREP_OK);
    return NULL;
}

static const char* are_equal(const answers* x, const answers* y) {
    for (int i = 0; i < JOBS; ++i) {
        MUST(x->collisions[i].hit == y->collisions[i].hit);
        MUST(x->collisions[i].containment == y->collisions[i].containment);
        MUST(x->collisions[i].a_inside_b == y->collisions[i].a_inside_b);
        MUST(x->within[i] == y->within[i]);
        MUST(x->overlaps[i].count == y->overlaps[i].count);
        MUST(x->marked[i].count == y->marked[i].count);
    }
    MUST(memcmp(x->distances, y->distances, sizeof x->distances) == 0);
    MUST(memcmp(x->pairs, y->pairs, sizeof x->pairs) == 0);
    MUST(memcmp(x->bits, y->bits, sizeof x->bits) == 0);
    return NULL;
}

/* Both answers of every question occur, and pairs that find no room. */
static const char* are_mixed(const answers* x) {
    int hits = 0;
    int contained = 0;
    int found = 0;
    int within = 0;
    int short_of_room = 0;
    for (int i = 0; i < JOBS; ++i) {
        hits += x->collisions[i].hit == CDPREP_YES;
        contained += x->collisions[i].containment == CDPREP_YES;
        found += x->distances[i].found == CDPREP_YES;
        within += x->within[i] == CDPREP_YES;
        short_of_room += x->overlaps[i].count > ROOM;
    }
    MUST(hits * 10 > JOBS * 3 && hits * 10 < JOBS * 7);
    MUST(found * 10 > JOBS * 3 && found * 10 < JOBS * 9);
    MUST(within * 10 > JOBS * 3 && within * 10 < JOBS * 7);
    MUST(contained > 0 && short_of_room > 0);
    return NULL;
}

/* A pair that is wrong: it is named, none is asked, and nothing is known. */
static const char* ask_wrongly(questions* of, cdprep_workspace* lanes, answers* room) {
    cdprep_error error;
    of->surface[17].pose_b.rows[0] = 2;
    room->within[0] = CDPREP_YES;
    MUST(cdprep_within_many(of->surface, JOBS, 0.25, lanes, room->within, &error) ==
         CDPREP_BAD_ARGUMENT);
    MUST(strcmp(error.argument, "pairs[17].pose_b") == 0 && error.why == CDPREP_WHY_NOT_RIGID);
    MUST(room->within[0] == CDPREP_UNKNOWN);
    of->solid[16].b = NULL;
    MUST(cdprep_collide_many(of->solid, JOBS, lanes, room->collisions, &error) ==
         CDPREP_BAD_ARGUMENT);
    MUST(strcmp(error.argument, "pairs[16].b") == 0 && error.why == CDPREP_WHY_NULL);
    MUST(room->collisions[JOBS - 1].hit == CDPREP_UNKNOWN);
    room->overlaps[149].items = NULL;
    MUST(cdprep_overlaps_many(of->proper, JOBS, lanes, room->overlaps, &error) ==
         CDPREP_BAD_ARGUMENT);
    MUST(strcmp(error.argument, "lists[149].items") == 0 && room->overlaps[0].count == 0);
    MUST(cdprep_collide_many(NULL, 0, lanes, NULL, &error) == CDPREP_OK);
    return NULL;
}

/* A surface on itself: all pairs of triangles that share a corner, or the first. */
static const char* ask_split(const cdprep_model* a, cdprep_workspace* scratch,
                             cdprep_workspace* lanes) {
    enum { MOST = 70000 };
    static cdprep_overlap expected[MOST], pairs[MOST];
    const cdprep_pair pair = moved_by(a, a, 0);
    cdprep_overlap_list whole = {expected, MOST, 0};
    MUST(cdprep_overlaps(&pair, scratch, &whole, NULL) == CDPREP_OK);
    MUST(whole.count > 50000 && whole.count <= MOST);
    const size_t rooms[] = {0, 1, whole.count - 1, whole.count, MOST};
    for (size_t i = 0; i < sizeof rooms / sizeof *rooms; ++i) {
        const size_t room = rooms[i];
        cdprep_overlap_list list = {room == 0 ? NULL : pairs, room, 0};
        memset(pairs, 255, sizeof pairs);
        MUST(cdprep_overlaps_split(&pair, lanes, &list, NULL) == CDPREP_OK);
        MUST(list.count == whole.count);
        MUST(memcmp(pairs, expected, sizeof *pairs * (room < list.count ? room : list.count)) == 0);
    }
    return NULL;
}

static const char* ask_batches(const cdprep_model* a, const cdprep_model* b,
                               cdprep_workspace* lanes, const answers* expected, answers* room) {
    static cdprep_cache caches[JOBS];
    static questions of;
    memset(caches, 0, sizeof caches);
    make_questions(a, b, caches, &of);
    for (int again = 0; again < 2; ++again) {
        memset(room, 0, sizeof *room);
        const char* wrong = ask_at_once(&of, lanes, room);
        if (wrong == NULL) wrong = are_equal(room, expected);
        if (wrong != NULL) return wrong;
    }
    return ask_wrongly(&of, lanes, room);
}

static const char* ask_on_lanes(const cdprep_model* a, const cdprep_model* b,
                                const cdprep_workspace_options* given, cdprep_workspace* scratch,
                                answers room[2]) {
    static questions of;
    make_questions(a, b, NULL, &of);
    const char* wrong = ask_alone(&of, scratch, &room[0]);
    if (wrong == NULL) wrong = are_mixed(&room[0]);
    for (uint32_t count = 1; count <= 8 && wrong == NULL; ++count) {
        cdprep_workspace_options options = *given;
        cdprep_workspace* lanes = NULL;
        options.lanes = count;
        if (count == 1) options.run = NULL;
        MUST(cdprep_workspace_make(&options, NULL, 0, &lanes, NULL) == CDPREP_OK);
        wrong = ask_batches(a, b, lanes, &room[0], &room[1]);
        if (wrong == NULL) wrong = ask_split(a, scratch, lanes);
        cdprep_workspace_end(lanes);
    }
    return wrong;
}

const char* ask_many(const cdprep_model* a, const cdprep_model* b,
                     const cdprep_workspace_options* options) {
    cdprep_workspace* scratch = NULL;
    MUST(cdprep_workspace_make(NULL, NULL, 0, &scratch, NULL) == CDPREP_OK);
    answers* room = calloc(2, sizeof *room);
    const char* wrong = ask_on_lanes(a, b, options, scratch, room);
    free(room);
    cdprep_workspace_end(scratch);
    return wrong;
}
