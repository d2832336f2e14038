/* The words of stream/word.def, and those of attributes and other elements (enum stream_element), their types and depth formats, and the numbers they
 * stand for. */
#ifndef STREAM_WORDS_H
#define STREAM_WORDS_H

#include <stddef.h>

enum word_list {
    WORDS_ATTRIBUTE,
    WORDS_DEPTH,
    WORDS_FORMAT,
    WORDS_FREQUENCY,
    WORDS_PRIMITIVE,
    WORDS_CONVENTION,
    WORDS_PIXEL_CENTER, /* the values of each convention, in their order */
    WORDS_DEPTH_RANGE,
    WORDS_MULTIPLY,
    WORDS_TRANSFORM,
    WORDS_VALUE,
    WORDS_MESH,
    WORDS_NORMALS,
    WORDS_TEXCOORDS,
    WORDS_TEXTURETYPE,
    WORDS_USAGE
};

/* The number's word; null if it has none. */
const char *word_text(enum word_list list, unsigned value);

/* Finds the word; returns -1 if the list does not have it. */
int word_value(enum word_list list, const char *text, size_t length, unsigned *value);

/* "position, normal, ...": the list's words. */
void word_choices(enum word_list list, char *out, size_t size);

#endif
