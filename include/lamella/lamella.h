/*
  Lamella: effective stress, tangent and debonding of fruit and plant tissue.

  Everything a program needs; each part has its own header, to be read in this order:
    scene.h        what the user describes, converted to nondimensional numbers
    place_field.h  numbers that vary with the position
    lattice.h      how the cells of a microstructure lie side by side
    response.h     load and response of a material point; the responder table
    ellipticity.h  whether a tangent resists localisation
    rve.h          solves the representative volume element
    database.h     stores responses, interpolates them
    blend.h        responses between tissues that differ in one number
    parametric_database.h       responses for walls between databases
    heterogeneous.h       responses for a body of different tissue
    cache.h        queries a database and solves what it lacks
    sealed.h       responses of cells that keep their water, from those for prescribed turgor
    macro.h        the macroscale finite element solver
    kinetics.h     how a property of tissue changes in time
    process.h      tissue that changes in time at one material point
    body.h         a body whose tissue changes in time
    study.h        whole studies: a database built, a body solved
    material.h     a material law for other programs, in SI units
    error.h        the last error in words
    archive.h      the state of a run, to go on from
    version.h      LAMELLA_VERSION and its numbers
    export.h       what the library shows

  Conventions throughout
  * Every function that can fail returns a PetscErrorCode. PETSC_ERR_USER_INPUT: the user's file or
    argument is wrong and the message says where and what would be right. PETSC_ERR_FILE_OPEN, _READ,
    _WRITE, _UNEXPECTED: input or output failed. A solve that does not converge is no error: see LamStatus.
  * Inside the library everything is nondimensional: lengths in apothems a of the cell, stresses in
    C1 + C2 of the wall. LamScales converts at the edge.
  * Tensors are row-major, 3x3 as 9 numbers (11 12 13 21 22 23 31 32 33); the tangent is dP_ij/dF_kl,
    81 numbers, row ij, column kl.
*/
#ifndef LAMELLA_LAMELLA_H
#define LAMELLA_LAMELLA_H

#include <lamella/scene.h>
#include <lamella/place_field.h>
#include <lamella/lattice.h>
#include <lamella/response.h>
#include <lamella/ellipticity.h>
#include <lamella/rve.h>
#include <lamella/database.h>
#include <lamella/blend.h>
#include <lamella/parametric_database.h>
#include <lamella/heterogeneous.h>
#include <lamella/cache.h>
#include <lamella/sealed.h>
#include <lamella/macro.h>
#include <lamella/process.h>
#include <lamella/body.h>
#include <lamella/study.h>
#include <lamella/material.h>
#include <lamella/error.h>
#include <lamella/archive.h>
#include <lamella/version.h>

#endif
