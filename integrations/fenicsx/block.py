"""The block of a scene in FEniCSx, and the same run of `lamella fe2`: forces of its sides, and how far they differ.

    block.py SCENE -d DB.h5       stresses from a database alone, as `lamella fe2 --response database`
    block.py SCENE --direct       an RVE solved at each material point, as `lamella fe2 --response direct`

Of the scene's block `macro`: mesh {box, elements}, entries {on, displacement} of boundary, steps; the body is inflated
first, by its prescribed turgor. Prints the forces on the sides step by step, N per mm of thickness; exit status 1:
one differs by more than --tolerance of its step's largest.
"""
import argparse
import sys

import numpy as np
from dolfinx import fem, mesh
from mpi4py import MPI

import lamella
from lamella_fenicsx import Newton, NoResponse, NotConverged, Tissue

METRES = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6}
SIDES = {"left": (0, 0), "right": (0, 1), "bottom": (1, 0), "top": (1, 1)}  # axis; 0: its beginning, 1: its end
HALVINGS = 8  # of an increment before the run is given up, as in `lamella fe2`


def metres(quantity):
    number, unit = str(quantity).split()
    return float(number) * METRES[unit]


class Block:
    """What is read of a scene, m and Pa."""

    def __init__(self, path):
        scene = lamella.scene_dict(path)
        macro = scene["macro"]
        unknown = set(macro) - {"mesh", "boundary", "inflate", "steps"} | set(macro["mesh"]) - {"box", "elements"}
        for entry in macro["boundary"]:
            unknown |= set(entry) - {"on", "displacement"} | {entry["on"]} - set(SIDES)
        if unknown or not macro.get("inflate", True):
            sys.exit(f"{path}: macro: block.py inflates a box and displaces its sides; it does not know "
                     f"{', '.join(sorted(unknown)) or 'inflate: false'}")
        self.box, self.elements = [metres(x) for x in macro["mesh"]["box"]], macro["mesh"]["elements"]
        self.displacements = {entry["on"]: [None if x == "free" else metres(x) for x in entry["displacement"]]
                              for entry in macro["boundary"]}
        self.steps, self.accuracy = macro["steps"], scene.get("accuracy", 0.01)
        at_rest = {"version": scene["version"], "rve": scene["rve"], "load": [{"F": [[1, 0], [0, 1]]}]}
        rest = lamella.Scene(at_rest)
        self.turgor, self.cohesion = rest.turgor[0], rest.cohesion[0]


class Body:
    """The block as quadratic elements, and its path: turgor first, then displacements from the inflated block."""

    def __init__(self, block, law):
        self.block, self.cutbacks = block, 0
        box = mesh.create_rectangle(MPI.COMM_WORLD, [[0, 0], block.box], block.elements, mesh.CellType.quadrilateral)
        self.V = fem.VectorFunctionSpace(box, ("CG", 2))
        self.u = fem.Function(self.V)
        self.tissue = Tissue(self.u, law, cohesion=block.cohesion, accuracy=block.accuracy)

    def on(self, *sides):
        """Whether places are on all of these sides."""
        def inside(x):
            return np.all([np.isclose(x[a], end * self.block.box[a]) for a, end in map(SIDES.get, sides)], axis=0)
        return inside

    def component(self, i, where):
        """Degrees of freedom of component i at a place, in u and in a function of that component alone."""
        one, _ = self.V.sub(i).collapse()
        return fem.locate_dofs_geometrical((self.V.sub(i), one), where), fem.Function(one)

    def hold(self, held):
        """Conditions (component, place, displacement) whose displacements grow from where the nodes are now."""
        self.moves, conditions = [], []
        for i, where, displacement in held:
            dofs, value = self.component(i, where)
            self.moves.append((value, dofs, self.u.x.array[dofs[0]], displacement))
            conditions.append(fem.dirichletbc(value, dofs, self.V.sub(i)))
        self.newton = Newton(self.tissue, conditions)

    def set(self, turgor, load):
        self.tissue.turgor = turgor * self.block.turgor
        for value, dofs, origin, displacement in self.moves:
            value.x.array[dofs[1]] = origin + load * displacement

    def advance(self, start, end):
        """From one (turgor, load) to another, in smaller increments where that is needed."""
        done, increment, iterations = 0.0, 1.0, 0
        while done < 1:
            to = min(1.0, done + increment)
            self.set(*(a + to * (b - a) for a, b in zip(start, end)))
            try:
                iterations += self.newton.solve()
            except (NoResponse, NotConverged) as why:
                self.cutbacks += 1
                increment = (to - done) / 2
                if increment < 0.5**HALVINGS:
                    raise
                if MPI.COMM_WORLD.rank == 0:
                    print(f"block.py: cut back: {why}", file=sys.stderr)
                continue
            self.tissue.accept()
            done, increment = to, 2 * increment
        return iterations

    def owned(self, i, where):
        dofs = self.component(i, where)[0][0]
        return dofs[dofs < 2 * self.V.dofmap.index_map.size_local]

    def forces(self):
        """Forces on the body at its sides, N per mm of thickness {side: [along X1, along X2]}; a corner's is shared
        by the sides that hold it."""
        r, found = self.newton.forces().array, {}
        held = {(side, i): self.owned(i, self.on(side)) for side, d in self.block.displacements.items()
                for i in (0, 1) if d[i] is not None}
        for (side, i), nodes in held.items():
            share = sum(np.isin(nodes, held.get((other, i), [])) for other in self.block.displacements)
            force = MPI.COMM_WORLD.allreduce((r[nodes] / share).sum())
            found.setdefault(side, [0.0, 0.0])[i] = force * 1e-3
        return found

    def upright(self):
        """Turns the free body about its first corner until the last is in line with it, as `lamella fe2` holds it."""
        corner = self.on("right", "top")
        u = [MPI.COMM_WORLD.allreduce(self.u.x.array[self.owned(i, corner)].sum()) for i in (0, 1)]
        line = np.array(self.block.box)
        turn = np.arctan2(*line[::-1]) - np.arctan2(*(line + u)[::-1])
        R = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        X = self.V.tabulate_dof_coordinates()[:, :2]
        self.u.x.array[:] = ((X + self.u.x.array.reshape(-1, 2)) @ R.T - X).ravel()

    def run(self):
        """Forces after inflation and each step."""
        first = self.on("left", "bottom")
        self.hold([(0, first, 0.0), (1, first, 0.0), (1, self.on("right", "bottom"), 0.0)])
        self.advance((0, 0), (1, 0))
        self.upright()
        self.hold([(i, self.on(side), d[i]) for side, d in self.block.displacements.items() for i in (0, 1)
                   if d[i] is not None])
        for step in range(1, self.block.steps + 1):
            iterations = self.advance((1, (step - 1) / self.block.steps), (1, step / self.block.steps))
            yield step, iterations, self.forces()


def reference(arguments):
    """Forces of the same run of `lamella fe2`, by step."""
    if arguments.direct:
        told = lamella.run("fe2", arguments.scene, "--response", "direct")
    else:
        told = lamella.run("fe2", arguments.scene, "-d", arguments.database, "--response", "database", "--no-certify")
    if not told.complete:
        sys.exit("block.py: lamella fe2 has not reached the last step: " + "\n".join(told.warnings))
    return {one["step"]: one["reaction"] for one in told}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("-d", dest="database")
    parser.add_argument("--direct", action="store_true")
    parser.add_argument("--tolerance", type=float, default=1e-8)
    arguments = parser.parse_args()
    if arguments.direct == bool(arguments.database):
        parser.error("give a database, -d DB.h5, or --direct")
    root = MPI.COMM_WORLD.rank == 0
    law = lamella.RVE(arguments.scene) if arguments.direct else lamella.Database(arguments.database)
    body = Body(Block(arguments.scene), law)
    fe2 = MPI.COMM_WORLD.bcast(reference(arguments) if root else None)
    if root:
        print(f"{'forces along X1, X2 (N/mm): FEniCSx':53}{'lamella fe2':36}difference")
    worst = 0.0
    for step, iterations, forces in body.run():
        largest = np.abs(list(fe2[step].values())).max()
        for side, force in forces.items():
            difference = np.abs(np.subtract(force, fe2[step][side])).max() / largest
            worst = max(worst, difference)
            if root:
                both = "   ".join(f"{x:16.9e} {y:16.9e}" for x, y in (force, fe2[step][side]))
                print(f"step {step:2}  {side:6}  {both}   {difference:.1e}   {iterations} iterations")
    if root:
        print(f"largest difference {worst:.1e}, {body.cutbacks} increments halved")
    sys.exit(int(worst > arguments.tolerance))


if __name__ == "__main__":
    main()
