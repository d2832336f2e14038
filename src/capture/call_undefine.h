/* Undefines the macros that call.def takes. Included after each use of the table, so it has no guard. */
#undef CALL
#undef CALL_OF
#undef CALL_BARE
#undef U8
#undef U16
#undef U32
#undef S32
#undef BOOL
#undef WORD
#undef FLOATS
#undef RESOURCE
