#include "command/list/states.h"

#include "base/bits.h"
#include "command/support/table.h"
#include "triptych.h"

#include <ctype.h>
#include <string.h>

static const char *const support_word[] = {"yes", "not yet", "no"};
static const char *const table_title[] = {"render states", "sampler states", "texture stage states"};

enum { TEXT = 128 };

/* A value in the notation of streams. */
static const char *value_text(const struct triptych_kind *kind, uint32_t value, char text[TEXT])
{
    const char *word = triptych_value_word(kind, value);
    float number = bits_to_float(value);
    if (word)
        snprintf(text, TEXT, "%s", word);
    else if (kind->notation == TRIPTYCH_NOTATION_REAL)
        snprintf(text, TEXT, "%g", (double)number);
    else
        snprintf(text, TEXT, kind->notation == TRIPTYCH_NOTATION_HEXADECIMAL ? "0x%08x" : "%u", value);
    return text;
}

/* "A" if all defaults are equal, "A, then B" if the first sampler or stage differs from the rest, else "A, B,
 * C, ...". */
static const char *default_text(enum triptych_state_table table, unsigned row, char text[TEXT])
{
    const struct triptych_kind *kind = triptych_state_at(table, row)->kind;
    char value[3][TEXT];
    uint32_t number[3];
    for (unsigned i = 0; i < 3; i++) {
        number[i] = triptych_state_default(table, row, i);
        value_text(kind, number[i], value[i]);
    }
    if (number[0] == number[1])
        snprintf(text, TEXT, "%.40s", value[0]);
    else if (number[1] == number[2])
        snprintf(text, TEXT, "%.40s, then %.40s", value[0], value[1]);
    else
        snprintf(text, TEXT, "%.36s, %.36s, %.36s, ...", value[0], value[1], value[2]);
    return text;
}

/* The range of a kind without words. */
static const char *range_text(const struct triptych_kind *kind, char text[TEXT])
{
    if (kind->notation == TRIPTYCH_NOTATION_HEXADECIMAL)
        snprintf(text, TEXT, "0x and eight hexadecimal digits");
    else if (kind->notation == TRIPTYCH_NOTATION_NUMBER)
        snprintf(text, TEXT, "%.0f to %.0f", kind->first, kind->last);
    else
        snprintf(text, TEXT, "a finite number%s", kind->first < 0 ? "" : ", 0 or more");
    return text;
}

static unsigned count_states(enum triptych_state_table table, enum triptych_support support)
{
    const struct triptych_state_row *state;
    unsigned count = 0;
    for (unsigned row = 0; (state = triptych_state_at(table, row)); row++)
        count += state->support == support;
    return count;
}

/* --- For programs --- */

static void list_values(cJSON *object, const struct triptych_kind *kind)
{
    const struct triptych_value *value;
    cJSON *values = cJSON_AddArrayToObject(object, "values");
    for (unsigned i = 0; (value = triptych_value_at(kind, i)); i++) {
        cJSON *row = cJSON_CreateObject();
        cJSON_AddStringToObject(row, "word", value->word);
        cJSON_AddNumberToObject(row, "number", value->number);
        cJSON_AddStringToObject(row, "supported", support_word[value->support]);
        cJSON_AddItemToArray(values, row);
    }
}

static void list_state(cJSON *rows, enum triptych_state_table table, unsigned row)
{
    const struct triptych_state_row *state = triptych_state_at(table, row);
    char text[TEXT];
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "state", state->name);
    cJSON_AddStringToObject(object, "table", triptych_table_name(table));
    cJSON_AddNumberToObject(object, "number", state->number);
    cJSON_AddStringToObject(object, "kind", state->kind->name);
    if (triptych_value_at(state->kind, 0))
        list_values(object, state->kind);
    else
        cJSON_AddStringToObject(object, "range", range_text(state->kind, text));
    cJSON_AddStringToObject(object, "default", default_text(table, row, text));
    cJSON_AddStringToObject(object, "keys", state->units);
    cJSON_AddStringToObject(object, "supported", support_word[state->support]);
    cJSON_AddStringToObject(object, "test", state->test);
    cJSON_AddStringToObject(object, "meaning", state->meaning);
    cJSON_AddItemToArray(rows, object);
}

void states_list(cJSON *rows)
{
    for (unsigned t = 0; t < TRIPTYCH_STATE_TABLE_COUNT; t++)
        for (unsigned row = 0; triptych_state_at(t, row); row++)
            list_state(rows, t, row);
}

/* --- For people --- */

static void print_states(enum triptych_state_table t, FILE *out)
{
    static const char *const headings[] = {"state", "kind", "default", "keys", "supported", "meaning"};
    const struct triptych_state_row *state;
    struct table table = {0};
    char text[TEXT];
    for (unsigned i = 0; i < sizeof headings / sizeof *headings; i++)
        table_column(&table, headings[i], TABLE_LEFT);
    for (unsigned row = 0; (state = triptych_state_at(t, row)); row++) {
        table_cell(&table, "%s", state->name);
        table_cell(&table, "%s", state->kind->name);
        table_cell(&table, "%s", default_text(t, row, text));
        table_cell(&table, "%s", state->units);
        table_cell(&table, "%s", support_word[state->support]);
        table_cell(&table, "%s", state->meaning);
    }
    table_print(&table, 0, out);
    fputc('\n', out);
}

enum { LINE = 100, INDENT = 18 };

/* Prints a word after a space, on a new line if the current one is full. `column` is the length of the
 * current line. */
static void print_word(const char *word, size_t *column, FILE *out)
{
    if (*column + 1 + strlen(word) > LINE)
        *column = (size_t)fprintf(out, "\n%*s", INDENT - 1, "") - 1;
    *column += (size_t)fprintf(out, " %s", word);
}

/* Prints the line with a kind's words of one level of support. */
static void print_words(const char *heading, const struct triptych_kind *kind, enum triptych_support support,
                        FILE *out)
{
    const struct triptych_value *value;
    size_t column = (size_t)fprintf(out, "%-*s", INDENT - 1, support ? "" : kind->name);
    if (*heading)
        print_word(heading, &column, out);
    for (unsigned i = 0; (value = triptych_value_at(kind, i)); i++)
        if (value->support == support)
            print_word(value->word, &column, out);
    fputc('\n', out);
}

static unsigned count_values(const struct triptych_kind *kind, enum triptych_support support)
{
    const struct triptych_value *value;
    unsigned count = 0;
    for (unsigned i = 0; (value = triptych_value_at(kind, i)); i++)
        count += value->support == support;
    return count;
}

static void print_kinds(FILE *out)
{
    const struct triptych_kind *kind;
    char text[TEXT];
    fprintf(out, "%-*svalues\n", INDENT, "kind");
    for (unsigned i = 0; (kind = triptych_kind_at(i)); i++) {
        if (kind->notation != TRIPTYCH_NOTATION_WORDS) {
            fprintf(out, "%-*s%s\n", INDENT, kind->name, range_text(kind, text));
            continue;
        }
        print_words("", kind, TRIPTYCH_SUPPORT_YES, out);
        if (count_values(kind, TRIPTYCH_SUPPORT_LATER))
            print_words("not yet:", kind, TRIPTYCH_SUPPORT_LATER, out);
        if (count_values(kind, TRIPTYCH_SUPPORT_NEVER))
            print_words("not supported:", kind, TRIPTYCH_SUPPORT_NEVER, out);
    }
    fputc('\n', out);
}

void states_print(FILE *out)
{
    for (unsigned t = 0; t < TRIPTYCH_STATE_TABLE_COUNT; t++)
        print_states((enum triptych_state_table)t, out);
    print_kinds(out);
    for (unsigned t = 0; t < TRIPTYCH_STATE_TABLE_COUNT; t++) {
        unsigned count[TRIPTYCH_SUPPORT_NEVER + 1], all = 0;
        for (unsigned s = 0; s <= TRIPTYCH_SUPPORT_NEVER; s++)
            all += count[s] = count_states(t, s);
        fprintf(out, "%u %s, %u supported, %u not yet\n", all, table_title[t], count[TRIPTYCH_SUPPORT_YES],
                count[TRIPTYCH_SUPPORT_LATER]);
    }
}

/* The page docs/states.md. */

static const char introduction[] =
    "# States\n"
    "\n"
    "> **For:** all states of Direct3D 9: render states, sampler states and texture stage states.\n"
    "> **Read it** to look up a name, a value or what is supported. **Run** `build/triptych list\n"
    "> states`, which prints the same tables.\n"
    "\n"
    "Names are those of Direct3D 9 in small letters without prefix; numbers, values and defaults are\n"
    "the same. `triptych list states --markdown` writes this page from the tables `state.def`,\n"
    "`sampler_state.def`, `stage_state.def`, `kind.def` and `value.def` in `src/def/state/`. The\n"
    "API's validation and the [stream](streams.md) parser use the same tables.\n"
    "\n"
    "In C the state `cullmode` is `TRIPTYCH_STATE_CULLMODE`, the sampler state `minfilter`\n"
    "`TRIPTYCH_SAMPLER_MINFILTER`, and the stage state `colorop` `TRIPTYCH_STAGE_COLOROP`. The names of\n"
    "values are [below](#values). [library.md](library.md) describes the interface.\n"
    "\n"
    "- *Values*: the kind of value, listed [below](#values).\n"
    "- *Keys*: the routines whose code the state can change: V vertex, S setup, P pixel. *job* means\n"
    "  that routines read the value when they run. - means that the state has no effect. A change of\n"
    "  the pixel key can also change the setup and vertex keys, because values that pixels no longer\n"
    "  read are no longer computed; the column omits this. `tests/engines/specialize/audit.c` sets\n"
    "  every supported state to every value in dozens of situations and checks this column.\n"
    "- *Supported*: an unsupported state can only be set to its default. An unsupported value cannot\n"
    "  be set, even if its state is supported.\n"
    "- *Test*: a test of the state. Pictures of the streams are in `tests/data/goldens`.\n";

/* Prints the file's name as a link. */
static void print_test(const char *path, FILE *out)
{
    const char *name = strrchr(path, '/');
    if (name)
        fprintf(out, "[%s](../tests/%s)", name + 1, path);
}

static void print_states_markdown(enum triptych_state_table t, FILE *out)
{
    const struct triptych_state_row *state;
    char text[TEXT];
    fprintf(out, "\n## %c%s\n\n", table_title[t][0] - 'a' + 'A', table_title[t] + 1);
    if (triptych_table_size(t) > 1)
        fprintf(out, "Each of the %u has its own.\n\n", triptych_table_size(t));
    fputs("| State | Number | Values | Default | Keys | Supported | Test | Meaning |\n"
          "| --- | --- | --- | --- | --- | --- | --- | --- |\n",
          out);
    for (unsigned row = 0; (state = triptych_state_at(t, row)); row++) {
        fprintf(out, "| `%s` | %u | %s | %s | %s | %s | ", state->name, state->number, state->kind->name,
                default_text(t, row, text), state->units, support_word[state->support]);
        print_test(state->test, out);
        fprintf(out, " | %s |\n", state->meaning);
    }
}

/* The name of a value in the header. */
static const char *header_name(const struct triptych_value *value, char text[TEXT])
{
    int length = snprintf(text, TEXT, "TRIPTYCH_%s_%s", value->kind->prefix, value->word);
    for (int i = 0; i < length && i < TEXT; i++)
        text[i] = (char)toupper((unsigned char)text[i]);
    return text;
}

static void print_kinds_markdown(FILE *out)
{
    const struct triptych_kind *kind;
    const struct triptych_value *value;
    char text[TEXT];
    fputs("\n## Values\n\n| Kind | Value | Number | Supported | In C |\n| --- | --- | --- | --- | --- |\n",
          out);
    for (unsigned k = 0; (kind = triptych_kind_at(k)); k++) {
        if (!triptych_value_at(kind, 0))
            fprintf(out, "| %s | %s | | | |\n", kind->name, range_text(kind, text));
        for (unsigned i = 0; (value = triptych_value_at(kind, i)); i++)
            fprintf(out, "| %s | `%s` | %u | %s | `%s` |\n", i ? "" : kind->name, value->word, value->number,
                    support_word[value->support], header_name(value, text));
    }
}

void states_print_markdown(FILE *out)
{
    fputs(introduction, out);
    for (unsigned t = 0; t < TRIPTYCH_STATE_TABLE_COUNT; t++)
        print_states_markdown((enum triptych_state_table)t, out);
    print_kinds_markdown(out);
}
