/* The texts that the command contains (embed.asm). */
#ifndef COMMAND_EXPLORE_EMBED_H
#define COMMAND_EXPLORE_EMBED_H

#include <string.h>

extern const char embed_page[], embed_style[], embed_script_model[], embed_script_panes[],
    embed_script_pictures[], embed_script_page[];

/* Pairs of a path from "spec/" on and a text, each ended by a zero byte; after the last an empty path. */
extern const char embed_spec[];

/* The text of a file of the specification, or null if there is none of that path. */
static inline const char *embed_spec_text(const char *path)
{
    for (const char *at = embed_spec; *at;) {
        const char *text = at + strlen(at) + 1;
        if (!strcmp(at, path))
            return text;
        at = text + strlen(text) + 1;
    }
    return NULL;
}

#endif
