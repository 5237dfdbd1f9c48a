/*
  Private to scene reading: macros for the tables of keys. {STRESS("rve.wall.C1"), REQUIRED, ABOVE(0), ...}
*/
#ifndef LAM_SCENE_ROWS_H
#define LAM_SCENE_ROWS_H

#include "scene_keys.h"

#define LAM_KEY_TABLE(table, rows) const LamKeyTable table = {rows, PETSC_STATIC_ARRAY_LENGTH(rows)}

#define MAP(key_path) .path = key_path, .type = LAM_KEY_MAP
#define LIST(key_path) .path = key_path, .type = LAM_KEY_LIST
#define OF_DIMENSION(key_path, key_dimension, key_unit)                                                                \
  .path = key_path, .type = LAM_KEY_QUANTITY, .dimension = LAM_DIMENSION_##key_dimension, .unit = key_unit
#define LENGTH(key_path, key_unit) OF_DIMENSION(key_path, LENGTH, key_unit) /* um in apothems, mm in macro lengths */
#define STRESS(key_path) OF_DIMENSION(key_path, STRESS, "MPa")
#define ANGLE(key_path) OF_DIMENSION(key_path, ANGLE, "deg")
#define TIME(key_path) OF_DIMENSION(key_path, TIME, "s")
#define TEMPERATURE(key_path) OF_DIMENSION(key_path, TEMPERATURE, "degC")
#define RATE(key_path) OF_DIMENSION(key_path, RATE, "/s")
#define MOLAR_ENERGY(key_path) OF_DIMENSION(key_path, MOLAR_ENERGY, "kJ/mol")
#define PERMEABILITY(key_path) OF_DIMENSION(key_path, PERMEABILITY, "m/s/MPa")
#define CONDUCTIVITY(key_path) OF_DIMENSION(key_path, CONDUCTIVITY, "m^2/s/MPa")
#define AREAL_ENERGY(key_path) OF_DIMENSION(key_path, AREAL_ENERGY, "J/m^2")
#define STIFFNESS(key_path) OF_DIMENSION(key_path, STIFFNESS, "MPa/mm")
#define REAL(key_path) .path = key_path, .type = LAM_KEY_REAL
#define INTEGER(key_path) .path = key_path, .type = LAM_KEY_INTEGER
#define BOOL(key_path) .path = key_path, .type = LAM_KEY_BOOL
#define TEXT(key_path) .path = key_path, .type = LAM_KEY_TEXT
#define PATH(key_path) .path = key_path, .type = LAM_KEY_PATH
#define TENSOR(key_path) .path = key_path, .type = LAM_KEY_TENSOR
#define STRESS_TENSOR(key_path)                                                                                        \
  .path = key_path, .type = LAM_KEY_QUANTITY_TENSOR, .dimension = LAM_DIMENSION_STRESS, .unit = "MPa"
#define NAME(key_path, list)                                                                                           \
  .path = key_path, .type = LAM_KEY_NAME, .names = list, .name_count = PETSC_STATIC_ARRAY_LENGTH(list)
#define NAME_OF(key_path, list, count) .path = key_path, .type = LAM_KEY_NAME, .names = list, .name_count = count
/* The member in which LamSceneFill stores the value, and the PetscBools for its given components. */
#define INTO(type, member) .record = #type, .offset = offsetof(type, member), .room = sizeof(((type *)0)->member)
#define GIVEN(type, member) .given = offsetof(type, member)

#define REQUIRED .required = PETSC_TRUE
#define FREE .free_word = "free"
#define OPEN .free_word = "x"
#define ABOVE(x) .lower = {LAM_BOUND_EXCLUDED, x}
#define FROM(x) .lower = {LAM_BOUND_INCLUDED, x}
#define TO(x) .upper = {LAM_BOUND_INCLUDED, x}
#define BELOW(x) .upper = {LAM_BOUND_EXCLUDED, x}

/* Rows of wall keys, from the lists of wall.h. */
#define WALL_MODULUS(key_path) STRESS(key_path)
#define WALL_NUMBER(key_path) REAL(key_path)
#define LAM_FIRST(a, b) a
#define LAM_SECOND(a, b) b
#define LAM_OTHER_WALL_KEY(X, name, law, kind, need, symbol, sample, about, ...)                                       \
  {WALL_##kind(LAM_FIRST X "." #name),                                                                                 \
   INTO(LamWall, name),                                                                                                \
   .default_words = LAM_SECOND X,                                                                                      \
   .example = sample,                                                                                                  \
   .help = about ".",                                                                                                  \
   __VA_ARGS__},
/* Keys of a wall whose missing values are those of `rve`, or as described by the text `own`. */
#define LAM_OTHER_WALL(prefix, own)                                                                                    \
  {NAME_OF(prefix ".law", LamWallLawNames, LAM_WALL_LAW_COUNT), INTO(LamWall, law), .default_words = own,              \
   .help = "Law of its wall."},                                                                                        \
      LAM_WALL_PARAMETERS(LAM_OTHER_WALL_KEY, (prefix, own)){STRESS(prefix ".bulk_modulus"),                           \
                                                             INTO(LamWall, bulk_modulus),                              \
                                                             ABOVE(0),                                                 \
                                                             .default_words = own ", in proportion to C1 + C2",        \
                                                             .example = "110 MPa",                                     \
                                                             .help = "Bulk modulus."},                                 \
      {NAME_OF(prefix ".fibres", LamFibresNames, LAM_FIBRES_COUNT), INTO(LamWall, fibres), .default_words = own,       \
       .help = "Whether fibres resist compression."},                                                                  \
  {                                                                                                                    \
    ANGLE(prefix ".fibre_angle"), INTO(LamWall, fibre_angle), FROM(-90), TO(90),                                       \
        .default_words = own, .example = "20 deg", .help = "Angle between its fibres and the section of the cells."    \
  }

#define CHOSEN "chosen for the wanted accuracy"

#endif
