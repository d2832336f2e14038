/* How vertices are bound: all of a resource, element by element, in streams by a declaration or by the code
 * of a vertex format. */
#include "command/fuzz/case/case_part.h"

#include "capture/word.h"
#include "command/stream/stream.h"
#include "contract/key.h"

void case_add_elements(struct maker *maker, const struct case_element *elements, unsigned count)
{
    for (unsigned e = 0; e < count; e++)
        text_add(maker->text, " %s:%s", word_text(WORDS_ATTRIBUTE, elements[e].number),
                 word_text(WORDS_FORMAT, elements[e].format));
}

static unsigned bytes_of(const struct case_element *elements, unsigned count)
{
    unsigned bytes = 0;
    for (unsigned e = 0; e < count; e++)
        bytes += key_vertex_types[elements[e].format].bytes;
    return bytes;
}

unsigned case_stride(const struct maker *maker, const struct case_element *elements, unsigned count)
{
    unsigned bytes = bytes_of(elements, count);
    return maker->wild ? (bytes + 3) & -4u : bytes;
}

/* --- Codes of vertex formats ---------------------------------------------------------------------------- */

static enum triptych_format floats(unsigned count)
{
    return (enum triptych_format)(TRIPTYCH_FORMAT_FLOAT1 + count - 1);
}

/* Positions, with weights and indices. */
static unsigned add_coded_position(struct maker *maker, struct case_element *elements)
{
    struct random *random = &maker->random;
    if (maker->window) {
        elements[0] = (struct case_element){TRIPTYCH_POSITIONT, TRIPTYCH_FORMAT_FLOAT4};
        return 1;
    }
    elements[0] = (struct case_element){TRIPTYCH_POSITION, floats(3 + random_below(random, 2))};
    if (elements[0].format == TRIPTYCH_FORMAT_FLOAT4 || !random_chance(random, 3))
        return 1;
    unsigned weights = 1 + random_below(random, 4);
    elements[1] = (struct case_element){TRIPTYCH_WEIGHTS, floats(weights)};
    if (random_chance(random, 2))
        return 2;
    elements[2] = (struct case_element){TRIPTYCH_INDICES, TRIPTYCH_FORMAT_UBYTE4};
    return 3;
}

unsigned case_coded_elements(struct maker *maker, struct case_element elements[CASE_ELEMENTS])
{
    static const struct case_element others[] = {{TRIPTYCH_NORMAL, TRIPTYCH_FORMAT_FLOAT3},
                                                 {TRIPTYCH_POINT_SIZE, TRIPTYCH_FORMAT_FLOAT1},
                                                 {TRIPTYCH_DIFFUSE, TRIPTYCH_FORMAT_COLOR},
                                                 {TRIPTYCH_SPECULAR, TRIPTYCH_FORMAT_COLOR}};
    struct random *random = &maker->random;
    unsigned count = add_coded_position(maker, elements), sets = random_below(random, 5);
    for (unsigned i = 0; i < sizeof others / sizeof *others; i++)
        if (random_chance(random, 2))
            elements[count++] = others[i];
    for (unsigned i = 0; i < sets; i++)
        elements[count++] = (struct case_element){TRIPTYCH_TEXCOORD + i, floats(1 + random_below(random, 4))};
    return count;
}

static unsigned components_of(const struct case_element *elements, unsigned count, unsigned number)
{
    for (unsigned e = 0; e < count; e++)
        if (elements[e].number == number)
            return key_vertex_types[elements[e].format].components;
    return 0;
}

static void add_code_of_position(struct maker *maker, const struct case_element *elements, unsigned count)
{
    unsigned weights = components_of(elements, count, TRIPTYCH_WEIGHTS);
    bool indices = components_of(elements, count, TRIPTYCH_INDICES) > 0;
    if (elements[0].number == TRIPTYCH_POSITIONT)
        text_add(maker->text, "fvf xyzrhw");
    else if (!weights)
        text_add(maker->text, elements[0].format == TRIPTYCH_FORMAT_FLOAT4 ? "fvf xyzw" : "fvf xyz");
    else
        text_add(maker->text, indices ? "fvf xyzb%u lastbeta_ubyte4" : "fvf xyzb%u", weights + indices);
}

/* The code whose elements these are. */
static void add_code(struct maker *maker, const struct case_element *elements, unsigned count)
{
    static const struct {
        unsigned number;
        const char *word;
    } others[] = {{TRIPTYCH_NORMAL, "normal"},
                  {TRIPTYCH_POINT_SIZE, "psize"},
                  {TRIPTYCH_DIFFUSE, "diffuse"},
                  {TRIPTYCH_SPECULAR, "specular"}};
    unsigned sets = 0;
    add_code_of_position(maker, elements, count);
    for (unsigned i = 0; i < sizeof others / sizeof *others; i++)
        if (components_of(elements, count, others[i].number))
            text_add(maker->text, " %s", others[i].word);
    while (components_of(elements, count, TRIPTYCH_TEXCOORD + sets))
        sets++;
    if (sets)
        text_add(maker->text, " tex%u", sets);
    for (unsigned i = 0; i < sets; i++) {
        unsigned components = components_of(elements, count, TRIPTYCH_TEXCOORD + i);
        if (components != 2)
            text_add(maker->text, " size%u_%u", components, i);
    }
    text_add(maker->text, "\n");
}

/* --- Streams -------------------------------------------------------------------------------------------- */

/* The elements of a stream from the last to the first, each at its place. */
static void add_places(struct maker *maker, const struct case_element *elements, unsigned count)
{
    for (unsigned e = count; e--;) {
        case_add_elements(maker, elements + e, 1);
        text_add(maker->text, "@%u", bytes_of(elements, e));
    }
}

static void declare(struct maker *maker, const struct case_element *elements, const unsigned part[2])
{
    void (*add)(struct maker *, const struct case_element *, unsigned) =
        random_chance(&maker->random, 4) ? add_places : case_add_elements;
    text_add(maker->text, "declare");
    add(maker, elements, part[0]);
    if (part[1])
        text_add(maker->text, " 1");
    add(maker, elements + part[0], part[1]);
    text_add(maker->text, "\n");
}

/* Each part of the elements in a stream of its own. The first one begins after the skipped vertices. */
static void bind_streams(struct maker *maker, const struct case_element *elements, const unsigned part[2],
                         unsigned skip)
{
    if (maker->coded)
        add_code(maker, elements, part[0]);
    else
        declare(maker, elements, part);
    maker->stride = case_stride(maker, elements, part[0]);
    text_add(maker->text, "bind stream 0 v0 %u %u\n", skip * maker->stride, maker->stride);
    if (part[1])
        text_add(maker->text, "bind stream 1 v1 0 %u\n", case_stride(maker, elements + part[0], part[1]));
}

/* --- Elements ------------------------------------------------------------------------------------------- */

/* Elements that only shaders read need a declaration. */
static bool may_bind_elements(const struct case_element *elements, unsigned count)
{
    for (unsigned e = 0; e < count; e++)
        if (elements[e].number > ELEMENT_ATTRIBUTES)
            return false;
    return true;
}

/* With a stride of 0 all vertices have the value of the first. */
static void bind_elements(struct maker *maker, const struct case_element *elements, unsigned count)
{
    unsigned stride = bytes_of(elements, count);
    for (unsigned e = 0; e < count; e++)
        text_add(maker->text, "bind element %s %s v0 %u %u\n", word_text(WORDS_ATTRIBUTE, elements[e].number),
                 word_text(WORDS_FORMAT, elements[e].format), bytes_of(elements, e),
                 e && random_chance(&maker->random, 6) ? 0 : stride);
}

/* --- The choice ----------------------------------------------------------------------------------------- */

static bool uses_streams(const struct maker *maker, const unsigned part[2])
{
    return part[1] || maker->wild || maker->coded;
}

unsigned case_bind_skip(struct maker *maker, const unsigned part[2])
{
    return uses_streams(maker, part) && random_chance(&maker->random, 6) ? 1 : 0;
}

void case_bind(struct maker *maker, const struct case_element *elements, const unsigned part[2],
               unsigned skip)
{
    if (uses_streams(maker, part))
        bind_streams(maker, elements, part, skip);
    else if (may_bind_elements(elements, part[0]) && random_chance(&maker->random, 6))
        bind_elements(maker, elements, part[0]);
    else
        text_add(maker->text, "bind vertices v0\n");
}
