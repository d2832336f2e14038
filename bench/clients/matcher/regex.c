#include "bench/clients/matcher/regex.h"

#include <stdio.h>
#include <string.h>

uint32_t regex_below(uint64_t *seed, uint32_t limit)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((*seed >> 33) % limit);
}

/* --- Trees ---------------------------------------------------------------------------------------------- */

/* The characters that can be drawn: few, so that random texts match. */
static const struct {
    const char *text;
    const char *ranges; /* pairs of bytes */
    bool negated;
} character[] = {
    {"a", "aa", false},
    {"b", "bb", false},
    {"c", "cc", false},
    {"a", "aa", false},
    {"b", "bb", false},
    {".", "", true},
    {"[ab]", "ab", false},
    {"[^a]", "aa", true},
    {"[b-d]", "bd", false},
    {"\\d", "09", false},
    {"\\D", "09", true},
    {"\\w", "azAZ09__", false},
    {"\\W", "azAZ09__", true},
    {"\\s", "\t\r  ", false},
    {"\\S", "\t\r  ", true},
    {"\\.", "..", false},
    {"[^\\d.x]", "09..xx", true},
    {"\\x41", "AA", false},
    {"[\\wz-~]", "azAZ09__z~", false},
};

static int make_character(struct regex_expression *x, uint64_t *seed)
{
    uint32_t n = regex_below(seed, sizeof character / sizeof character[0]);
    struct regex_node *node = &x->node[x->nodes];
    memset(node, 0, sizeof *node);
    snprintf(node->text, sizeof node->text, "%s", character[n].text);
    for (const char *range = character[n].ranges; *range; range += 2)
        memset(node->in + range[0], 1, (size_t)(range[1] - range[0] + 1));
    for (int byte = 0; byte < 256; byte++)
        node->in[byte] ^= character[n].negated;
    return x->nodes++;
}

static int make_node(struct regex_expression *x, int depth, uint64_t *seed)
{
    uint32_t kind = regex_below(seed, 8);
    if (!depth || kind < 2 || x->nodes > REGEX_NODES - 12)
        return make_character(x, seed);
    struct regex_node node = {.kind = kind < 5 ? NODE_SEQUENCE : kind < 6 ? NODE_CHOICE : NODE_REPEAT};
    node.left = make_node(x, depth - 1, seed);
    if (node.kind != NODE_REPEAT)
        node.right = make_node(x, depth - 1, seed);
    static const int times[][2] = {{0, -1}, {1, -1}, {0, 1}, {2, 2}, {1, 3}, {2, -1}, {0, 2}, {0, 0}};
    uint32_t n = regex_below(seed, 8);
    node.least = times[n][0];
    node.most = times[n][1];
    x->node[x->nodes] = node;
    return x->nodes++;
}

/* --- Text ----------------------------------------------------------------------------------------------- */

static void add(struct regex_expression *x, const char *text)
{
    int written = snprintf(x->text + x->length, sizeof x->text - x->length, "%s", text);
    x->length += (size_t)written;
    if (x->length >= sizeof x->text)
        x->length = sizeof x->text - 1;
}

static void print_times(struct regex_expression *x, int least, int most)
{
    char text[24];
    if (most < 0 && least < 2)
        snprintf(text, sizeof text, "%s", least ? "+" : "*");
    else if (least == 0 && most == 1)
        snprintf(text, sizeof text, "?");
    else if (least == most)
        snprintf(text, sizeof text, "{%d}", least);
    else if (most < 0)
        snprintf(text, sizeof text, "{%d,}", least);
    else
        snprintf(text, sizeof text, "{%d,%d}", least, most);
    add(x, text);
}

static void print_node(struct regex_expression *x, int number)
{
    const struct regex_node *node = &x->node[number];
    if (node->kind == NODE_CHARACTER) {
        add(x, node->text);
        return;
    }
    add(x, node->kind == NODE_CHOICE ? "(" : "(?:");
    print_node(x, node->left);
    if (node->kind == NODE_CHOICE)
        add(x, "|");
    if (node->kind != NODE_REPEAT)
        print_node(x, node->right);
    add(x, ")");
    if (node->kind == NODE_REPEAT)
        print_times(x, node->least, node->most);
}

/* The positions of the automaton: a repetition repeats those of its part. */
static int count_positions(const struct regex_expression *x, int number)
{
    const struct regex_node *node = &x->node[number];
    if (node->kind == NODE_CHARACTER)
        return 1;
    int left = count_positions(x, node->left);
    if (node->kind != NODE_REPEAT)
        return left + count_positions(x, node->right);
    int copies = node->most > node->least ? node->most : node->least;
    return left * (copies > 1 ? copies : 1);
}

static void make(struct regex_expression *x, uint64_t *seed)
{
    memset(x, 0, sizeof *x);
    x->from_start = regex_below(seed, 4) == 0;
    x->to_end = regex_below(seed, 4) == 0;
    x->root = make_node(x, 1 + (int)regex_below(seed, 5), seed);
    add(x, x->from_start ? "^" : "");
    print_node(x, x->root);
    add(x, x->to_end ? "$" : "");
}

void regex_make(struct regex_expression *x, uint64_t *seed)
{
    do
        make(x, seed);
    while (count_positions(x, x->root) > REGEX_POSITIONS || x->length == sizeof x->text - 1);
}

size_t regex_line(uint8_t text[REGEX_TEXT], uint64_t *seed)
{
    static const char often[] = "aaabbbccd01 .xA_~\t";
    size_t bytes = regex_below(seed, 4) ? regex_below(seed, 12) : regex_below(seed, REGEX_TEXT);
    for (size_t i = 0; i < bytes; i++) {
        text[i] = (uint8_t)often[regex_below(seed, sizeof often - 1)];
        if (regex_below(seed, 20) == 0)
            text[i] = (uint8_t)regex_below(seed, 256);
        if (text[i] == '\n' || !text[i])
            text[i] = 'a';
    }
    return bytes;
}

/* --- Definition ----------------------------------------------------------------------------------------- */

struct subject {
    const struct regex_expression *x;
    const uint8_t *text;
    size_t bytes;
};

static uint64_t ends(const struct subject *s, int number, uint64_t begins);

static uint64_t ends_repeat(const struct subject *s, const struct regex_node *node, uint64_t begins)
{
    uint64_t now = begins, all = node->least ? 0 : begins;
    int most = node->most < 0 ? node->least + REGEX_TEXT : node->most;
    for (int n = 1; n <= most && now; n++) {
        now = ends(s, node->left, now);
        if (n >= node->least)
            all |= now;
    }
    return all;
}

/* The places at which a match can end that begins at one of the places `begins`. */
static uint64_t ends(const struct subject *s, int number, uint64_t begins)
{
    const struct regex_node *node = &s->x->node[number];
    uint64_t after = 0;
    switch (node->kind) {
    case NODE_SEQUENCE: return ends(s, node->right, ends(s, node->left, begins));
    case NODE_CHOICE: return ends(s, node->left, begins) | ends(s, node->right, begins);
    case NODE_REPEAT: return ends_repeat(s, node, begins);
    default:
        for (size_t i = 0; i < s->bytes; i++)
            if (begins >> i & 1 && node->in[s->text[i]])
                after |= 2ull << i;
        return after;
    }
}

bool regex_matches(const struct regex_expression *x, const uint8_t *text, size_t bytes)
{
    const struct subject subject = {x, text, bytes};
    uint64_t begins = x->from_start ? 1 : (2ull << bytes) - 1;
    uint64_t found = ends(&subject, x->root, begins);
    return x->to_end ? found >> bytes & 1 : found != 0;
}
