/*
  Lamella: effective stress, tangent and debonding of fruit and plant tissue.

  This header includes all others; the order for reading:
    scene.h                the user's input, converted to nondimensional numbers
    place_field.h          fields of the reference position
    lattice.h              arrangement of the cells of a microstructure
    tissue.h               cells of any shape
    response.h             load and response of a material point; responders
    ellipticity.h          strong ellipticity of a tangent
    rve.h                  solves the representative volume element
    database.h             stores and interpolates responses
    blend.h                responses between tissues that differ in one number
    parametric_database.h  responses for walls between databases
    heterogeneous.h        responses for a body of heterogeneous tissue
    cache.h                queries a database and solves the states that it lacks
    sealed.h               responses of sealed cells, from those for prescribed turgor
    relaxing.h             responses of walls that relax, from those of elastic ones
    macro.h                the macroscale finite element solver
    kinetics.h             kinetic laws
    process.h              tissue that changes in time at one material point
    body.h                 a body whose tissue changes in time
    study.h                whole studies: build a database, solve a body
    material.h             a material law for other programs, in SI units
    reporter.h             what a long task reports while it runs
    error.h                the last error as text
    bind.h                 plain functions, in SI units, for other languages
    archive.h              checkpoints
    version.h              LAMELLA_VERSION and its numbers
    export.h               symbol visibility

  Conventions
  * Every function that can fail returns a PetscErrorCode. PETSC_ERR_USER_INPUT: the user's file or
    argument is invalid, and the message says where and what would be right. PETSC_ERR_FILE_OPEN, _READ,
    _WRITE, _UNEXPECTED: input or output failed. A solve that does not converge is not an error: see LamStatus.
  * Inside the library everything is nondimensional: lengths in apothems a of the cell, stresses in
    C1 + C2 of the wall. LamScales converts to SI.
  * Tensors are row-major, 3x3 as 9 numbers (11 12 13 21 22 23 31 32 33); the tangent is dP_ij/dF_kl,
    81 numbers, row ij, column kl.
*/
#ifndef LAMELLA_LAMELLA_H
#define LAMELLA_LAMELLA_H

#include <lamella/scene.h>
#include <lamella/place_field.h>
#include <lamella/lattice.h>
#include <lamella/tissue.h>
#include <lamella/response.h>
#include <lamella/ellipticity.h>
#include <lamella/rve.h>
#include <lamella/database.h>
#include <lamella/blend.h>
#include <lamella/parametric_database.h>
#include <lamella/heterogeneous.h>
#include <lamella/cache.h>
#include <lamella/sealed.h>
#include <lamella/relaxing.h>
#include <lamella/macro.h>
#include <lamella/process.h>
#include <lamella/body.h>
#include <lamella/study.h>
#include <lamella/material.h>
#include <lamella/error.h>
#include <lamella/bind.h>
#include <lamella/archive.h>
#include <lamella/version.h>

#endif
