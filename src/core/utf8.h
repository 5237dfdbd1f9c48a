/*
  Texts of files: UTF-8, or not.
*/
#ifndef LAM_UTF8_H
#define LAM_UTF8_H

#include <stddef.h>

/* Bytes of the character that begins here; 0: it is no UTF-8 (RFC 3629). The text ends with a zero. */
static inline size_t LamCharacterLength(const unsigned char c[])
{
  const size_t length = c[0] < 0x80 ? 1 : c[0] < 0xC2 ? 0 : c[0] < 0xE0 ? 2 : c[0] < 0xF0 ? 3 : c[0] < 0xF5 ? 4 : 0;
  const unsigned char least = c[0] == 0xE0 ? 0xA0 : c[0] == 0xF0 ? 0x90 : 0x80; /* shorter forms are no characters */
  const unsigned char most = c[0] == 0xED ? 0x9F : c[0] == 0xF4 ? 0x8F : 0xBF;  /* nor are halves of pairs */

  if (length > 1 && (c[1] < least || c[1] > most)) return 0;
  for (size_t i = 2; i < length; i++)
    if (c[i] < 0x80 || c[i] > 0xBF) return 0;
  return length;
}

#endif
