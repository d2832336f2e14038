/* The inputs of the fixed function: transforms, material, lights, clip planes, conventions. */
#include "command/fuzz/case/case_part.h"

/* Returns true if the matrix holds anything. */
static bool add_matrix(struct maker *maker)
{
    struct random *random = &maker->random;
    switch (random_below(random, maker->wild ? 6 : 5)) {
    case 0: text_add(maker->text, " identity\n"); return false;
    case 1: text_add(maker->text, " rotate %d 0 0 1 translate", random_between(random, -180, 180)); break;
    case 2:
        text_add(maker->text, " scale %.9g 0.75 1 translate", (double)random_float(random, 0.5f, 1.5f));
        break;
    case 3:
        text_add(maker->text, " rotate %d", random_between(random, -60, 60));
        case_numbers(maker, 2, -1, 1);
        text_add(maker->text, " 1\n");
        return false;
    case 4: text_add(maker->text, " translate"); break;
    default:
        text_add(maker->text, " matrix");
        for (int i = 0; i < 16; i++)
            if (random_chance(random, 6))
                text_add(maker->text, " %.9g", (double)wild_float(random));
            else
                case_number(maker, -1, 1);
        text_add(maker->text, "\n");
        return true;
    }
    case_numbers(maker, 3, -0.25f, 0.25f);
    text_add(maker->text, "\n");
    return false;
}

void case_transforms(struct maker *maker)
{
    struct random *random = &maker->random;
    static const char *const common[] = {"world", "view", "world 1", "world 2", "world 3"};
    for (unsigned i = 0; i < sizeof common / sizeof *common; i++)
        if (random_chance(random, 4)) {
            text_add(maker->text, "transform %s", common[i]);
            maker->huge |= add_matrix(maker) && i < 2;
        }
    for (unsigned i = 0; i < maker->stages; i++)
        if (random_chance(random, 3)) {
            text_add(maker->text, "transform texture %u", i);
            add_matrix(maker);
        }
    if (random_chance(random, 4))
        text_add(maker->text,
                 "transform projection perspective %d 1 0.25 8\ntransform view translate 0 0 %d\n",
                 random_between(random, 30, 120), random_between(random, 1, 3));
}

/* --- Light ---------------------------------------------------------------------------------------------- */

static void add_field(struct maker *maker, const char *name, unsigned count, float least, float most)
{
    if (random_chance(&maker->random, 3))
        return;
    text_add(maker->text, " %s", name);
    case_numbers(maker, count, least, most);
}

static void add_place(struct maker *maker)
{
    add_field(maker, "position", 3, -2, 2);
    add_field(maker, "range", 1, 0, 6);
    add_field(maker, "attenuation", 3, 0, 2);
}

/* The angles of a spot are in order. */
static void add_cone(struct maker *maker)
{
    float phi = random_float(&maker->random, 0.125f, 3);
    text_add(maker->text, " theta %.9g phi %.9g", (double)random_float(&maker->random, 0, phi), (double)phi);
    add_field(maker, "falloff", 1, 0, 3);
}

static void add_light(struct maker *maker, unsigned i)
{
    static const char *const type[] = {"directional", "point", "spot"};
    unsigned which = random_below(&maker->random, 3);
    text_add(maker->text, "light %u %s", i, type[which]);
    add_field(maker, "diffuse", 4, 0, 1.5f);
    add_field(maker, "ambient", 4, 0, 0.5f);
    add_field(maker, "specular", 4, 0, 1);
    if (which != 0)
        add_place(maker);
    if (which != 1)
        add_field(maker, "direction", 3, -1, 1);
    if (which == 2)
        add_cone(maker);
    text_add(maker->text, "\nlight %u on\n", i);
}

void case_lights(struct maker *maker)
{
    if (random_chance(&maker->random, 2)) {
        text_add(maker->text, "state lighting false\n");
        return;
    }
    text_add(maker->text, "material");
    add_field(maker, "diffuse", 4, 0, 1);
    add_field(maker, "ambient", 4, 0, 1);
    add_field(maker, "specular", 4, 0, 1);
    add_field(maker, "emissive", 4, 0, 0.5f);
    add_field(maker, "power", 1, 0, 20);
    text_add(maker->text, "\n");
    for (unsigned i = 0; i < TRIPTYCH_LIGHTS; i++)
        if (random_chance(&maker->random, 4))
            add_light(maker, i);
}

void case_lights_off(struct maker *maker)
{
    text_add(maker->text, "light %u off\n", random_below(&maker->random, TRIPTYCH_LIGHTS));
}

/* --- Clip planes, conventions, parts of the target ------------------------------------------------------ */

static void add_rectangle(struct maker *maker, const char *name)
{
    unsigned x = random_below(&maker->random, maker->width), y = random_below(&maker->random, maker->height);
    text_add(maker->text, "%s %u %u %u %u", name, x, y, 1 + random_below(&maker->random, maker->width - x),
             1 + random_below(&maker->random, maker->height - y));
}

/* A side of a viewport that may lie outside of the target: often near its edges, sometimes far away. */
static void add_side(struct maker *maker, unsigned length, float *from, float *side)
{
    struct random *random = &maker->random;
    float scale = random_chance(random, 8) ? random_float(random, 1, 1e5f) : 1;
    *from = random_float(random, -1, 1) * (float)length * scale;
    *side = random_chance(random, 16) ? 0 : random_float(random, 0, 3) * (float)length * scale;
}

static void add_viewport(struct maker *maker)
{
    struct random *random = &maker->random;
    float near = random_float(random, 0, 1), x, y, width, height;
    if (random_chance(random, 2)) {
        add_rectangle(maker, "viewport");
    } else {
        add_side(maker, maker->width, &x, &width);
        add_side(maker, maker->height, &y, &height);
        text_add(maker->text, "viewport %.9g %.9g %.9g %.9g", (double)x, (double)y, (double)width,
                 (double)height);
    }
    text_add(maker->text, " %.9g %.9g\n", (double)near,
             (double)(random_chance(random, 8) ? near : random_float(random, 0, 1)));
}

static void add_scissor(struct maker *maker)
{
    struct random *random = &maker->random;
    text_add(maker->text, "state scissortestenable true\n");
    if (random_chance(random, 3))
        text_add(maker->text, "scissor %u %u %u %u", random_below(random, 2 * maker->width),
                 random_below(random, 2 * maker->height), random_below(random, TRIPTYCH_TARGET_MAXIMUM + 1),
                 random_below(random, 2 * maker->height));
    else
        add_rectangle(maker, "scissor");
    text_add(maker->text, "\n");
}

static void add_conventions(struct maker *maker)
{
    static const struct {
        unsigned odds;
        const char *text;
    } rare[] = {{8, "pixelcenter integer"},    {8, "depthrange minus"},     {4, "multiply legacy"},
                {8, "windoworigin lower"},     {8, "pointclip depth"},      {8, "pointclip center"},
                {8, "depthbiasunit smallest"}, {6, "provokingvertex last"}, {4, "cubeaddress sampler"},
                {4, "magnifylimit half"},      {8, "spriteorigin last"}};
    for (unsigned i = 0; i < sizeof rare / sizeof *rare; i++)
        if (random_chance(&maker->random, rare[i].odds))
            text_add(maker->text, "convention %s\n", rare[i].text);
}

/* A mask of its own, of random size and place, and a box that may be empty. */
static void add_clip_mask(struct maker *maker)
{
    static const char *const formats[] = {"A8", "L8", "R8"};
    struct random *random = &maker->random;
    unsigned width = 1 + random_below(random, 20), height = 1 + random_below(random, 20);
    text_add(maker->text, "texture cm 2d %s %u %u checker %u", formats[random_below(random, 3)], width,
             height, 1 + random_below(random, 3));
    case_color(maker);
    case_color(maker);
    text_add(maker->text, "\nclipmask cm %d %d %u %u %u %u\n", (int)random_below(random, 12) - 6,
             (int)random_below(random, 12) - 6, random_below(random, 4), random_below(random, 4),
             random_below(random, 24), random_below(random, 24));
}

void case_window(struct maker *maker)
{
    struct random *random = &maker->random;
    if (random_chance(random, 5))
        add_viewport(maker);
    if (random_chance(random, 5))
        add_scissor(maker);
    if (random_chance(random, 8))
        add_clip_mask(maker);
    add_conventions(maker);
    if (!random_chance(random, 6))
        return;
    text_add(maker->text, "state clipplaneenable %u\n", random_below(random, 64));
    for (unsigned i = 0; i < TRIPTYCH_CLIP_PLANES; i++) {
        text_add(maker->text, "clipplane %u", i);
        case_numbers(maker, 4, -1, 1.5f);
        text_add(maker->text, "\n");
    }
}
