#include "synonym.h"

#include <stddef.h>
#include <string.h>

/* Pairs of words of a state that have the same meaning. The words' common prefix is left out. `state` is the
 * beginning of the state's name. */
static const struct {
    const char *state, *ending, *other, *reason;
} synonyms[] = {
    {"shademode", "gouraud", "phong", "Direct3D 9 draws Phong shading as Gouraud shading"},
    {"srcblendalpha", "color", "alpha", "of alpha, the colour is alpha"},
    {"destblendalpha", "color", "alpha", "of alpha, the colour is alpha"},
    {"srcblendalpha", "color2", "alpha2", "of alpha, the second colour is alpha"},
    {"destblendalpha", "color2", "alpha2", "of alpha, the second colour is alpha"},
    {"srcblendalpha", "", "alpha", "of alpha, the constant colour is its alpha"},
    {"destblendalpha", "", "alpha", "of alpha, the constant colour is its alpha"},
    {"srcblendalpha", "one", "srcalphasat", "for alpha, the factor is 1"},
    {"destblendalpha", "one", "srcalphasat", "for alpha, the factor is 1"},
    {"alphaarg", "", "_alphareplicate", "alpha replicated is alpha"},
    {"magfilter", "none", "point", "no filter is the nearest texel"},
    {"minfilter", "none", "point", "no filter is the nearest texel"},
    {"magfilter", "linear", "anisotropic", "a magnified texel has no long side"},
};

enum { SYNONYMS = sizeof synonyms / sizeof *synonyms };

static bool synonym_needed[SYNONYMS];

bool synonym_are(const char *state, const char *a, const char *b)
{
    bool result = false;
    while (*a && *a == *b)
        a++, b++;
    for (unsigned i = 0; i < SYNONYMS; i++) {
        const char *x = synonyms[i].ending, *y = synonyms[i].other;
        bool same = (!strcmp(a, x) && !strcmp(b, y)) || (!strcmp(a, y) && !strcmp(b, x));
        if (same && !strncmp(state, synonyms[i].state, strlen(synonyms[i].state)))
            synonym_needed[i] = result = true;
    }
    return result;
}

const char *synonym_unneeded(void)
{
    for (unsigned i = 0; i < SYNONYMS; i++)
        if (!synonym_needed[i])
            return synonyms[i].reason;
    return NULL;
}
