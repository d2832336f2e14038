/* Which engines the tests of every engine try. */
#ifndef TESTS_SUPPORT_SYSTEM_TRIED_H
#define TESTS_SUPPORT_SYSTEM_TRIED_H

#include "engines/list.h"
#include "tests/support/system/seed.h"

#include <string.h>
#include <unity.h>

/* Returns true for engines that run always and here. A build with sanitizers tries only one of the
 * specializer's profiles: their code is not instrumented, and their builder is the same. */
static inline bool engine_is_tried(const struct engine *engine)
{
    return !engine_unavailable(engine) && !engine->on_request &&
           (test_stride() == 1 || strncmp(engine->name, "specialize-", 11));
}

/* Ignores the running test on a processor on which the engine does not run. */
static inline void test_needs_engine(const char *name)
{
    const char *reason = engine_unavailable(engine_find(name));
    if (reason)
        TEST_IGNORE_MESSAGE(reason);
}

#endif
