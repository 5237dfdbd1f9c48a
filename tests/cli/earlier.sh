#!/usr/bin/env bash
# Files of earlier versions, tests/verification/data/VERSION, are read by this one: databases give the stored responses,
# results are drawn and read in Python, a tissue file is the same tissue. make.sh there says how they were made.
. "$(dirname "$0")/common.sh"

package h5py matplotlib
for folder in "$source"/tests/verification/data/[0-9]*; do
  rm -rf ./*
  cp "$folder"/*.yaml "$folder"/*.gz "$folder"/*.csv "$folder"/tissue.json .
  gunzip ./*.gz

  for file in *.h5; do
    expect 0 -o '^state *sound$' "$lamella" info "$file" --check
  done
  # a body answered from the table, and a copy of the records that this version may add to
  expect 0 "$lamella" fe2 table.yaml --response database -d table.h5 --quiet
  expect 0 "$lamella" merge copy.h5 contact.h5

  "$python" - <<'PYTHON' || fail "files of version $(basename "$folder")"
import csv
import numpy as np
import lamella

def table(path):
    with open(path) as lines:
        return list(csv.DictReader(lines))

# scattered records are answered as they were solved, and so are nodes of tables that others surround
for path, scattered, least in ("table.h5", 0, 4), ("contact.h5", 6, 26), ("copy.h5", 6, 26):
    file = lamella.Result(path)
    solved, apart = file.responses, file.keys >= 2**62
    r = lamella.Database(path).query(solved.F, solved.turgor, solved.cohesion, accuracy=np.inf)
    error = np.abs(r.P - solved.P).max((1, 2)) / file.stress_unit
    assert solved.converged.all() and apart.sum() == scattered and r.converged.sum() >= least, path
    assert r.converged[apart].all() and (error[apart] < 1e-9).all() and (error[r.converged] < 2e-3).all(), path

# between its nodes the table is right to its accuracy
F = np.eye(3) + np.random.default_rng(1).uniform(0, 1, (6, 3, 3)) * [[0.05, 0.02, 0], [0.02, 0.05, 0], [0, 0, 0]]
r, exact = lamella.Database("table.h5").query(F, 3e4), lamella.RVE("table.yaml").solve(F, turgor=3e4)
assert (r.status == "converged").all() and np.abs(r.P - exact.P).max() < 0.02 * np.abs(exact.P).max()

# states: the same tissue of the tissue file, at the same mesh
file, states = lamella.Result("rve.h5"), lamella.RVE("irregular.yaml").solve()
assert np.allclose(states.P, file.responses.P, rtol=1e-6, atol=1e-6 * file.stress_unit)
assert [row["status"] for row in table("rve.csv")] == list(file.responses.status)
assert file.fields(2)["x"].shape == file.mesh["nodes"].shape

body, process, map = lamella.Result("fe2.h5"), lamella.Result("process.h5"), lamella.Result("map.h5")
(top,) = [k for k, name in enumerate(body.boundaries) if name == "top"]
assert body.status == "done" and np.allclose(body.reaction[:, top, 0], [float(row["top R1 (N/mm)"]) * 1e3 for row in table("fe2.csv")])
assert body.fields(1)["P"].shape == (1, 3, 3)
assert np.isclose(process.time[-1], 7 * 86400) and np.allclose(process.responses.turgor, [float(row["turgor (MPa)"]) * 1e6 for row in table("process.csv")])
assert map.mode.tolist() == [["none", "separation", "separation"], ["none", "none", "rupture"]]

for path in "table.h5", "rve.h5", "fe2.h5", "process.h5", "map.h5", "tissue.json":
    lamella.plot.draw(path)
PYTHON
done
