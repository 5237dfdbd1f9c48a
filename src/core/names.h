/*
  Lists of names as one text.
*/
#ifndef LAM_NAMES_H
#define LAM_NAMES_H

#include <stdio.h>
#include <string.h>

/* Appends a name, preceded by a separator unless it is the first; truncates at size bytes. */
static inline void LamNamesAppend(size_t size, char names[], const char separator[], const char name[])
{
  const size_t n = strlen(names);

  snprintf(names + n, size - n, "%s%s", n ? separator : "", name);
}

#endif
