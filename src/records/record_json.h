/*
  Metadata of files as JSON.
*/
#ifndef LAM_RECORD_JSON_H
#define LAM_RECORD_JSON_H

#include <jansson.h>
#include "json.h"
#include "record_internal.h"

/* Text that may contain any bytes, such as a command line: null if it is not UTF-8. */
static inline json_t *LamTextToJSON(const char text[])
{
  json_t *string = text ? json_string(text) : NULL;

  return string ? string : json_null();
}

/* The writer of the file: host, process, since; null if there is none. */
static inline json_t *LamWriterToJSON(const char path[])
{
  LamLockHolder holder;

  if (!path || !LamLockGetHolder(path, &holder)) return json_null();
  return json_pack("{s:o, s:I, s:o}", "host", LamTextToJSON(holder.host), "process", (json_int_t)holder.pid, "since",
                   LamTextToJSON(holder.since));
}

#endif
