/* Marks what the library exports; everything else in it is hidden. Read by C and C++. */
#ifndef HEXHEX_EXPORT_H
#define HEXHEX_EXPORT_H

/* HEXHEX_API for a single function, HEXHEX_API_NAMESPACE for all that a public C++ header declares in
   its namespace. HEXHEX_HIDDEN for what must be declared there but is nobody's business. Where
   symbols need no marks (static libraries) these do no harm. */
#if defined(_WIN32)
#define HEXHEX_API
#define HEXHEX_API_NAMESPACE
#define HEXHEX_HIDDEN
#else
#define HEXHEX_API __attribute__((visibility("default")))
#define HEXHEX_API_NAMESPACE __attribute__((visibility("default")))
#define HEXHEX_HIDDEN __attribute__((visibility("hidden")))
#endif

#endif
