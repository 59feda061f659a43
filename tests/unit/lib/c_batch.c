/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "c_asking.h"
#include "c_face.h"

enum { JOBS = 150, ROOM = 100, WORDS = 256 };

/* Every job's answers, with room for them. */
typedef struct answers {
    cdprep_collision collisions[JOBS];
    int found[JOBS];
    cdprep_distance distances[JOBS];
    int within[JOBS];
    cdprep_overlap_answer overlaps[JOBS];
    cdprep_marked_triangles marked[JOBS];
    cdprep_triangle_pair pairs[JOBS][ROOM];
    uint64_t bits[JOBS][2][WORDS];
} answers;

static void give_room(answers* to) {
    for (int i = 0; i < JOBS; ++i) {
        const cdprep_overlap_answer overlap = {to->pairs[i], ROOM, 0};
        const cdprep_marked_triangles marked = {to->bits[i][0], WORDS, to->bits[i][1], WORDS, 0};
        to->overlaps[i] = overlap;
        to->marked[i] = marked;
    }
}

static const cdprep_contact_options proper = {sizeof proper, CDPREP_PROPER, CDPREP_SKIP_DEGENERATE,
                                              CDPREP_SURFACE};
static const cdprep_contact_options solid = {sizeof solid, CDPREP_CLOSED, CDPREP_KEEP_DEGENERATE,
                                             CDPREP_SOLID};
static const cdprep_distance_options near_by = {sizeof near_by, CDPREP_SURFACE, 0, 0, 1};

/* Asks them one by one. */
static const char* ask_alone(const cdprep_pair_job* jobs, cdprep_workspace* scratch, answers* to) {
    give_room(to);
    for (int i = 0; i < JOBS; ++i) {
        const cdprep_pair_job* job = &jobs[i];
        cdprep_overlap_answer* overlap = &to->overlaps[i];
        cdprep_marked_triangles* marked = &to->marked[i];
        MUST(cdprep_collide(job->a, job->b, job->placement, scratch, &solid, NULL,
                            &to->collisions[i], NULL) == CDPREP_OK);
        if (to->collisions[i].containment == CDPREP_YES || !to->collisions[i].hit) {
            cdprep_containment containment;
            MUST(cdprep_find_containment(job->a, job->b, job->placement, scratch, &containment,
                                         NULL) == CDPREP_OK);
            MUST(containment.answer == to->collisions[i].containment);
            MUST(!containment.a_inside_b);
            MUST(containment.winding == (containment.answer == CDPREP_YES ? 1 : 0));
        }
        MUST(cdprep_distance_between(job->a, job->b, job->placement, scratch, &near_by, NULL,
                                     &to->found[i], &to->distances[i], NULL) == CDPREP_OK);
        MUST(cdprep_is_within(job->a, job->b, job->placement, scratch, 0.25, NULL, &to->within[i],
                              NULL) == CDPREP_OK);
        MUST(cdprep_overlapping_triangles(job->a, job->b, job->placement, scratch, &proper, NULL,
                                          overlap->pairs, ROOM, &overlap->count,
                                          NULL) == CDPREP_OK);
        MUST(cdprep_mark_overlapping_triangles(job->a, job->b, job->placement, scratch, NULL, NULL,
                                               marked->bits_a, WORDS, marked->bits_b, WORDS,
                                               &marked->count, NULL) == CDPREP_OK);
    }
    return NULL;
}

/* Asks them all at once. */
static const char* ask_at_once(const cdprep_pair_job* jobs, cdprep_workspaces* scratch,
                               const cdprep_parallel_for* threads, answers* to) {
    cdprep_error error;
    give_room(to);
    MUST(cdprep_collide_all(jobs, JOBS, scratch, threads, &solid, to->collisions, &error) ==
         CDPREP_OK);
    MUST(cdprep_distance_between_all(jobs, JOBS, scratch, threads, &near_by, to->found,
                                     to->distances, &error) == CDPREP_OK);
    MUST(cdprep_is_within_all(jobs, JOBS, scratch, threads, 0.25, to->within, &error) == CDPREP_OK);
    MUST(cdprep_overlapping_triangles_all(jobs, JOBS, scratch, threads, &proper, to->overlaps,
                                          &error) == CDPREP_OK);
    MUST(cdprep_mark_overlapping_triangles_all(jobs, JOBS, scratch, threads, NULL, to->marked,
                                               &error) == CDPREP_OK);
    return NULL;
}

static const char* are_equal(const answers* x, const answers* y) {
    for (int i = 0; i < JOBS; ++i) {
        MUST(x->collisions[i].hit == y->collisions[i].hit);
        MUST(x->collisions[i].containment == y->collisions[i].containment);
        MUST(x->collisions[i].a_inside_b == y->collisions[i].a_inside_b);
        MUST(x->found[i] == y->found[i] && x->within[i] == y->within[i]);
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
        hits += x->collisions[i].hit;
        contained += x->collisions[i].containment == CDPREP_YES;
        found += x->found[i];
        within += x->within[i];
        short_of_room += x->overlaps[i].count > ROOM;
    }
    MUST(hits * 10 > JOBS * 3 && hits * 10 < JOBS * 7);
    MUST(found * 10 > JOBS * 3 && found * 10 < JOBS * 9);
    MUST(within * 10 > JOBS * 3 && within * 10 < JOBS * 7);
    MUST(contained > 0 && short_of_room > 0);
    return NULL;
}

/* A about z, B away from it: from deep inside to far. Of every second one both move. */
static cdprep_placement placed(int i) {
    cdprep_placement placement = moved_by(0.02 * (i - i % 2));
    if (i % 2 == 0) return placement;
    const double angle = 0.1 * i;
    placement.kind = CDPREP_WORLD;
    placement.a.rows[0] = placement.a.rows[4] = cos(angle);
    placement.a.rows[3] = sin(angle);
    placement.a.rows[1] = -placement.a.rows[3];
    return placement;
}

static const char* ask_batches(const cdprep_model* a, const cdprep_model* b,
                               cdprep_workspaces* scratch, const cdprep_parallel_for* threads,
                               const answers* expected, answers* room) {
    cdprep_placement placements[JOBS];
    cdprep_pair_cache caches[JOBS];
    cdprep_pair_job jobs[JOBS];
    memset(caches, 0, sizeof caches);
    for (int i = 0; i < JOBS; ++i) {
        const cdprep_pair_job job = {a, b, &placements[i], i % 3 == 0 ? &caches[i] : NULL};
        placements[i] = placed(i);
        jobs[i] = job;
    }
    for (int again = 0; again < 2; ++again) {
        memset(room, 0, sizeof *room);
        const char* wrong = ask_at_once(jobs, scratch, threads, room);
        if (wrong == NULL) wrong = are_equal(room, expected);
        if (wrong != NULL) return wrong;
    }
    /* One wrong job: its number is told, and nothing is asked. */
    cdprep_error error;
    placements[17].kind = 9;
    room->within[0] = 77;
    MUST(cdprep_is_within_all(jobs, JOBS, scratch, threads, 0.25, room->within, &error) ==
         CDPREP_BAD_ARGUMENT);
    MUST(strstr(error.message, "17") != NULL && room->within[0] == 77);
    jobs[16].b = NULL;
    MUST(cdprep_collide_all(jobs, JOBS, scratch, threads, NULL, room->collisions, &error) ==
         CDPREP_BAD_ARGUMENT);
    MUST(strstr(error.message, "16") != NULL);
    MUST(cdprep_collide_all(NULL, 0, scratch, threads, NULL, NULL, &error) == CDPREP_OK);
    MUST(cdprep_collide_all(jobs, 1, NULL, threads, NULL, room->collisions, &error) ==
         CDPREP_BAD_ARGUMENT);
    const cdprep_parallel_for no_size = {0, NULL, NULL};
    MUST(cdprep_collide_all(jobs, 1, scratch, &no_size, NULL, room->collisions, &error) ==
         CDPREP_BAD_ARGUMENT);
    return NULL;
}

/* A surface on itself: all pairs of triangles that share a corner, or the first. */
static const char* ask_split(const cdprep_model* a, cdprep_workspace* scratch,
                             cdprep_workspaces* many, const cdprep_parallel_for* threads) {
    enum { MOST = 70000 };
    static cdprep_triangle_pair expected[MOST];
    static cdprep_triangle_pair pairs[MOST];
    size_t count = 0;
    size_t counted = 0;
    const cdprep_placement placement = moved_by(0);
    MUST(cdprep_overlapping_triangles(a, a, &placement, scratch, NULL, NULL, expected, MOST, &count,
                                      NULL) == CDPREP_OK);
    MUST(count > 50000 && count <= MOST);
    const size_t rooms[] = {0, 1, count - 1, count, MOST};
    for (size_t i = 0; i < sizeof rooms / sizeof *rooms; ++i) {
        const size_t room = rooms[i];
        memset(pairs, 255, sizeof pairs);
        MUST(cdprep_split_overlapping_triangles(a, a, &placement, many, threads, NULL,
                                                room == 0 ? NULL : pairs, room, &counted,
                                                NULL) == CDPREP_OK);
        MUST(counted == count);
        MUST(memcmp(pairs, expected, sizeof *pairs * (room < count ? room : count)) == 0);
    }
    MUST(cdprep_split_overlapping_triangles(a, a, &placement, many, threads, NULL, NULL, 1,
                                            &counted, NULL) == CDPREP_BAD_ARGUMENT);
    MUST(cdprep_split_overlapping_triangles(a, a, &placement, NULL, threads, NULL, NULL, 0,
                                            &counted, NULL) == CDPREP_BAD_ARGUMENT);
    return NULL;
}

/* The scratch of one and of up to eight, in `memory`. */
static const char* ask_on_threads(const cdprep_model* a, const cdprep_model* b, char* memory,
                                  const cdprep_parallel_for* threads, answers room[2]) {
    cdprep_workspace* scratch = cdprep_make_workspace(memory, cdprep_workspace_size());
    MUST(scratch != NULL);
    cdprep_placement placements[JOBS];
    cdprep_pair_job jobs[JOBS];
    for (int i = 0; i < JOBS; ++i) {
        const cdprep_pair_job job = {a, b, &placements[i], NULL};
        placements[i] = placed(i);
        jobs[i] = job;
    }
    const char* wrong = ask_alone(jobs, scratch, &room[0]);
    if (wrong == NULL) wrong = are_mixed(&room[0]);
    const size_t alignment = cdprep_workspace_alignment();
    char* behind = memory + (cdprep_workspace_size() + alignment - 1) / alignment * alignment;
    for (size_t workers = 1; workers <= 8 && wrong == NULL; ++workers) {
        const size_t size = cdprep_workspaces_size(workers);
        MUST(cdprep_make_workspaces(behind, size - 1, workers) == NULL);
        MUST(cdprep_make_workspaces(behind + 1, size, workers) == NULL);
        cdprep_workspaces* many = cdprep_make_workspaces(behind, size, workers);
        MUST(many != NULL);
        wrong = ask_batches(a, b, many, workers == 3 ? NULL : threads, &room[0], &room[1]);
        if (wrong == NULL) wrong = ask_split(a, scratch, many, workers == 3 ? NULL : threads);
    }
    return wrong;
}

const char* ask_many(const void* bytes_a, size_t size_a, const void* bytes_b, size_t size_b,
                     const cdprep_parallel_for* threads) {
    cdprep_model* a = NULL;
    cdprep_model* b = NULL;
    MUST(cdprep_open_memory(bytes_a, size_a, "a", &a, NULL) == CDPREP_OK);
    MUST(cdprep_open_memory(bytes_b, size_b, "b", &b, NULL) == CDPREP_OK);
    MUST(cdprep_make_workspaces(NULL, 1000000, 1) == NULL);
    MUST(cdprep_workspaces_size(SIZE_MAX / 2) == SIZE_MAX);

    const size_t alignment = cdprep_workspace_alignment();
    char* memory = malloc(cdprep_workspace_size() + cdprep_workspaces_size(8) + 2 * alignment);
    char* aligned = memory + (alignment - (uintptr_t)memory % alignment) % alignment;
    MUST(cdprep_make_workspaces(aligned, SIZE_MAX, 0) == NULL);
    answers* room = calloc(2, sizeof *room);
    const char* wrong = ask_on_threads(a, b, aligned, threads, room);
    free(room);
    free(memory);
    cdprep_close(a);
    cdprep_close(b);
    return wrong;
}
