#!/usr/bin/env bash
# A block of dry tissue, unstressed at first, is compressed between plates with the real RVE.
. "$(dirname "$0")/common.sh"
tissue turgor='mode: none' mesh='along: 3, through: 1' >dry.yaml <<'YAML'
macro:
  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [0 mm, -0.2 mm]}]
  steps: 2
YAML
expect 0 "$lamella" fe2 dry.yaml --json --quiet
[ "$(wc -l <out.txt)" = 2 ] || fail "$(wc -l <out.txt) steps, expected 2"
