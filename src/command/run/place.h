/* The places that `triptych run` needs: the files of Direct3D 9 and of EGL, and Wine's prefix.
 *
 * A prefix is a folder with the drives and the registry of Windows. */
#ifndef COMMAND_RUN_PLACE_H
#define COMMAND_RUN_PLACE_H

#include "base/error.h"

#include <limits.h>
#include <stdbool.h>

/* Finds the folder of the files that `make d3d9` builds: d3d9 beside the command, or ../lib/triptych/d3d9
 * from its folder, as `make install` leaves it. Returns 0, or -1 with a reason. */
int place_files(char folder[PATH_MAX], struct error *error);

/* Finds the file that names the EGL library which `make gles` builds, for libglvnd: in egl beside the
 * command, or in ../lib/triptych/egl from its folder. Returns 0, or -1 with a reason. */
int place_vendor(char file[PATH_MAX], struct error *error);

/* Copies the two DLLs from there to the folders of system DLLs of the prefix, for programs of 64 and, if
 * they are built, of 32 bits, unless it has them. Wine uses them only with the override d3d9=n: other
 * programs of this prefix get Wine's own d3d9.dll. Returns 0, or -1 with a reason. */
int place_install(const char *folder, const char *prefix, struct error *error);

/* The prefix: the argument, else WINEPREFIX, else ~/.wine. Relative paths become absolute. Returns 0, or
 * -1 with a reason. */
int place_prefix(const char *given, char prefix[PATH_MAX], struct error *error);

/* Returns true if the prefix exists. */
bool place_has_prefix(const char *prefix);

/* Makes the prefix if it is missing, with the program `wine`: about 20 seconds. Returns 0, or -1 with a
 * reason. */
int place_make_prefix(const char *wine, const char *prefix, struct error *error);

/* An absolute path for a file that another process opens in another folder. Returns 0, or -1 with a
 * reason. */
int place_absolute(const char *path, char absolute[PATH_MAX], struct error *error);

#endif
