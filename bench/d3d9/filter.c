/* The main part of Wine's Direct3D 9 test program, built with tests whose START_TEST calls each test function
 * through filter_run (bench/d3d9/wine-tests.sh). In the environment:
 *   D3D9_ONLY="name..."   only these test functions run
 *   D3D9_SKIP="name..."   these do not run
 *   D3D9_AFTER=name       only functions after this one run
 *   D3D9_LIST=1           no function runs; their names are printed
 * For each function it prints
 *   @begin NAME
 *   @end NAME checks N passed N failures N todo N better N unstable N skipped N milliseconds N
 * passed + failures + todo + better + unstable = checks. "todo" are checks that the test expects to fail on
 * Wine and that fail, "better" those that it expects to fail and that hold. */
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#define STANDALONE
#include <wine/test.h>

extern void func_d3d9ex(void), func_device(void), func_stateblock(void), func_visual(void);

const struct test winetest_testlist[] = {{"d3d9ex", func_d3d9ex},
                                         {"device", func_device},
                                         {"stateblock", func_stateblock},
                                         {"visual", func_visual},
                                         {0, 0}};

struct counts {
    LONG passed, failures, todo, better, unstable, skipped;
};

static struct counts current_counts(void)
{
    return (struct counts){.passed = successes,
                           .failures = failures,
                           .todo = todo_successes + muted_todo_successes,
                           .better = todo_failures,
                           .unstable = flaky_failures,
                           .skipped = skipped + muted_skipped};
}

/* Returns true if the variable contains the name, between spaces. */
static BOOL listed(const char *variable, const char *name)
{
    const char *text = getenv(variable);
    const size_t length = strlen(name);
    for (const char *at = text; at && (at = strstr(at, name)); at += length)
        if ((at == text || at[-1] == ' ') && (at[length] == 0 || at[length] == ' '))
            return TRUE;
    return FALSE;
}

static BOOL selected(const char *name)
{
    static BOOL passed_by;
    const char *only = getenv("D3D9_ONLY"), *after = getenv("D3D9_AFTER");
    const BOOL early = after && *after && !passed_by;
    if (early && !strcmp(after, name))
        passed_by = TRUE;
    return !early && (!only || !*only || listed("D3D9_ONLY", name)) && !listed("D3D9_SKIP", name);
}

static void report(const char *name, const struct counts *before, const struct counts *after,
                   DWORD milliseconds)
{
    const LONG passed = after->passed - before->passed, failed = after->failures - before->failures;
    const LONG todo = after->todo - before->todo, better = after->better - before->better;
    const LONG unstable = after->unstable - before->unstable;
    printf("\n@end %s checks %ld passed %ld failures %ld todo %ld better %ld unstable %ld skipped %ld "
           "milliseconds %lu\n",
           name, passed + failed + todo + better + unstable, passed, failed, todo, better, unstable,
           after->skipped - before->skipped, milliseconds);
    fflush(stdout);
}

void filter_run(const char *name, void (*function)(void))
{
    if (getenv("D3D9_LIST")) {
        printf("@name %s\n", name);
        return;
    }
    if (!selected(name))
        return;
    printf("@begin %s\n", name);
    fflush(stdout);
    const struct counts before = current_counts();
    const DWORD begin = GetTickCount();
    function();
    const DWORD milliseconds = GetTickCount() - begin;
    const struct counts after = current_counts();
    report(name, &before, &after, milliseconds);
}

/* wine/debug.h's strings need it; the tests are built outside Wine. */
const char *__wine_dbg_strdup(const char *text)
{
    static char copies[64][1024];
    static unsigned next;
    char *copy = copies[next++ % 64];
    strncpy(copy, text, sizeof copies[0] - 1);
    return copy;
}
