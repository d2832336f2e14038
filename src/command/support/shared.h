/* Options that several commands have. The rows have a member of the command's settings. */
#ifndef COMMAND_SUPPORT_SHARED_H
#define COMMAND_SUPPORT_SHARED_H

#include "command/stream/stream.h"
#include "command/support/choose.h"
#include "command/support/command.h"
#include "image/png.h"
#include "setting/setting.h"

/* unsigned: the level of PNG files; PNG_LEVEL_DEFAULT is its default. */
#define OPTION_COMPRESSION(structure, member)                                                                \
    {                                                                                                        \
        "compression", "LEVEL", "of PNG files: 0 stores, 1 is fast, 9 is small; 1",                          \
            OPTION_IS_NUMBER(structure, member), .most = PNG_LEVEL_MAXIMUM                                   \
    }

/* struct option_given: pairs of a setting and a value (choose_settings). */
#define OPTION_SET(structure, member)                                                                        \
    {                                                                                                        \
        "set", "NAME=VALUE", "a setting of the renderer (triptych list settings), which may be repeated",    \
            OPTION_IS_WORDS(structure, member), .words = setting_choice                                      \
    }

/* unsigned: the precision in which a stream begins (struct stream), by choose_precision. */
#define OPTION_PRECISION(structure, member)                                                                  \
    {                                                                                                        \
        "precision", "LEVEL",                                                                                \
            "of functions, until the stream sets the state: exact, partial, approximate; "                   \
            "exact",                                                                                         \
            OPTION_IS_INDEX(structure, member), .words = choose_precision                                    \
    }

/* bool: sets store_off (command/store/store.h). */
#define OPTION_NO_CACHE(structure, member)                                                                   \
    {                                                                                                        \
        "no-cache", NULL, "read models again, and keep no mesh", OPTION_IS_FLAG(structure, member)           \
    }

/* unsigned: a frame or a draw of the stream, from 0, and the greatest number of one. */
enum { OPTION_STREAM_MAXIMUM = LIMIT_EXECUTED };
#define OPTION_FRAME(structure, member)                                                                      \
    {                                                                                                        \
        "frame", "N", "which frame, from 0; 0", OPTION_IS_NUMBER(structure, member),                         \
            .most = OPTION_STREAM_MAXIMUM                                                                    \
    }
#define OPTION_DRAW(structure, member)                                                                       \
    {                                                                                                        \
        "draw", "N", "which draw of the frame, from 0; 0", OPTION_IS_NUMBER(structure, member),              \
            .most = OPTION_STREAM_MAXIMUM                                                                    \
    }

#endif
