/* The vtables of all interfaces, from the table of calls. */
#ifndef D3D9_PE_VTABLE_H
#define D3D9_PE_VTABLE_H

/* Hands the addresses of the vtables to the Linux side. */
void vtable_register(void);

#endif
