/*
  Visibility of public functions and variables (LAM_EXPORT), in C and in C++.
*/
#ifndef LAMELLA_EXPORT_H
#define LAMELLA_EXPORT_H

#ifdef __GNUC__
#define LAM_EXPORT __attribute__((visibility("default")))
#else
#define LAM_EXPORT
#endif

#ifdef __cplusplus
#define LAM_C_BEGIN extern "C" {
#define LAM_C_END }
#else
#define LAM_C_BEGIN
#define LAM_C_END
#endif

#endif
