/* How a call's block gets to the Linux side: in a 64-bit program by the Unix library, which has the Linux
 * side in it (direct.c); in a 32-bit program through memory that it shares with a 64-bit process
 * (shared.c). */
#ifndef D3D9_PE_TRANSPORT_H
#define D3D9_PE_TRANSPORT_H

/* Returns 0 if the Linux side cannot be reached. */
int transport_start(void);

/* Executes a call. Returns the result of d3d9_dispatch. */
int transport_run(unsigned code, void *block);

#endif
