/* The Unix library that Wine loads with this DLL. */
#ifndef D3D9_PE_UNIXLIB_H
#define D3D9_PE_UNIXLIB_H

/* Finds the library. Returns 0 if it is missing. */
int unixlib_start(void);

/* Calls the function of this number (front/d3d9/unix/entry.h). Returns a negative number if it failed. */
int unixlib_call(unsigned number, void *arguments);

#endif
