/* The external engine: print, compile, load.
 *
 * MXCSR is set outside of the text, because a compiler could move calculations before code in the text
 * that sets it. */
#define _GNU_SOURCE /* dladdr1 */
#include "machine/cpu.h"
#include "base/memory_file.h"
#include "machine/mxcsr.h"
#include "engines/external/external.h"

#include <dlfcn.h>
#include <elf.h>
#include <link.h>
#include <stdlib.h>
#include <string.h>

struct external_routine {
    struct routine routine;
    void *object; /* of dlopen */
    void (*body)(const void *call);
};

static const char *unavailable(const struct engine *self)
{
    (void)self;
    const char *reason = cpu_lacks_avx2_fma();
    if (!reason)
        reason = external_no_loading();
    return reason ? reason : external_no_compiler();
}

/* Compilers end a function with vzeroupper only on the paths that use the upper halves, and trust that the
 * caller's are zero. The convention of routines promises it on every path. */
static void clear_upper_halves(void)
{
    __asm__ volatile("vzeroupper" ::
                         : "xmm0", "xmm1", "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8", "xmm9",
                           "xmm10", "xmm11", "xmm12", "xmm13", "xmm14", "xmm15");
}

static void run(const void *call, const struct routine *routine)
{
    unsigned saved = mxcsr_enter();
    ((const struct external_routine *)(const void *)routine)->body(call);
    clear_upper_halves();
    mxcsr_leave(saved);
}

/* Runs a text that needs no flags: with those that every C program starts with, which keep denormals. */
static void run_portable(const void *call, const struct routine *routine)
{
    unsigned saved = mxcsr_enter();
    _mm_setcsr(_MM_MASK_MASK);
    ((const struct external_routine *)(const void *)routine)->body(call);
    clear_upper_halves();
    mxcsr_leave(saved);
}

void external_print_beginning(enum external_language language, FILE *out)
{
    if (language == EXTERNAL_PORTABLE)
        fputs("#define FLUSHES 0\n", out);
    if (language == EXTERNAL_PIXELS)
        fputs("#define COMPONENTS 4\n", out);
    bool vectors = language == EXTERNAL_VECTORS || language == EXTERNAL_PIXELS;
    fputs(vectors ? external_vector : external_plain, out);
    if (!vectors)
        external_print_operations(language == EXTERNAL_PORTABLE, out);
}

/* Returns the whole text, or null with the reason. Free it. */
static char *make_text(const struct engine *engine, const struct ir *ir, enum unit unit, const union key *key,
                       size_t *bytes, struct error *error)
{
    char *text = NULL;
    FILE *out = memory_file_open();
    if (out) {
        external_print_beginning(external_options(engine)->language, out);
        bool bad = external_print(external_options(engine)->language, ir, unit, key, out) || ferror(out);
        bad |= memory_file_close(out, &text, bytes);
        if (!bad)
            return text;
    }
    error_set(error, "out of memory for the text of a %s routine", unit_name[unit]);
    free(text);
    return NULL;
}

/* Finds the address and the size of the function. Returns -1 if the object does not contain it. */
static int find_function(struct external_routine *external)
{
    void *function = dlsym(external->object, EXTERNAL_FUNCTION);
    Dl_info info;
    ElfW(Sym) *symbol = NULL;
    if (!function)
        return -1;
    memcpy(&external->body, &function, sizeof function);
    external->routine.code = function;
    if (dladdr1(function, &info, (void **)&symbol, RTLD_DL_SYMENT) && symbol)
        external->routine.code_bytes = (uint32_t)symbol->st_size;
    return 0;
}

struct routine *external_routine(const struct engine *engine, const struct ir *ir, enum unit unit,
                                 const union key *key, struct error *error)
{
    struct external_routine *external = calloc(1, sizeof *external);
    size_t bytes;
    char *text = external ? make_text(engine, ir, unit, key, &bytes, error) : NULL;
    if (!external)
        error_set(error, "out of memory for a routine");
    if (text)
        external->object = external_compile(external_options(engine), text, bytes, error);
    free(text);
    if (!external || !external->object) {
        free(external);
        return NULL;
    }
    if (find_function(external)) {
        error_set(error, "the compiled object has no function %s", EXTERNAL_FUNCTION);
        dlclose(external->object);
        free(external);
        return NULL;
    }
    external->routine.run = external_options(engine)->language == EXTERNAL_PORTABLE ? run_portable : run;
    external->routine.engine = engine;
    external->routine.unit = unit;
    external->routine.key = *key;
    external->routine.parts = ir->count - 1;
    return &external->routine;
}

static struct routine *build(const struct engine *self, struct code_arena *arena, enum unit unit,
                             const union key *key, struct error *error)
{
    (void)arena;
    struct ir *ir = ir_take(unit, key, error);
    if (!ir)
        return NULL;
    struct routine *routine = external_routine(self, ir, unit, key, error);
    ir_give(ir);
    return routine;
}

static void free_routine(struct code_arena *arena, struct routine *routine)
{
    (void)arena;
    dlclose(((struct external_routine *)(void *)routine)->object);
    free(routine);
}

bool external_is_engine(const struct engine *engine)
{
    return engine->build == build;
}

const struct engine engine_external = {
    .name = "external",
    .description =
        "the recording printed as C, compiled by the system's compiler (TRIPTYCH_CC or cc) and loaded",
    .width = EXTERNAL_WIDTH,
    .without_arena = true,
    .on_request = true,
    .options = &(const struct external_options){EXTERNAL_VECTORS, '2'},
    .unavailable = unavailable,
    .build = build,
    .free = free_routine,
};
