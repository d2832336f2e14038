/* Digests: 32 bytes that identify contents, even if the contents are chosen to collide.
 *
 * The function is BLAKE2b with a result of 256 bits and without a key (RFC 7693). It reads about a byte per
 * nanosecond. XXH3, which the project uses elsewhere, is faster, but equal hashes are easy to construct. */
#ifndef BASE_DIGEST_H
#define BASE_DIGEST_H

#include <stddef.h>
#include <stdint.h>

enum { DIGEST_BYTES = 32, DIGEST_BLOCK = 128, DIGEST_WORDS = 8 };

struct digest {
    uint8_t byte[DIGEST_BYTES];
};

/* Contents that arrive in pieces. */
struct digest_state {
    uint64_t word[DIGEST_WORDS];
    uint64_t bytes; /* that are in `word` */
    size_t waiting; /* bytes in `block` */
    uint8_t block[DIGEST_BLOCK];
};

void digest_begin(struct digest_state *state);
void digest_add(struct digest_state *state, const void *data, size_t bytes);
struct digest digest_end(struct digest_state *state);

/* The digest of contents in one piece. */
struct digest digest_of(const void *data, size_t bytes);

#endif
