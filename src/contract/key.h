/* Keys: the part of the state that generated code depends on, a structure per unit, and their packed form.
 *
 * The fields are the rows of def/key.def, each a small integer; the values that they take are in
 * key_vertex.h, varying.h, key_sampler.h, key_pixel.h and key_blit.h. Packing is mixed radix (thesis,
 * section 3.6): in table order, the fields are the digits of one large number, least significant first. The
 * number is kept in 64-bit words, and no digit straddles two words. Two keys are equal exactly when their
 * packed words are equal. A key never holds a pointer or data.
 *
 * key_query.h answers questions about keys: what a routine reads, writes and discards. */
#ifndef CONTRACT_KEY_H
#define CONTRACT_KEY_H

#include "contract/key_blit.h"
#include "contract/key_pixel.h"
#include "contract/key_sampler.h"
#include "contract/key_vertex.h"
#include "contract/varying.h"
#include "def/key.def"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* The first UNIT_COUNT units are those of a draw. A kernel is a routine of another program than the renderer
 * (docs/clients.md): it has no specification in spec/ and no packed key, and is built from a recording. A
 * blit changes pixels without a draw: clears, averages of samples, mip levels. */
enum unit { UNIT_VERTEX, UNIT_SETUP, UNIT_PIXEL, UNIT_COUNT, UNIT_KERNEL = UNIT_COUNT, UNIT_BLIT, UNIT_ALL };

#define KEY_FIELD(unit, field, radix, meaning)         uint8_t field;
#define KEY_FIELDS(unit, field, count, radix, meaning) uint8_t field[count];

struct vertex_key {
    VERTEX_KEY(KEY_FIELD, KEY_FIELDS)
};

struct setup_key {
    SETUP_KEY(KEY_FIELD, KEY_FIELDS)
};

struct pixel_key {
    PIXEL_KEY(KEY_FIELD, KEY_FIELDS)
};

struct blit_key {
    BLIT_KEY(KEY_FIELD, KEY_FIELDS)
};

#undef KEY_FIELD
#undef KEY_FIELDS

struct kernel_key {
    uint16_t stride; /* bytes from one element's output to the next */
};

union key {
    struct vertex_key vertex;
    struct setup_key setup;
    struct pixel_key pixel;
    struct kernel_key kernel;
    struct blit_key blit;
};

/* Enough for every key: key.c checks both against def/key.def when it is compiled. */
enum { KEY_PACKED_WORDS = 40, KEY_TEXT_CAPACITY = 16384 };

/* The label of a routine. It is compared (key_equal) and hashed as bytes. All keys of a unit have the same
 * number of words; the words after those are undefined. */
struct packed_key {
    uint32_t words;
    uint64_t word[KEY_PACKED_WORDS];
};

/* One field of a unit's key. */
struct key_field {
    const char *name;
    const char *meaning;
    uint16_t offset; /* bytes from the start of the unit's key */
    uint8_t count;   /* 1, or the length of an array */
    uint16_t radix;  /* values are 0 to radix - 1 */
};

extern const char *const unit_name[UNIT_ALL]; /* "vertex", "setup", "pixel", "kernel", "blit" */

/* The fields of a unit's key in packing order; *count receives their number, 0 for kernels. For tests: every
 * field of a key. */
const struct key_field *key_fields(enum unit unit, size_t *count);

/* Packs a key; every field must be below its radix. Unpacking gives the same fields back. */
struct packed_key key_pack(enum unit unit, const union key *key);
/* For tests: the inverse of key_pack. */
void key_unpack(enum unit unit, const struct packed_key *packed, union key *key);

/* 64-bit hash of the unit and the packed words (xxHash). */
uint64_t key_hash(enum unit unit, const struct packed_key *packed);

/* Returns true if two packed keys of one unit are the same. */
bool key_equal(const struct packed_key *a, const struct packed_key *b);

/* Writes `field=value field=v,v,v ...` and returns text. Fields that are zero and zeros at the end of an
 * array are left out; a key of zeros is "default". */
char *key_print(enum unit unit, const union key *key, char text[KEY_TEXT_CAPACITY]);

/* Reads the text that key_print writes. Returns 0, or -1 with *where at the offending character. */
int key_parse(enum unit unit, const char *text, union key *key, const char **where);

/* The program of a unit's key, or null if it has none. */
const struct program *key_shader(enum unit unit, const union key *key);

/* The program number in the four bytes of a key's field `shader`; 0: no shader. */
static inline uint32_t key_program(const uint8_t shader[4])
{
    return shader[0] | (uint32_t)shader[1] << 8 | (uint32_t)shader[2] << 16 | (uint32_t)shader[3] << 24;
}

static inline void key_set_program(uint8_t shader[4], uint32_t number)
{
    for (int i = 0; i < 4; i++)
        shader[i] = (uint8_t)(number >> 8 * i);
}

/* The index of the first non-zero byte of bytes[at] to bytes[count - 1], or `count`. It skips eight zeros at
 * a time: most bytes of most keys are zero. */
static inline unsigned key_next(const uint8_t *bytes, unsigned at, unsigned count)
{
    for (uint64_t word; at + sizeof word <= count; at += sizeof word) {
        memcpy(&word, bytes + at, sizeof word);
        if (word)
            return at + (unsigned)__builtin_ctzll(word) / 8;
    }
    while (at < count && !bytes[at])
        at++;
    return at;
}

#endif
