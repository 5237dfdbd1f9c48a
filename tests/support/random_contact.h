/*
  Random states of contact tissue, the same on every machine, in boxes of principal logarithmic strains e1, e2:
    asked   |e1 - e2| <= 0.3 and -0.05 <= (e1 + e2)/2 <= 0.3
    wide    e1 and e2 from -0.3 to 0.3, (e1 + e2)/2 >= -0.05
    thin    e1 = -e2 = asinh(s/2): a simple shear s from 0 to 0.6; each second state has 2 x 2 cells
  with any principal direction, rotation and orientation, t/a from 0.03 to 0.4 (thin: 0.02 to 0.05), turgor up to
  0.05 MPa and cohesion up to 0.01 MPa. Their sum is at least 0.002 MPa in nine states of ten, and zero in the rest.
*/
#ifndef LAM_SUPPORT_RANDOM_CONTACT_H
#define LAM_SUPPORT_RANDOM_CONTACT_H

#include "contact_tissue.h"

typedef enum { BOX_ASKED, BOX_WIDE, BOX_THIN, BOX_COUNT } ContactBox;
extern const char *const contact_box_names[BOX_COUNT + 1]; /* ends with NULL */

typedef struct {
  double strain[2], direction, rotation;
  double turgor, cohesion; /* MPa */
  PetscBool dry;           /* neither */
  LamMicrostructure micro;
  LamLoad load;
} RandomContact;

/* State `number` of a box; along, through: elements of a face. seed: behind the state before. */
RandomContact DrawContact(ContactBox box, int number, int along, int through, uint64_t *seed);

#endif
