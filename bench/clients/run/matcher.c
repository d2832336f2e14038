/* Regular expressions with PCRE2 and its just-in-time compiler. */
#define PCRE2_CODE_UNIT_WIDTH 8

#include "bench/clients/matcher/matcher.h"
#include "bench/clients/matcher/regex.h"
#include "bench/clients/run/work.h"

#include <pcre2.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT = 1 << 20, LINES = 20000, EXPRESSIONS = 3 };

static const char *const expressions[EXPRESSIONS] = {
    "(GET|POST|PUT) /[a-z]+/\\d{4,6}", "\\w+@\\w+\\.(com|org|net)$", "err(or)?.{0,20}time[- ]?out"};

struct matcher_state {
    struct automaton automaton;
    struct dfa *dfa;
    pcre2_code *code;
    pcre2_match_data *data;
    const uint8_t *text;
    int32_t *line;
    uint32_t lines;
};

static pcre2_code *compile(const char *expression)
{
    int number;
    PCRE2_SIZE at;
    pcre2_code *code = pcre2_compile((PCRE2_SPTR)expression, PCRE2_ZERO_TERMINATED, 0, &number, &at, NULL);
    if (!code || pcre2_jit_compile(code, PCRE2_JIT_COMPLETE))
        work_fail("PCRE2 refuses an expression");
    return code;
}

/* Returns 1, 0, or -1 if PCRE2 gives up: it searches backwards, and has a limit of its stack. */
static int matches_library(const struct matcher_state *state, const uint8_t *line, size_t bytes)
{
    int result = pcre2_jit_match(state->code, line, bytes, 0, 0, state->data, NULL);
    return result >= 0 ? 1 : result == PCRE2_ERROR_NOMATCH ? 0 : -1;
}

static void run(struct work *work, enum way way, const struct kernel *kernel)
{
    const struct matcher_state *state = work->state;
    uint32_t *found = (uint32_t *)(void *)work->out;
    if (way == WAY_KERNEL)
        matcher_kernel_lines(kernel, &state->automaton, state->text, state->line, state->lines, found);
    for (uint32_t n = 0; n < state->lines && way != WAY_KERNEL; n++) {
        const uint8_t *line = state->text + state->line[n];
        int32_t end = n + 1 < state->lines ? state->line[n + 1] : TEXT;
        found[n] = way == WAY_PLAIN ? dfa_matches(state->dfa, line)
                                    : matches_library(state, line, (size_t)(end - state->line[n] - 1)) == 1;
    }
}

static uint32_t next(uint32_t *seed, uint32_t limit)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 16) % limit;
}

/* A line of a log: words, numbers, addresses, and now and then an error. Returns its length. */
static int make_line(char *to, size_t room, uint32_t *seed)
{
    static const char *const words[] = {"GET",      "POST",   "/index",  "user",  "error",
                                        "request",  "from",   "timeout", "cache", "session",
                                        "time-out", "/page/", "host",    "ok"};
    int length = 0;
    for (uint32_t count = 4 + next(seed, 8); count && length + 40 < (int)room; count--) {
        uint32_t kind = next(seed, 12), number = next(seed, 1000000);
        const char *word = words[next(seed, sizeof words / sizeof words[0])];
        length += kind < 8 ? sprintf(to + length, "%s ", word)
                  : kind < 10
                      ? sprintf(to + length, "%s%u ", kind == 9 ? "/item/" : "", number)
                      : sprintf(to + length, "u%u@%s.%s", number, "example", kind == 10 ? "org" : "eu ");
    }
    return length;
}

static void make_text(struct matcher_state *state)
{
    uint8_t *text = work_memory(TEXT + 4);
    uint32_t seed = 1;
    int at = 0;
    state->line = work_memory((LINES + KERNEL_ELEMENTS) * sizeof *state->line);
    while (at < TEXT && state->lines < LINES) {
        char line[400];
        int length = make_line(line, sizeof line, &seed);
        state->line[state->lines++] = at;
        if (state->lines == LINES || at + length + 200 > TEXT)
            length = TEXT - 1 - at < 300 ? TEXT - 1 - at : length;
        memcpy(text + at, line, (size_t)length);
        at += length;
        text[at++] = '\n';
    }
    state->text = text;
}

static void set_expression(struct matcher_state *state, const char *expression)
{
    struct error error = {{0}};
    if (automaton_make(&state->automaton, expression, &error))
        work_fail(error.text);
    state->dfa = dfa_create(&state->automaton, &error);
    if (!state->dfa)
        work_fail(error.text);
    state->code = compile(expression);
    state->data = pcre2_match_data_create_from_pattern(state->code, NULL);
    if (!state->data)
        work_fail("PCRE2 has no memory");
}

size_t work_matcher(struct work *work)
{
    struct matcher_state *state = work_memory(EXPRESSIONS * sizeof *state);
    make_text(state);
    for (int n = 0; n < EXPRESSIONS; n++) {
        state[n] = state[0];
        set_expression(&state[n], expressions[n]);
        static const char *const names[EXPRESSIONS] = {"matcher 1", "matcher 2", "matcher 3"};
        work[n] = (struct work){.name = names[n],
                                .library = "PCRE2-JIT",
                                .about = expressions[n],
                                .bytes = TEXT,
                                .out_bytes = state->lines * sizeof(uint32_t),
                                .stride = MATCHER_STRIDE,
                                .text = &matcher_kernel,
                                .choice = &state[n].automaton,
                                .out = work_memory((LINES + KERNEL_ELEMENTS) * sizeof(uint32_t)),
                                .run = run,
                                .state = &state[n]};
    }
    return EXPRESSIONS;
}

/* One random expression on a few random lines. */
static unsigned compare_case(struct matcher_state *state, uint64_t *seed)
{
    static struct regex_expression expression;
    static uint8_t text[KERNEL_ELEMENTS * (REGEX_TEXT + 1) + 4];
    int32_t line[KERNEL_ELEMENTS];
    uint32_t found[KERNEL_ELEMENTS];
    size_t length[KERNEL_ELEMENTS], at = 0;
    unsigned differences = 0;
    regex_make(&expression, seed);
    set_expression(state, expression.text);
    for (int n = 0; n < KERNEL_ELEMENTS; n++) {
        line[n] = (int32_t)at;
        length[n] = regex_line(text + at, seed);
        at += length[n];
        text[at++] = '\n';
    }
    struct kernel *kernel = work_kernel(&matcher_kernel, &state->automaton, MATCHER_STRIDE);
    matcher_kernel_lines(kernel, &state->automaton, text, line, KERNEL_ELEMENTS, found);
    for (int n = 0; n < KERNEL_ELEMENTS; n++) {
        int expected = matches_library(state, text + line[n], length[n]);
        differences += expected >= 0 && found[n] != (uint32_t)expected;
    }
    if (differences)
        fprintf(stderr, "clients: PCRE2 differs on %s\n", expression.text);
    kernel_free(kernel);
    dfa_free(state->dfa);
    pcre2_match_data_free(state->data);
    pcre2_code_free(state->code);
    return differences != 0;
}

unsigned work_matcher_differences(unsigned cases)
{
    struct matcher_state *state = work_memory(sizeof *state);
    uint64_t seed = 1;
    unsigned differences = 0;
    for (unsigned n = 0; n < cases; n++)
        differences += compare_case(state, &seed);
    return differences;
}
