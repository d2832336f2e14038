/* The program of lab 15's check.
 *
 *   check rules                 balance_count with single instructions
 *   check count <LISTING        prints the needs of a listing: instructions, arithmetic, loads, stores
 *   check block                 balance_block_ns and balance_bottleneck
 *   check frame                 balance_frame_ms
 *   check bound RATES <LISTING  prints the bottleneck, and the nanoseconds of a pixel; RATES: five numbers
 *   check time RATES FRAME <LISTING  prints the ms of a frame; FRAME: pixels layers bytes threads cores
 *
 * Ends with 1, after a line with what was expected, if something is wrong; with 2 if it is used wrongly. */
#include "balance.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const names[RESOURCES] = {"instructions", "arithmetic", "loads", "stores"};

/* --- Rules --- */

struct rule {
    const char *text;
    struct needs needs;
};

static const struct rule rules[] = {
    {"vaddps ymm1, ymm2, ymm3", {{1, 1, 0, 0}}},
    {"vfmadd231ps ymm3, ymm2, [rsp+0x80]", {{1, 1, 1, 0}}},
    {"vmovups ymm3, [rcx+0x80]", {{1, 0, 1, 0}}},
    {"vmovups [r9], ymm1", {{1, 0, 0, 1}}},
    {"vmovaps ymm3, ymm1", {{1, 0, 0, 0}}},
    {"mov dword ptr [rsp+0x4], 0x9fc0", {{1, 0, 0, 1}}},
    {"mov eax, [rsi+0xc]", {{1, 0, 1, 0}}},
    {"movsxd r12, dword ptr [rsp+0x40]", {{1, 0, 1, 0}}},
    {"vbroadcastss ymm0, dword ptr [rdx+0x24]", {{1, 0, 1, 0}}},
    {"vmovhps xmm1, xmm1, [rax+r13*4]", {{1, 0, 1, 0}}},
    {"vinsertf128 ymm1, ymm1, xmm14, 0x1", {{1, 0, 0, 0}}},
    {"vshufps ymm1, ymm1, ymm15, 0x88", {{1, 0, 0, 0}}},
    {"vpsrlw ymm5, ymm5, 0x8", {{1, 1, 0, 0}}},
    {"vtestps ymm0, ymm0", {{1, 1, 0, 0}}},
    {"vcvtps2dq ymm4, [rsp]", {{1, 1, 1, 0}}},
    {"add r9, 0x20", {{1, 0, 0, 0}}},
    {"add rdx, [rdi+0x10]", {{1, 0, 1, 0}}},
    {"lea rax, [rax+rax*4]", {{1, 0, 0, 0}}},
    {"jnz 0xc4", {{1, 0, 0, 0}}},
    {"vstmxcsr [rsp]", {{1, 0, 0, 1}}},
    {"vldmxcsr [rsp+0x4]", {{1, 0, 1, 0}}},
    {"nop [rax], eax", {{0, 0, 0, 0}}},
};

static int check_rules(void)
{
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
        struct needs needs = {{5, 5, 5, 5}};
        balance_count(&needs, rules[i].text);
        for (int r = 0; r < RESOURCES; r++)
            if (needs.count[r] != 5 + rules[i].needs.count[r]) {
                printf("%s: %d %s, expected %u\n", rules[i].text, (int)needs.count[r] - 5, names[r],
                       rules[i].needs.count[r]);
                return 1;
            }
    }
    return 0;
}

/* --- Time --- */

static const struct rates some_rates = {{12, 6, 8, 3}, 10};
static const struct needs by_instructions = {{120, 30, 40, 6}}, by_arithmetic = {{60, 48, 16, 3}},
                          by_loads = {{96, 12, 96, 3}}, by_stores = {{24, 6, 8, 9}};

static int check_row(const struct needs *needs, enum resource resource, double ns)
{
    double found = balance_block_ns(needs, &some_rates);
    enum resource bottleneck = balance_bottleneck(needs, &some_rates);
    if (fabs(found - ns) > 1e-6)
        printf("a block of %u instructions, %u arithmetic, %u loads, %u stores: %g ns, expected %g\n",
               needs->count[0], needs->count[1], needs->count[2], needs->count[3], found, ns);
    else if (bottleneck != resource)
        printf("a block of %u instructions, %u arithmetic, %u loads, %u stores: bottleneck %d, expected %s\n",
               needs->count[0], needs->count[1], needs->count[2], needs->count[3], (int)bottleneck,
               names[resource]);
    else
        return 0;
    return 1;
}

static int check_block(void)
{
    return check_row(&by_instructions, INSTRUCTIONS, 10) || check_row(&by_arithmetic, ARITHMETIC, 8) ||
           check_row(&by_loads, LOADS, 12) || check_row(&by_stores, STORES, 3);
}

struct frame_row {
    struct frame frame;
    const struct needs *needs;
    double ms;
};

static const struct frame_row frame_rows[] = {
    {{1e6, 1, 8, 1, 4}, &by_instructions, 1.25}, {{1e6, 4, 8, 1, 4}, &by_instructions, 5},
    {{1e6, 4, 8, 2, 4}, &by_instructions, 2.5},  {{1e6, 4, 8, 8, 4}, &by_instructions, 1.25},
    {{1e6, 1, 12, 1, 4}, &by_stores, 1.2},       {{1e6, 1, 12, 4, 4}, &by_stores, 1.2},
    {{1e6, 4, 12, 1, 4}, &by_stores, 1.5},       {{1e6, 8, 12, 4, 4}, &by_stores, 1.2},
    {{2e6, 1, 8, 3, 2}, &by_loads, 1.6},         {{2e6, 3, 8, 1, 2}, &by_loads, 9},
};

static int check_frame(void)
{
    for (size_t i = 0; i < sizeof frame_rows / sizeof *frame_rows; i++) {
        const struct frame_row *row = frame_rows + i;
        double ms = balance_frame_ms(&row->frame, row->needs, &some_rates);
        if (fabs(ms - row->ms) > 1e-6) {
            printf("%g pixels, %u layers, %g bytes, %u threads on %u cores: %g ms, expected %g\n",
                   row->frame.pixels, row->frame.layers, row->frame.bytes, row->frame.threads,
                   row->frame.cores, ms, row->ms);
            return 1;
        }
    }
    return 0;
}

/* --- Listings --- */

static struct needs read_listing(void)
{
    char line[256];
    struct needs needs = {0};
    while (fgets(line, sizeof line, stdin)) {
        line[strcspn(line, "\n")] = 0;
        balance_count(&needs, line);
    }
    return needs;
}

static int print_count(void)
{
    struct needs needs = read_listing();
    printf("%u %u %u %u\n", needs.count[INSTRUCTIONS], needs.count[ARITHMETIC], needs.count[LOADS],
           needs.count[STORES]);
    return 0;
}

static struct rates read_rates(char **text)
{
    struct rates rates;
    for (int r = 0; r < RESOURCES; r++)
        rates.each[r] = atof(text[r]);
    rates.memory = atof(text[RESOURCES]);
    return rates;
}

static int print_bound(char **text)
{
    struct rates rates = read_rates(text);
    struct needs needs = read_listing();
    printf("%s %.2f\n", names[balance_bottleneck(&needs, &rates)],
           balance_block_ns(&needs, &rates) / BLOCK_PIXELS);
    return 0;
}

static int print_time(char **text)
{
    struct rates rates = read_rates(text);
    struct needs needs = read_listing();
    struct frame frame = {atof(text[5]), (unsigned)atoi(text[6]), atof(text[7]), (unsigned)atoi(text[8]),
                          (unsigned)atoi(text[9])};
    printf("%.2f\n", balance_frame_ms(&frame, &needs, &rates));
    return 0;
}

int main(int count, char **argument)
{
    const char *command = count > 1 ? argument[1] : "";
    return !strcmp(command, "rules")                 ? check_rules()
           : !strcmp(command, "count")               ? print_count()
           : !strcmp(command, "block")               ? check_block()
           : !strcmp(command, "frame")               ? check_frame()
           : !strcmp(command, "bound") && count == 7 ? print_bound(argument + 2)
           : !strcmp(command, "time") && count == 12 ? print_time(argument + 2)
                                                     : 2;
}
