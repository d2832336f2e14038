/* The words of capture/word.def, and those of vertex elements, vertex formats and depth formats, with the
 * numbers that they represent. */
#ifndef CAPTURE_WORD_H
#define CAPTURE_WORD_H

#include "base/words.h"

#include <stddef.h>

enum word_list {
    WORDS_ATTRIBUTE,
    WORDS_DEPTH,
    WORDS_FORMAT,
    WORDS_FREQUENCY,
    WORDS_PRIMITIVE,
    WORDS_CONVENTION,
    WORDS_PIXEL_CENTER, /* the values of each convention, in the order of the conventions */
    WORDS_DEPTH_RANGE,
    WORDS_MULTIPLY,
    WORDS_WINDOW_ORIGIN,
    WORDS_POINT_CLIP,
    WORDS_DEPTH_BIAS_UNIT,
    WORDS_PROVOKING_VERTEX,
    WORDS_CUBE_ADDRESS,
    WORDS_MAGNIFY_LIMIT,
    WORDS_SPRITE_ORIGIN,
    WORDS_TRANSFORM,
    WORDS_VALUE,
    WORDS_MESH,
    WORDS_NORMALS,
    WORDS_TEXCOORDS,
    WORDS_TEXTURETYPE,
    WORDS_USAGE
};

/* Returns the word of a number; null if it has none. */
const char *word_text(enum word_list list, unsigned value);

/* Finds the word; returns -1 if the list does not have it. */
int word_value(enum word_list list, const char *text, size_t length, unsigned *value);

/* The words of a list, for reasons. */
struct words word_list(enum word_list list);

#endif
