/* Random keys. */
#ifndef TESTS_SUPPORT_SHADER_RANDOM_KEY_H
#define TESTS_SUPPORT_SHADER_RANDOM_KEY_H

#include "contract/key.h"

/* Makes a key whose fields are uniformly distributed below their radixes. Advances the seed, which is not 0
 * (xorshift64*). */
void key_random(enum unit unit, uint64_t *seed, union key *key);

#endif
