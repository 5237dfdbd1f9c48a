"""Stretch and force of each state of a patch, and between which cells the lamella is broken all along a face:

    python3 force.py RESULT.h5
"""
import sys

import numpy as np

import lamella

with lamella.Result(sys.argv[1]) as result:
    width, faces = np.ptp(result.mesh["nodes"][:, 0]), result.mesh["interface_faces"]
    print("stretch  force, N/m  broken faces")
    for state, response in zip(result.states(), result.responses):
        broken = result.fields(state)["interface/broken"].min(axis=1) > 0.999
        pairs = ", ".join(f"{cell}-{other}" for cell, _, other in faces[broken])
        force = width * response.P[1, 1]
        print(f"{response.F[1, 1]:7.2f}  {force:10.3f}  {broken.sum()} of {len(faces)}  {pairs}".rstrip())
