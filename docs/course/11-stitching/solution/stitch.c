#include "stitch.h"

#include <string.h>

int hole_offset(const struct fragment *fragment, enum hole hole)
{
    static const uint32_t values[] = HOLE_VALUES;
    for (const uint8_t *at = fragment->begin; at + sizeof *values <= fragment->end; at++)
        if (!memcmp(at, values + hole, sizeof *values))
            return (int)(at - fragment->begin);
    return -1;
}

/* The displacement that fills a hole of operation `number`. */
static uint32_t filling(const struct recorded *recorded, int number, enum hole hole)
{
    int index = hole == HOLE_LEFT     ? recorded->left
                : hole == HOLE_RIGHT  ? recorded->right
                : hole == HOLE_RESULT ? number
                                      : recorded->element;
    return (uint32_t)index * sizeof(float);
}

static void fill(uint8_t *at, const struct fragment *fragment, const struct recorded *recorded, int number)
{
    for (int hole = 0; hole < HOLES; hole++)
        if (fragment_holes[recorded->operation] >> hole & 1) {
            uint32_t displacement = filling(recorded, number, hole);
            memcpy(at + hole_offset(fragment, hole), &displacement, sizeof displacement);
        }
}

size_t stitch(const struct recording *recording, uint8_t *code, size_t room)
{
    size_t bytes = 0;
    for (int i = 0; i < recording->count; i++) {
        const struct fragment *fragment = fragments + recording->at[i].operation;
        size_t length = (size_t)(fragment->end - fragment->begin);
        if (room - bytes < length + 1)
            return 0;
        memcpy(code + bytes, fragment->begin, length);
        fill(code + bytes, fragment, recording->at + i, i);
        bytes += length;
    }
    code[bytes] = 0xc3;
    return bytes + 1;
}
