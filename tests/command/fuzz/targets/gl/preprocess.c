/* Directives and macros of the OpenGL ES Shading Language. The first byte chooses the stage. The tokens of a
 * source without errors are a source of the same tokens, because nothing is left to expand. */
#include "front/glsl/context.h"
#include "front/glsl/preprocess/preprocess.h"
#include "tests/command/fuzz/targets/target.h"

#include <string.h>

/* Macros can make a source a thousand times as long. */
enum { TOKENS = 4096, WRITTEN = 1 << 16 };

/* A text that grows until it is full. */
struct text {
    char bytes[WRITTEN];
    size_t used;
    unsigned tokens;
    bool full;
};

static void write_token(struct text *text, const struct glsl_token *token)
{
    text->full |= ++text->tokens > TOKENS || text->used + token->length + 1 > WRITTEN;
    if (text->full)
        return;
    memcpy(text->bytes + text->used, token->text, token->length);
    text->bytes[text->used + token->length] = ' ';
    text->used += token->length + 1u;
}

static void write_tokens(struct glsl_context *context, struct text *text)
{
    struct glsl_token token;
    while ((token = glsl_preprocess_next(context)).kind != GLSL_END && !text->full) {
        expect(token.kind != GLSL_LINE_END, "a line end");
        write_token(text, &token);
    }
    if (!text->full)
        expect(glsl_preprocess_next(context).kind == GLSL_END, "a token after the end");
}

/* Returns 0; another number if the preprocessor ended the compilation. */
static int try_source(struct glsl_context *context, const char *source, size_t bytes, struct text *text)
{
    int reason = setjmp(context->arena.refused), length = (int)bytes;
    if (!reason) {
        glsl_preprocess_begin(context, glsl_tokens(context, &source, &length, 1));
        write_tokens(context, text);
    }
    return reason;
}

/* Writes the tokens of a source, each with a space after it. Returns false if it has an error or too many
 * tokens. */
static bool preprocess(enum glsl_stage stage, const char *source, size_t bytes, struct text *text)
{
    struct glsl_context *context = calloc(1, sizeof *context);
    char *log = calloc(1, GLSL_LOG_BYTES);
    expect(context && log, "memory");
    context->stage = stage;
    context->log.text = log;
    text->used = text->tokens = 0;
    text->full = false;
    int reason = try_source(context, source, bytes, text);
    expect(!reason || context->log.errors, "%s", log);
    expect(!strncmp(log, "ERROR: ", 7) || !strncmp(log, "WARNING: ", 9) || !*log, "%s", log);
    bool good = !reason && !context->log.errors && !text->full;
    glsl_arena_free(&context->arena);
    free(context);
    free(log);
    return good;
}

static void run(const uint8_t *data, size_t bytes)
{
    static struct text once, again;
    static char source[WRITTEN + 2];
    struct choices choices = {data, data + bytes};
    enum glsl_stage stage = choose(&choices, 2) ? GLSL_FRAGMENT : GLSL_VERTEX;
    if (!preprocess(stage, (const char *)choices.at, (size_t)(choices.end - choices.at), &once))
        return;
    /* A number in front: else a # could begin a directive. */
    memcpy(source, "0 ", 2);
    memcpy(source + 2, once.bytes, once.used);
    expect(preprocess(stage, source, once.used + 2, &again), "%.*s", (int)once.used, once.bytes);
    expect(again.used == once.used + 2 && !memcmp(again.bytes, source, again.used), "%.*s\n%.*s",
           (int)again.used, again.bytes, (int)once.used, once.bytes);
}

const struct fuzz_target fuzz_preprocess = {"preprocess", run};
