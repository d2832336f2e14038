#include "attributes.h"

/* No attribute has this name. */
enum { NO_ATTRIBUTE = -1 };

const EGLAttrib *egl_list_widen(struct egl_list *list, const EGLint *words)
{
    unsigned count = 0;
    while (words && count < 2 * EGL_PAIRS && words[count] != EGL_NONE) {
        list->word[count] = words[count];
        list->word[count + 1] = words[count + 1];
        count += 2;
    }
    if (words && count == 2 * EGL_PAIRS && words[count] != EGL_NONE)
        list->word[0] = NO_ATTRIBUTE;
    list->word[count] = EGL_NONE;
    return list->word;
}
