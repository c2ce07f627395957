#pragma once

#include <cstdio>
#include <cstdlib>

/// Our own bugs only, never peer data: prints and aborts in every build type.
#define AW_ASSERT(condition)                                                                 \
  do {                                                                                       \
    if (!(condition)) {                                                                      \
      std::fprintf(stderr, "%s:%d: assertion failed: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                          \
    }                                                                                        \
  } while (false)
