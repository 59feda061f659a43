/* SPDX-License-Identifier: MIT */
#ifndef CDPREP_C_DRAW_H
#define CDPREP_C_DRAW_H

#include "cdprep/c/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Pictures of models and scenes for debugging: lines, triangles and texts in world coordinates. The
 * caller's functions draw them. */

/* What is drawn, as bits of a set. */
enum {
    CDPREP_DRAW_SURFACE = 1, /* all triangles. Needs CDPREP_ASK_CORNERS */
    CDPREP_DRAW_BOXES = 2,   /* boxes of one level of the BVH, 12 lines each. Needs the BVH */
    CDPREP_DRAW_HULLS = 4,   /* the hulls of parts, or the whole hull. Needs CDPREP_ASK_HULLS */
    CDPREP_DRAW_PIECES = 8,  /* hulls of convex pieces. Needs CDPREP_ASK_PIECES, _CORNERS */
    /* for scenes: lines between contact points, and normals. Needs the BVH */
    CDPREP_DRAW_CONTACTS = 16,
    /* for scenes: triangles in lists of overlaps and self-overlaps. Objects in these lists need
     * CDPREP_ASK_CORNERS */
    CDPREP_DRAW_OVERLAPS = 32,
    /* The numbers of parts and pieces that are drawn; for scenes, also the slots of objects. The
     * number of a slot stands in the middle of its model's box. Without the BVH, it stands at the
     * model's origin. */
    CDPREP_DRAW_NUMBERS = 64
};

/* What to draw, and the caller's functions. A function ends the drawing by returning 0. Points have
 * three numbers; a triangle has three points, counter-clockwise from outside. Colours are
 * 0xRRGGBBAA: surfaces grey, boxes green, contacts yellow, overlaps red, texts white. Parts and
 * pieces have one of eight colours, by their number. The functions run in the caller's
 * floating-point environment. They may run queries, but must not change the scene. */
typedef struct cdprep_draw {
    cdprep_head head;
    uint32_t what; /* 0: nothing; otherwise bits CDPREP_DRAW_ */
    /* 0: the level of the boxes. Level 0 is the box around everything. A level beyond the deepest
     * counts as the deepest. */
    uint32_t level;
    /* Null, which is refused if `what` has boxes or contacts. */
    int (*line)(void* context, const double start[3], const double end[3], uint32_t rgba);
    /* Null, which is refused if `what` has surfaces, hulls, pieces or overlaps. */
    int (*triangle)(void* context, const double corners[9], uint32_t rgba);
    /* Null, which is refused if `what` has numbers. The text ends with a zero. */
    int (*label)(void* context, const double at[3], const char* text, uint32_t rgba);
    void* context; /* null; passed to all three */
} cdprep_draw;

/* Makes default options: nothing is drawn. Writes `size` bytes, which must be sizeof(cdprep_draw).
 * Null does nothing. */
CDPREP_API void cdprep_draw_init(cdprep_draw* draw, size_t size);

/* Draws a model, moved by `world_from_model`. Triangles come in tree order. Takes O(shapes) time,
 * and does not allocate. Returns CDPREP_OK even if a function of the caller ended the drawing.
 * Errors: CDPREP_WHY_OUT_OF_RANGE for unknown bits. CDPREP_WHY_NO_MEANING for bits of scenes, or
 * for a level if no boxes are drawn. CDPREP_WHY_NULL for a missing function that `what` requires.
 * CDPREP_WHY_NOT_RIGID. CDPREP_WHY_NOT_BAKED or _NOT_OPENED if the model lacks what is to be drawn.
 * Needs: what each CDPREP_DRAW_ bit needs; for pieces: CDPREP_ASK_PIECES, CDPREP_ASK_CORNERS */
CDPREP_API int cdprep_model_draw(const cdprep_model* model, const cdprep_pose* world_from_model,
                                 const cdprep_draw* draw, cdprep_error* error);

/* Draws all objects of a scene where they are now, in the order of their slots. Then draws the
 * overlaps and the contacts of the last complete step. Triangles that overlap are drawn once for
 * each pair, where their objects are now. Pairs whose objects no longer exist are left out, and so
 * is each triangle that no longer exists. A normal starts at cdprep_contact.on_a. Its length is an
 * eighth of the diagonal of the smaller model's box.
 * Every model is checked before anything is drawn. If one lacks what is to be drawn, error.argument
 * is "scene", and the message names the slot.
 * Errors: those of cdprep_model_draw(); CDPREP_WHY_BUSY. */
CDPREP_API int cdprep_scene_draw(const cdprep_scene* scene, const cdprep_draw* draw,
                                 cdprep_error* error);

#ifdef __cplusplus
}
#endif

#endif /* CDPREP_C_DRAW_H */
