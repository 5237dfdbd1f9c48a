/*
  What the program prints of an audit.
*/
#ifndef LAM_AUDIT_REPORT_H
#define LAM_AUDIT_REPORT_H

#include "app.h"
#include "audit.h"

PetscErrorCode LamAuditPrint(const LamAudit *audit, const char path[], PetscReal seconds, PetscMPIInt ranks);
PetscErrorCode LamAuditToJSON(const LamAudit *audit, const char path[], PetscReal seconds, json_t **object);

#endif
