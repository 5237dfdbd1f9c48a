/*
  Validation of UTF-8.
*/
#ifndef LAM_UTF8_H
#define LAM_UTF8_H

#include <stddef.h>

/* Length in bytes of the character at c; 0: invalid UTF-8 (RFC 3629). The text is terminated by zero. */
static inline size_t LamCharacterLength(const unsigned char c[])
{
  const size_t length = c[0] < 0x80 ? 1 : c[0] < 0xC2 ? 0 : c[0] < 0xE0 ? 2 : c[0] < 0xF0 ? 3 : c[0] < 0xF5 ? 4 : 0;
  const unsigned char least = c[0] == 0xE0 ? 0xA0 : c[0] == 0xF0 ? 0x90 : 0x80; /* overlong encodings are invalid */
  const unsigned char most = c[0] == 0xED ? 0x9F : c[0] == 0xF4 ? 0x8F : 0xBF;  /* so are surrogates */

  if (length > 1 && (c[1] < least || c[1] > most)) return 0;
  for (size_t i = 2; i < length; i++)
    if (c[i] < 0x80 || c[i] > 0xBF) return 0;
  return length;
}

#endif
